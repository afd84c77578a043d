//! All programs in one boot, for `check`; but on the small board, whose flash they fill, the sensor boots by itself.

#![no_std]
#![no_main]

use firmware::{
    entry,
    programs::{display, flash_query, on_device_build, stack},
    run,
};

#[entry]
fn main() -> ! {
    run(&[
        ("flash_query", flash_query::run),
        ("on_device_build", on_device_build::run),
        ("display", display::run),
        #[cfg(not(small))]
        ("tof_sensor", firmware::programs::tof_sensor::run),
        ("stack", stack::run),
    ])
}
