use std::vec::Vec;

use super::hull::Hull;

/// A binary hierarchy over references: what builders make and the wide tree is collapsed from.
#[derive(Debug, Default)]
pub(super) struct Binary {
    /// The root first; none over no primitives. Children stand side by side, behind their parents, depth first.
    pub(super) nodes: Vec<BinaryNode>,
    /// Numbers of primitives, in the order of the leaves.
    pub(super) references: Vec<u32>,
}

/// A node of a [`Binary`].
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct BinaryNode(Hull);

impl BinaryNode {
    /// Over `count` references.
    #[inline(always)]
    pub(super) fn leaf(hull: Hull, first: usize, count: usize) -> Self {
        Self(hull.with_words([first as u32, count as u32]))
    }

    /// Over the children at `first` and behind.
    #[inline(always)]
    pub(super) fn inner(hull: Hull, first: usize) -> Self {
        Self::leaf(hull, first, 0)
    }

    /// Around all that is referenced below.
    #[inline(always)]
    pub(super) const fn hull(&self) -> Hull {
        self.0
    }

    /// Of a leaf, its first reference; else its first child.
    #[inline(always)]
    pub(super) const fn first(&self) -> usize {
        self.0.words()[0] as usize
    }

    /// References of a leaf; 0 of a node with children.
    #[inline(always)]
    pub(super) const fn count(&self) -> usize {
        self.0.words()[1] as usize
    }

    /// The same with another box.
    #[inline(always)]
    pub(super) fn with_hull(self, hull: Hull) -> Self {
        Self(hull.with_words(self.0.words()))
    }
}
