//! Walks in whole numbers, for rays on the lattice of a structure.

use core::ops::Range;

use super::{Accelerator, List};
use crate::geometry::LatticePath;

/// A structure whose planes are those of a lattice over its bounds, or lie between them.
///
/// A [`LatticeScene`](crate::LatticeScene) walks it without any float; only the final `t` is one.
pub trait LatticeAccelerator: Accelerator {
    /// What walks it.
    type Walk: LatticeWalk;

    /// A walk at its beginning.
    fn walk(&self) -> Self::Walk;
}

/// A walk along a ray, or the rays of a tile, in whole numbers.
pub trait LatticeWalk {
    /// The numbers of the primitives in a leaf.
    type Leaf: Iterator<Item = u32>;

    /// The next leaf that may be entered before `depth`, which must not grow from call to call; the path, of the space over the
    /// structure's bounds, must be the same.
    fn next_leaf<P: LatticePath>(&mut self, path: &P, depth: i32) -> Option<Self::Leaf>;
}

impl LatticeAccelerator for List {
    type Walk = Option<Range<u32>>;

    fn walk(&self) -> Option<Range<u32>> {
        Some(0..self.primitives())
    }
}

/// All of a list at once.
impl LatticeWalk for Option<Range<u32>> {
    type Leaf = Range<u32>;

    fn next_leaf<P: LatticePath>(&mut self, _path: &P, _depth: i32) -> Option<Range<u32>> {
        self.take()
    }
}
