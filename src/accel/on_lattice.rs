//! Walks in whole numbers, for rays on the lattice of a structure.

use core::ops::Range;

use super::{Accelerator, List};
use crate::geometry::LatticeRay;

/// A structure whose planes are those of a lattice over its bounds, or lie between them.
///
/// A [`LatticeScene`](crate::LatticeScene) walks it without any float; only the final `t` is one.
pub trait LatticeAccelerator: Accelerator {
    /// What walks it.
    type Walk: LatticeWalk;

    /// A walk at the beginning of `ray`, which all later calls must repeat; it is of the space over the structure's bounds.
    fn walk(&self, ray: &LatticeRay) -> Self::Walk;
}

/// A walk along a ray in whole numbers.
pub trait LatticeWalk {
    /// The numbers of the primitives in a leaf.
    type Leaf: Iterator<Item = u32>;

    /// The next leaf that the ray may enter before it is deeper than `depth`, in whole planes of its major axis, which must
    /// not grow from call to call.
    fn next_leaf(&mut self, ray: &LatticeRay, depth: i32) -> Option<Self::Leaf>;
}

impl LatticeAccelerator for List {
    type Walk = Option<Range<u32>>;

    fn walk(&self, _ray: &LatticeRay) -> Option<Range<u32>> {
        Some(0..self.primitives())
    }
}

/// All of a list at once.
impl LatticeWalk for Option<Range<u32>> {
    type Leaf = Range<u32>;

    fn next_leaf(&mut self, _ray: &LatticeRay, _depth: i32) -> Option<Range<u32>> {
        self.take()
    }
}
