//! The only unsafe code: faults that end the program, the stack pointer, raw stack words, a loop of known length.

use core::arch::asm;

use semihosting::{eprintln, process};

/// The exit status after a fault; after a panic it is 101.
const FAULT: i32 = 102;

/// A fault ends the program; by default it would hang.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
    eprintln!("hard fault at {:#010x}", frame.pc());
    process::exit(FAULT)
}

/// Nothing enables an interrupt.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    eprintln!("unexpected interrupt {number}");
    process::exit(FAULT)
}

/// A fault ends the program; by default it would hang.
#[cfg(target_arch = "riscv32")]
#[unsafe(export_name = "ExceptionHandler")]
fn exception(_frame: &mut riscv_rt::TrapFrame) {
    eprintln!("exception at {:#010x}: {:?}", riscv::register::mepc::read(), riscv::register::mcause::read().cause());
    process::exit(FAULT)
}

/// Executes what is no instruction.
pub fn fault() {
    // SAFETY: the handlers above do not return.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("udf #0");
        #[cfg(target_arch = "riscv32")]
        asm!("unimp");
    }
}

/// Executes 2 instructions `n` times, and a few before.
#[inline(never)]
pub fn spin(n: u32) {
    // SAFETY: counts a register down.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("2: subs {0}, {0}, #1", "bne 2b", inout(reg) n => _, options(nomem, nostack));
        #[cfg(target_arch = "riscv32")]
        asm!("2: addi {0}, {0}, -1", "bnez {0}, 2b", inout(reg) n => _, options(nomem, nostack));
    }
}

unsafe extern "C" {
    /// The end of static memory, below which the stack must not grow.
    static __sheap: u32;
}

/// What unused stack is painted with.
const PAINT: u32 = 0xc5c5_c5c5;

/// At most this much stack is painted.
const PAINTED_BYTES: usize = 32 * 1024;

#[inline(always)]
fn stack_pointer() -> usize {
    let address;
    // SAFETY: reads a register.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("mov {}, sp", out(reg) address, options(nomem, nostack, preserves_flags));
        #[cfg(target_arch = "riscv32")]
        asm!("mv {}, sp", out(reg) address, options(nomem, nostack, preserves_flags));
    }
    address
}

/// The stack that a call of `query` takes, in bytes. No interrupt takes its part, so that the counter stands still.
pub fn stack_of(query: &mut dyn FnMut()) -> usize {
    #[cfg(target_arch = "arm")]
    return cortex_m::interrupt::free(|_| stack_of_all(query));
    #[cfg(target_arch = "riscv32")]
    stack_of_all(query)
}

/// The same of work that is counted or takes long, with what interrupts take: paints what lies below, and looks how far it
/// was written.
#[inline(never)]
pub fn stack_of_all(work: &mut dyn FnMut()) -> usize {
    let top = stack_pointer();
    let bottom = (top - PAINTED_BYTES).max(&raw const __sheap as usize);
    let words = (bottom..top).step_by(size_of::<u32>()).map(|address| address as *mut u32);
    for word in words.clone() {
        // SAFETY: aligned, above static memory and below the stack pointer, where nothing lives: no call intervenes.
        unsafe { word.write_volatile(PAINT) };
    }
    work();
    // SAFETY: the same words.
    let untouched = words.take_while(|word| unsafe { word.read_volatile() } == PAINT).count();
    top - bottom - untouched * size_of::<u32>()
}
