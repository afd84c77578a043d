use std::vec::Vec;

use crate::geometry::Aabb;

/// A binary hierarchy over references: what builders make and the wide tree is collapsed from.
#[derive(Debug, Default)]
pub(super) struct Binary {
    /// The root first; none over no primitives. Children stand side by side, behind their parents.
    pub(super) nodes: Vec<BinaryNode>,
    /// Numbers of primitives; those of a leaf stand together.
    pub(super) references: Vec<u32>,
}

/// A node of a [`Binary`].
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    /// Around all that is referenced below.
    pub(super) bounds: Aabb,
    /// Of a leaf, its first reference; else its first child.
    pub(super) first: u32,
    /// References of a leaf; 0 of a node with children.
    pub(super) count: u32,
}
