//! Must fail: a panic ends the run with status 101.

#![no_std]
#![no_main]

#[firmware::entry]
fn main() -> ! {
    panic!("as it should")
}
