//! A time-of-flight sensor in a room with moving boxes.

#![no_std]
#![no_main]

use firmware::{entry, programs::tof_sensor, run};

#[entry]
fn main() -> ! {
    run(&[("tof_sensor", tof_sensor::run)])
}
