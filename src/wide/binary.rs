use std::vec::Vec;

use crate::geometry::Aabb;

/// The greatest depth of a [`Binary`], the root being at depth 0.
pub(super) const MAX_DEPTH: u32 = 64;

/// The most references in a leaf.
pub(super) const LEAF_SIZE: u32 = 8;

/// A binary hierarchy over references, what builders make and the wide tree is collapsed from.
///
/// Node 0 is the root; there are no nodes for no primitives. No node is deeper than [`MAX_DEPTH`].
#[derive(Debug)]
pub(super) struct Binary {
    /// The nodes, each before its children.
    pub nodes: Vec<BinaryNode>,
    /// The numbers of triangles that the leaves refer to; some repeatedly, if they were split.
    pub references: Vec<u32>,
}

/// A node of a [`Binary`].
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    /// A box around what of the triangles belongs to this node.
    pub bounds: Aabb,
    /// The first of two children if `count` is 0, else the first of the references.
    pub first: u32,
    /// How many references there are, at most [`LEAF_SIZE`]; 0 for a node with children.
    pub count: u32,
}
