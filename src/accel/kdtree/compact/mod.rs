//! The small form of the kD-tree: nodes of 4 bytes.
//!
//! Planes are numbers on a lattice over the bounds, children are found by distance. Built by the steps of
//! [`KdTree`](super::KdTree), which look at planes of the lattice only and so count what those really divide.
//!
//! A plane is one step thick: the left child ends where the step does and the right one begins where it does. Corners
//! hardly ever lie on the lattice, and where triangles meet at a thin plane beside their corners, all on one side would
//! reach over it: a quarter more bytes for the same tests. That children overlap by a step is nothing to a walk, which
//! keeps an interval for each.

mod lattice;
mod node;
mod open;
mod traverse;

pub(super) use node::Node;
pub use traverse::CompactKdTraversal;

use self::node::{Kind, kind};
use super::{
    MAX_DEPTH, Options, Side, build,
    enter::{self, Opened, Planes},
    form::Form,
};
use crate::{
    accel::{
        Accelerator, Cell, Entries, Entry, Hierarchy, Inside, Leaf, leaf::References, segment::Segment, sweep::sweep,
    },
    arena::Arena,
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, Lattice, PreparedRay},
    primitives::Primitives,
};

/// A kD-tree in nodes of 4 bytes: half the size of a [`KdTree`](super::KdTree), a little slower.
///
/// ```
/// use hitscan::{Arena, CompactKdTree, Mesh, Ray, Scene, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = vec![0; CompactKdTree::words(4, &Options::small())];
/// let tree = CompactKdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::small())?;
/// let scene = Scene::new(tree, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
///
/// A walk keeps `HEIGHT` segments on its stack, of 12 bytes each, in whole numbers of 8: see
/// [`for_height`](Self::for_height).
#[derive(Clone, Copy, Debug)]
pub struct CompactKdTree<'a, const HEIGHT: usize = MAX_DEPTH> {
    words: &'a [u32],
    /// Nodes, and the words that some need behind them.
    nodes: &'a [u32],
    references: References<'a>,
    reference_count: u32,
    primitives: u32,
    depth: u32,
    bounds: Aabb,
    lattice: Lattice,
}

impl<'a> CompactKdTree<'a> {
    /// Builds a tree over `primitives` in the free words of `arena`, of which it keeps only the tree.
    ///
    /// As [`KdTree::build`](super::KdTree::build).
    ///
    /// # Errors
    ///
    /// Those of [`KdTree::build`](super::KdTree::build).
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| build::build(primitives, words, options, Form::Compact))?;
        // What was just built needs no check of every node.
        Ok(Self::view(words).unwrap_or(Self::nothing()))
    }

    /// Words of arena that always suffice to build a tree over `primitives`, scratch included.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        build::words(primitives, options, Form::Compact)
    }

    /// A tree over no primitives.
    fn nothing() -> Self {
        Self {
            words: &[],
            nodes: &[],
            references: References::IDENTITY,
            reference_count: 0,
            primitives: 0,
            depth: 0,
            bounds: Aabb::EMPTY,
            lattice: Lattice::over(&Aabb::EMPTY, [1; 3]),
        }
    }

    /// The same tree for walks with a lower stack; none if it is [deeper](Self::depth).
    #[must_use]
    pub fn for_height<const LOWER: usize>(self) -> Option<CompactKdTree<'a, LOWER>> {
        let Self { words, nodes, references, reference_count, primitives, depth, bounds, lattice } = self;
        let same = CompactKdTree { words, nodes, references, reference_count, primitives, depth, bounds, lattice };
        (depth as usize <= LOWER).then_some(same)
    }
}

impl<'a, const HEIGHT: usize> CompactKdTree<'a, HEIGHT> {
    /// What a node says to all rays of a bundle.
    #[inline(always)]
    fn opened(&self, node: u32) -> Option<Opened> {
        Some(match kind(self.nodes, node)? {
            Kind::Inner { axis, plane, left, right, empty } => {
                let [begin, end] = [plane, plane + 1].map(|number| self.lattice.position(axis, number));
                Opened::Parted { planes: Planes { axis, begin, end }, left, right, empty }
            }
            Kind::Leaf { count, .. } => Opened::Leaf { is_empty: count == 0 },
        })
    }

    /// The tree as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// How many words its nodes take: no fewer than there are nodes.
    #[must_use]
    pub const fn node_words(&self) -> usize {
        self.nodes.len()
    }

    /// How many references its leaves hold, those of one primitive left out: they stand in the node.
    #[must_use]
    pub const fn reference_count(&self) -> usize {
        self.reference_count as usize
    }

    /// The number of planes above its deepest leaf.
    #[must_use]
    pub const fn depth(&self) -> u32 {
        self.depth
    }
}

impl<'a, const HEIGHT: usize> Accelerator for CompactKdTree<'a, HEIGHT> {
    type Traversal = CompactKdTraversal<'a, HEIGHT>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> CompactKdTraversal<'a, HEIGHT> {
        CompactKdTraversal::new(self, ray)
    }

    /// One entry: a second one costs each ray more than it spares.
    fn enter(&self, bundle: &Bundle) -> Entries {
        enter::entries(self.bounds, bundle, |node| self.opened(node))
    }

    fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(Leaf<'a>) -> f32) -> bool {
        let visit = |node| match kind(self.nodes, node) {
            Some(Kind::Leaf { first, count: 1, .. }) => visit(Leaf::of(References::IDENTITY, first, 1)),
            Some(Kind::Leaf { first, count, .. }) => visit(Leaf::of(self.references, first, count)),
            _ => f32::NEG_INFINITY,
        };
        let whole = Segment::of_bundle(&self.bounds, 0, bundle);
        sweep::<HEIGHT>(whole, |segment| enter::ahead(bundle, segment, |node| self.opened(node)), visit);
        true
    }

    #[inline]
    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> CompactKdTraversal<'a, HEIGHT> {
        CompactKdTraversal::within(self, entry, ray)
    }
}

impl<'a, const HEIGHT: usize> Hierarchy for CompactKdTree<'a, HEIGHT> {
    type Node = u32;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<u32>> {
        (self.primitives > 0).then_some(Cell { bounds: self.bounds, node: 0 })
    }

    fn open(&self, cell: &Cell<u32>) -> Inside<u32, Leaf<'a>> {
        match kind(self.nodes, cell.node) {
            Some(Kind::Inner { axis, plane, left, right, empty }) => {
                let [begin, end] = [plane, plane + 1].map(|number| self.lattice.position(axis, number));
                let (below, above) = (cell.bounds.split(axis, end).0, cell.bounds.split(axis, begin).1);
                let below = (empty != Some(Side::Left)).then_some(Cell { bounds: below, node: left });
                let above = (empty != Some(Side::Right)).then_some(Cell { bounds: above, node: right });
                Inside::Cells([below, above])
            }
            Some(Kind::Leaf { first, count: 1, .. }) => Inside::Leaf(Leaf::of(References::IDENTITY, first, 1)),
            Some(Kind::Leaf { first, count, .. }) => Inside::Leaf(Leaf::of(self.references, first, count)),
            None => Inside::Cells([None; 2]),
        }
    }
}

/// The section of a compact kD-tree, no deeper than the stack of its walks is high.
impl<'a, const HEIGHT: usize> Stored<'a> for CompactKdTree<'a, HEIGHT> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let tree = CompactKdTree::open(asset.section(crate::asset::Kind::CompactKdTree)?)?;
        Ok(tree.for_height().ok_or(CompactKdTree::too_deep())?)
    }
}
