use crate::wide::binary::BinaryNode;
use crate::wide::hull::Hull;

/// A node while it is built: the same as a [`BinaryNode`], its box in vectors.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct Node(Hull);

impl Node {
    /// Over `count` references.
    #[inline(always)]
    pub(super) fn leaf(hull: Hull, first: u32, count: u32) -> Self {
        Self(hull.with_words([first, count]))
    }

    /// Over the children at `first` and behind.
    #[inline(always)]
    pub(super) fn inner(hull: Hull, first: u32) -> Self {
        Self::leaf(hull, first, 0)
    }

    /// The box.
    #[inline(always)]
    pub(super) const fn hull(&self) -> Hull {
        self.0
    }

    /// The first child or reference.
    #[inline(always)]
    pub(super) const fn first(&self) -> u32 {
        self.0.words()[0]
    }

    /// How many references it has; 0 if it has children.
    #[inline(always)]
    pub(super) const fn count(&self) -> u32 {
        self.0.words()[1]
    }

    /// The same with another box.
    #[inline(always)]
    pub(super) fn with_hull(self, hull: Hull) -> Self {
        Self(hull.with_words(self.0.words()))
    }

    /// For those who collapse it.
    pub(super) fn finish(self) -> BinaryNode {
        BinaryNode { bounds: self.0.bounds(), first: self.first(), count: self.count() }
    }
}
