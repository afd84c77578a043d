//! Closest and any hits in an asset in flash.

#![no_std]
#![no_main]

use firmware::{entry, programs::flash_query, run};

#[entry]
fn main() -> ! {
    run(&[("flash_query", flash_query::run)])
}
