//! hitscan on bare metal: what the programs in `src/bin` share.

#![no_std]

mod answer;
pub mod baked;
pub mod camera;
mod counter;
pub mod inlined;
#[allow(unsafe_code)]
mod metal;

pub use answer::Answer;
#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
pub use counter::Counter;
pub use metal::{fault, stack_of};
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// Ends the program: QEMU's exit status is 0 if `passed`, 1 if not.
pub fn finish(passed: bool) -> ! {
    semihosting::println!("{}", if passed { "passed" } else { "FAILED" });
    semihosting::process::exit(i32::from(!passed))
}
