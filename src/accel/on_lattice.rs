//! Walks in whole numbers, for rays on the lattice of a structure.

use core::ops::Range;

use super::{Accelerator, List};
use crate::geometry::LatticeRay;

/// A structure whose planes are those of a lattice over its bounds, or lie between them.
///
/// A [`LatticeScene`](crate::LatticeScene) walks it without any float.
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

/// A node, and the depths between which a ray is in its cell, in whole planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LatticeSegment {
    pub(crate) node: u32,
    pub(crate) enter: i32,
    pub(crate) exit: i32,
}

impl LatticeSegment {
    /// The first node, and the part of the ray that is in the lattice.
    #[inline(always)]
    pub(crate) fn whole(ray: &LatticeRay) -> Self {
        let (enter, exit) = ray.inside;
        Self { node: 0, enter: i32::from(enter), exit: i32::from(exit) }
    }
}

/// Segments that wait, the nearest on top, in 8 bytes each: depths in the lattice take 16 bits.
#[derive(Clone, Debug)]
pub(crate) struct LatticeWaiting<const N: usize>(heapless::Vec<[u32; 2], N>);

impl<const N: usize> LatticeWaiting<N> {
    /// None. Not filled where it is made, so that it is made where it stays: to move it would take as long as ten nodes.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self(heapless::Vec::new())
    }

    /// Puts one on top; it cannot fail, because no tree is deeper than its stack.
    #[inline(always)]
    pub(crate) fn push(&mut self, node: u32, enter: i32, exit: i32) {
        let _ = self.0.push([node, (enter as u32) << 16 | exit as u32]);
    }

    /// The nearest that begins before the ray is deeper than `end`.
    #[inline(always)]
    pub(crate) fn pop(&mut self, end: i32) -> Option<LatticeSegment> {
        loop {
            let [node, depths] = self.0.pop()?;
            let enter = (depths >> 16) as i32;
            if enter <= end {
                return Some(LatticeSegment { node, enter, exit: (depths & 0xffff) as i32 });
            }
        }
    }
}
