//! The wide hierarchy of hosts (feature `std`).

mod binary;
mod build;

pub use build::{Options, Progress};
