//! What is peculiar to each structure: its memory, its words, its options, and that it is worth them.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod adversaries;
mod along;
mod bvh;
mod compact;
mod dualsplit;
mod grid;
mod heights;
mod kdtree;
mod memory;
mod octree;
mod quality;
mod reach;

/// Rays for each comparison with the list; `tests/equality.rs` casts more at all structures.
fn rays() -> usize {
    common::rays(100_000)
}
