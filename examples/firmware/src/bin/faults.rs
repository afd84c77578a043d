//! Must fail: a hard fault ends the run with status 102 instead of hanging.

#![no_std]
#![no_main]

#[firmware::entry]
fn main() -> ! {
    firmware::fault();
    firmware::finish(true)
}
