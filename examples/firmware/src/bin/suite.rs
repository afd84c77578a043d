//! All programs in one boot, for `check`.

#![no_std]
#![no_main]

use firmware::{
    entry,
    programs::{display, flash_query, on_device_build, stack, tof_sensor},
    run,
};

#[entry]
fn main() -> ! {
    run(&[
        ("flash_query", flash_query::run),
        ("on_device_build", on_device_build::run),
        ("display", display::run),
        ("tof_sensor", tof_sensor::run),
        ("stack", stack::run),
    ])
}
