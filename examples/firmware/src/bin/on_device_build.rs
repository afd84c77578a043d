//! Every structure built in the device's memory, and a moving obstacle.

#![no_std]
#![no_main]

use firmware::{entry, programs::on_device_build, run};

#[entry]
fn main() -> ! {
    run(&[("on_device_build", on_device_build::run)])
}
