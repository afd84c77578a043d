//! hitscan on bare metal: what the programs in `src/bin` share.

#![no_std]

mod answer;
pub mod baked;
mod board;
pub mod builds;
pub mod camera;
mod counter;
pub mod hash;
pub mod inlined;
#[allow(unsafe_code)]
mod metal;
pub mod picture;
pub mod programs;
pub mod room;

pub use answer::Answer;
pub use board::{Board, MEMORY_WORDS, Program, run};
#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
pub use counter::Counter;
pub use metal::{fault, stack_of, stack_of_all};
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// Prints a number that must stay within its budget.
pub fn figure(program: &str, what: &str, number: u64) {
    semihosting::println!("figure {program}.{what} {number}");
}

/// Ends the program: QEMU's exit status is 0 if `passed`, 1 if not.
pub fn finish(passed: bool) -> ! {
    semihosting::println!("{}", if passed { "passed" } else { "FAILED" });
    semihosting::process::exit(i32::from(!passed))
}
