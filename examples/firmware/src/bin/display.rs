//! Pictures on displays, strip by strip.

#![no_std]
#![no_main]

use firmware::{entry, programs::display, run};

#[entry]
fn main() -> ! {
    run(&[("display", display::run)])
}
