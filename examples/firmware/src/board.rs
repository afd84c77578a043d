//! What a program is given: a clock and memory.

use static_cell::ConstStaticCell;

use crate::Counter;

/// Words of static memory for arenas, strips of pixels and moving vertices; a micro:bit has 4096 in all.
pub const MEMORY_WORDS: usize = if cfg!(small) { 2560 } else { 1 << 16 };

static MEMORY: ConstStaticCell<[u32; MEMORY_WORDS]> = ConstStaticCell::new([0; MEMORY_WORDS]);

/// The board.
#[derive(Debug)]
pub struct Board {
    /// Counts instructions.
    pub counter: Counter,
    /// Memory for whatever the program builds.
    pub memory: &'static mut [u32],
}

impl Board {
    /// The only one.
    ///
    /// # Panics
    ///
    /// At the second call.
    pub fn take() -> Self {
        Self { counter: Counter::new(), memory: MEMORY.take() }
    }
}

/// A program's name, and what it does: whether all was well.
pub type Program = (&'static str, fn(&mut Board) -> bool);

/// Runs programs one after the other; the exit status tells whether all was well.
pub fn run(programs: &[Program]) -> ! {
    let mut board = Board::take();
    let mut passed = true;
    for (name, program) in programs {
        semihosting::println!("-- {name}");
        let well = program(&mut board);
        if !well {
            semihosting::println!("{name} FAILED");
        }
        passed &= well;
    }
    crate::finish(passed)
}
