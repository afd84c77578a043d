//! Instructions executed, by the board's own clock: QEMU's `-icount` lets every instruction take the same time.

#[cfg(target_arch = "arm")]
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use crate::metal::spin;

/// Counts instructions.
#[derive(Debug)]
pub struct Counter {
    /// Ticks for [`SAMPLE`] instructions.
    sample: u64,
    /// Ticks for nothing.
    idle: u64,
}

/// Instructions of the loop that tells what a tick is.
const SAMPLE: u32 = 1_000_000;

impl Counter {
    /// Starts the clock and finds out how fast it goes.
    pub fn new() -> Self {
        start();
        let ticks = |loops| elapsed(|| spin(loops));
        Self { sample: ticks(SAMPLE / 2 + 1) - ticks(1), idle: elapsed(|| ()) }
    }

    /// The instructions that `work` takes, right to one or two.
    #[inline(always)]
    pub fn instructions(&self, work: impl FnOnce()) -> u64 {
        let ticks = elapsed(work).saturating_sub(self.idle);
        (ticks * u64::from(SAMPLE)).div_ceil(self.sample)
    }
}

impl Default for Counter {
    fn default() -> Self {
        Self::new()
    }
}

#[inline(always)]
fn elapsed(work: impl FnOnce()) -> u64 {
    let before = now();
    work();
    now() - before
}

/// SysTick counts 24 bits down, then begins anew.
#[cfg(target_arch = "arm")]
const PERIOD: u32 = 1 << 24;

/// How often SysTick began anew.
#[cfg(target_arch = "arm")]
static PERIODS: AtomicU32 = AtomicU32::new(0);

#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
fn SysTick() {
    // Not `fetch_add`: Cortex-M0 has none, and nothing interrupts this.
    PERIODS.store(PERIODS.load(Relaxed) + 1, Relaxed);
}

/// Starts SysTick at the processor's clock.
#[cfg(target_arch = "arm")]
fn start() {
    use cortex_m::{Peripherals, peripheral::syst::SystClkSource};
    let mut syst = Peripherals::take().expect("there is one counter").SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();
}

#[cfg(target_arch = "arm")]
#[inline(never)]
fn now() -> u64 {
    loop {
        let periods = PERIODS.load(Relaxed);
        let left = cortex_m::peripheral::SYST::get_current();
        // At 0 a period has ended, and the next has not begun; or it has, and the interrupt that counts it is on its way.
        let is_between = left == 0 || cortex_m::peripheral::SCB::is_pendst_pending();
        if !is_between && PERIODS.load(Relaxed) == periods {
            return u64::from(periods) * u64::from(PERIOD) + u64::from(PERIOD - 1 - left);
        }
    }
}

/// RISC-V counts instructions, and always does.
#[cfg(target_arch = "riscv32")]
fn start() {}

#[cfg(target_arch = "riscv32")]
#[inline(never)]
fn now() -> u64 {
    riscv::register::minstret::read64()
}
