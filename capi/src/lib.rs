//! hitscan for C: exact ray queries on triangle meshes, from flash, without heap.
//!
//! The functions check every pointer and answer with a [`Status`]; none of them panics, which the panic handler below
//! proves. `include/hitscan.h` is made from these sources by the package in `header/`.

#![no_std]

mod api;
mod plan;
mod raw;
mod scene;
mod status;
mod triangles;
mod types;

use core::panic::PanicInfo;

#[allow(unsafe_code, reason = "declares a function that is never called")]
mod never {
    unsafe extern "C" {
        /// Does not exist: a program links only if no panic is reachable from what it calls.
        pub safe fn hitscan_a_panic_is_reachable() -> !;
    }
}

#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    never::hitscan_a_panic_is_reachable()
}
