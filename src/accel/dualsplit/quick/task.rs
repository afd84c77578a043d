use super::{
    super::{block::Block, stage::NONE},
    MAX_DEPTH,
};

/// A range of primitives to be divided; where it begins is known when its turn comes.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Task {
    /// What the planes above leave of the whole.
    pub(super) implied: Block,
    /// The split whose right child it is.
    pub(super) parent: u32,
    /// The word at which its nodes end at the latest.
    pub(super) limit: u32,
    /// How many primitives, and in the lower five bits how many splits are above.
    size: u32,
}

const _: () = assert!(MAX_DEPTH < 32);

impl Task {
    /// All primitives.
    pub(super) const fn whole(count: u32, limit: u32) -> Self {
        Self { implied: Block::WHOLE, parent: NONE, limit, size: count << 5 }
    }

    /// How many primitives.
    pub(super) const fn count(&self) -> u32 {
        self.size >> 5
    }

    /// How many splits are above.
    pub(super) const fn depth(&self) -> u32 {
        self.size & 31
    }

    /// A child with a part of them.
    pub(super) const fn child(&self, count: u32, implied: Block, parent: u32, limit: u32) -> Self {
        Self { implied, parent, limit, size: count << 5 | (self.depth() + 1) }
    }
}
