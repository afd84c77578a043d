//! Instructions executed, by the board's own clock: QEMU's `-icount` lets every instruction take the same time.

use crate::metal::spin;

/// Counts instructions.
#[derive(Debug)]
pub struct Counter {
    /// Ticks for [`SAMPLE`] instructions.
    sample: u64,
    /// Ticks for nothing.
    idle: u32,
}

/// Instructions of the loop that tells what a tick is.
const SAMPLE: u32 = 1_000_000;

impl Counter {
    /// Starts the clock and finds out how fast it goes.
    pub fn new() -> Self {
        start();
        let ticks = |loops| elapsed(|| spin(loops));
        Self { sample: u64::from(ticks(SAMPLE / 2 + 1) - ticks(1)), idle: elapsed(|| ()) }
    }

    /// The instructions that `work` took: on Arm at most a few million, and right to one or two.
    #[inline(always)]
    pub fn instructions(&self, work: impl FnOnce()) -> u32 {
        let ticks = elapsed(work).saturating_sub(self.idle);
        (u64::from(ticks) * u64::from(SAMPLE)).div_ceil(self.sample) as u32
    }
}

impl Default for Counter {
    fn default() -> Self {
        Self::new()
    }
}

#[inline(always)]
fn elapsed(work: impl FnOnce()) -> u32 {
    let before = now();
    work();
    now().wrapping_sub(before) & MAX_TICKS
}

/// SysTick has 24 bits.
#[cfg(target_arch = "arm")]
const MAX_TICKS: u32 = 0x00ff_ffff;

/// Starts SysTick at the processor's clock.
#[cfg(target_arch = "arm")]
fn start() {
    use cortex_m::{Peripherals, peripheral::syst::SystClkSource};
    let mut syst = Peripherals::take().expect("there is one counter").SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(MAX_TICKS);
    syst.clear_current();
    syst.enable_counter();
}

/// SysTick counts down.
#[cfg(target_arch = "arm")]
#[inline(always)]
fn now() -> u32 {
    MAX_TICKS - cortex_m::peripheral::SYST::get_current()
}

#[cfg(target_arch = "riscv32")]
const MAX_TICKS: u32 = u32::MAX;

/// The counter of instructions always runs.
#[cfg(target_arch = "riscv32")]
fn start() {}

#[cfg(target_arch = "riscv32")]
#[inline(always)]
fn now() -> u32 {
    riscv::register::minstret::read() as u32
}
