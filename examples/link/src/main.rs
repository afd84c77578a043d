//! Calls every query and builder of the core. The panic handler calls a function that does not exist, so that this
//! program links only if no panic is reachable from any of them. It is linked, never run.

#![no_std]
#![no_main]

mod build;
mod geometry;
mod input;
mod own;
mod plan;
mod query;
mod render;
mod sensor;

use core::panic::PanicInfo;

unsafe extern "C" {
    /// Does not exist.
    safe fn a_panic_is_reachable() -> !;
}

#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    a_panic_is_reachable()
}

/// The entry point.
#[unsafe(no_mangle)]
extern "C" fn _start() {
    if cfg!(feature = "panic") {
        core::hint::black_box([0, 1][input::word() as usize]);
        return;
    }
    geometry::all();
    build::all();
    query::all();
    render::all();
}
