use super::Accelerator;
use crate::geometry::Aabb;

/// A structure seen as boxes within boxes, for searches that follow no ray.
///
/// Every primitive lies, as a whole or in parts, in the boxes of the leaves that name it.
pub trait Hierarchy: Accelerator {
    /// What tells the cells of the structure apart.
    type Node: Copy;

    /// The numbers of the primitives in a leaf.
    type Leaf: Iterator<Item = u32>;

    /// The cell of everything; none of nothing.
    fn root(&self) -> Option<Cell<Self::Node>>;

    /// What is in a cell that this structure gave. At most [`MAX_LEVELS`] cells lie within one another.
    fn open(&self, cell: &Cell<Self::Node>) -> Inside<Self::Node, Self::Leaf>;
}

/// How many cells may lie within one another: the stack of a search is so high.
pub const MAX_LEVELS: usize = 64;

/// A part of a structure and a box around it.
#[derive(Clone, Copy, Debug)]
pub struct Cell<N> {
    /// The box.
    pub bounds: Aabb,
    /// What the structure knows it by.
    pub node: N,
}

impl<N> Cell<N> {
    /// The same box for another node.
    pub(crate) const fn with<M>(&self, node: M) -> Cell<M> {
        Cell { bounds: self.bounds, node }
    }
}

/// What is in a [`Cell`].
#[derive(Clone, Copy, Debug)]
pub enum Inside<N, L> {
    /// Up to two cells.
    Cells([Option<Cell<N>>; 2]),
    /// Primitives.
    Leaf(L),
}
