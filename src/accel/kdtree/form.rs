use super::{HEADER_WORDS, node::Node};
use crate::geometry::{Aabb, Lattice};

/// How a tree is stored; the builder's steps are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// [`KdTree`](super::KdTree): any plane, 8 bytes a node.
    Plain,
    /// [`CompactKdTree`](super::CompactKdTree): planes of a lattice, 4 bytes a node.
    Compact,
}

/// The number of the last plane across each axis of a compact tree: 14 bits.
pub(super) const LAST_PLANE: u32 = (1 << 14) - 1;

/// From this count on a compact leaf's stands in a word of its own.
pub(super) const MANY: u32 = (1 << 8) - 1;

/// From this number on a compact leaf's first reference or primitive stands in a word of its own.
pub(super) const FAR: u32 = (1 << 22) - 1;

/// From this distance on a compact node's right child stands in a word of its own.
pub(super) const LONG: u32 = (1 << 16) - 1;

impl Form {
    /// The planes that a tree in `bounds` may use, if not all.
    pub(super) fn lattice(self, bounds: &Aabb) -> Option<Lattice> {
        match self {
            Self::Plain => None,
            Self::Compact => Some(lattice(bounds)),
        }
    }

    /// Half-words of a node without references.
    pub(super) const fn node_size(self) -> u32 {
        match self {
            Self::Plain => Node::WORDS as u32 * 2,
            Self::Compact => 2,
        }
    }

    /// Half-words of an inner node over subtrees that may take `budget`.
    pub(super) const fn inner_size(self, budget: u32) -> u32 {
        match self {
            Self::Compact if may_be_long(budget / 2) => 4,
            _ => self.node_size(),
        }
    }

    /// Half-words of a leaf of `count` primitives whose references take `size` each, in a tree that may take `most`.
    pub(super) const fn leaf_size(self, count: u32, size: u32, most: u32) -> u32 {
        let references = if count > 1 { count.saturating_mul(size) } else { 0 };
        let words = match self {
            Self::Plain => 0,
            Self::Compact => (count >= MANY) as u32 + (most >= FAR) as u32,
        };
        references.saturating_add(self.node_size() + 2 * words)
    }

    /// The bytes of a tree of one leaf.
    pub(super) const fn least_bytes(self, primitives: usize) -> usize {
        // A single reference stands in the node; an odd number of narrow ones is padded to a word.
        let references = if primitives > 1 { primitives.saturating_mul(reference_bytes(primitives)) } else { 0 };
        // A compact leaf's number is 0 here, or that of the only primitive, which is 0.
        let node = match self {
            Self::Plain => Node::WORDS,
            Self::Compact => 1 + (primitives >= MANY as usize) as usize,
        };
        references.saturating_add((HEADER_WORDS + node) * 4 + 3) / 4 * 4
    }
}

/// The planes of a compact tree in `bounds`.
pub(super) fn lattice(bounds: &Aabb) -> Lattice {
    Lattice::over(bounds, [LAST_PLANE; 3])
}

/// Whether the words of so many nodes may be too far to be stepped over in 16 bits: each takes up to three.
pub(super) const fn may_be_long(nodes: u32) -> bool {
    nodes >= LONG / 3
}

/// The bytes of a reference: two where they suffice.
pub(super) const fn reference_bytes(primitives: usize) -> usize {
    if primitives <= 1 << 16 { 2 } else { 4 }
}
