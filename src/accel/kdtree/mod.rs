//! The kD-tree: space halved by planes, in nodes of 8 bytes.
//!
//! Built top-down by one skeleton with three ways to [`Split`]; the surface area heuristic with clipped ("perfect")
//! splits after Wald and Havran, *On building fast kd-trees for ray tracing, and on doing that in O(N log N)*, 2006. A [`KdTree`] is made by [`KdTree::build`] or
//! checked by [`KdTree::open`]; after either, no walk can leave its words or fail to end.

mod build;
mod compact;
mod enter;
mod form;
mod node;
mod open;
mod options;
mod pack;
mod split;
mod stage;
mod traverse;

pub use compact::{CompactKdTraversal, CompactKdTree};
pub use options::{Options, Split};
pub use traverse::KdTraversal;

use self::{
    enter::{Opened, Planes},
    form::Form,
    node::{Kind, Node, Side},
};
use super::{
    Accelerator, Cell, Entries, Entry, Hierarchy, Inside, Leaf, leaf::References, segment::Segment, sweep::sweep,
};
use crate::{
    arena::Arena,
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, PreparedRay},
    primitives::Primitives,
};

/// The greatest depth of a tree, and the height of a walk's stack: 384 bytes.
///
/// The depth rule reaches it at 360,000 primitives.
pub const MAX_DEPTH: usize = 32;

/// Words before the nodes: counts and bounds.
const HEADER_WORDS: usize = 10;

/// A kD-tree in borrowed words.
///
/// ```
/// use hitscan::{Arena, KdTree, Mesh, Ray, Scene, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = vec![0; KdTree::words(4, &Options::fast())];
/// let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
/// let scene = Scene::new(tree, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
///
/// A walk keeps `HEIGHT` segments on its stack, of 12 bytes each: see [`for_height`](Self::for_height).
#[derive(Clone, Copy, Debug)]
pub struct KdTree<'a, const HEIGHT: usize = MAX_DEPTH> {
    words: &'a [u32],
    nodes: &'a [Node],
    references: References<'a>,
    reference_count: u32,
    primitives: u32,
    depth: u32,
    bounds: Aabb,
}

impl<'a> KdTree<'a> {
    /// Builds a tree over `primitives` in the free words of `arena`, of which it keeps only the tree.
    ///
    /// O(n log n) time. Neither recursion nor heap; all scratch is in the arena, and [`words`](Self::words) always
    /// suffice. The same primitives and options give the same words on every target.
    ///
    /// # Errors
    ///
    /// [`BuildError::Full`] if the arena is too small, [`BuildError::Bounds`] if a primitive has no valid bounds,
    /// [`BuildError::Budget`] if not even a single leaf fits into [`Options::max_bytes`], [`BuildError::TooMany`] above
    /// 2^28 primitives. The arena is then as it was.
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| build::build(primitives, words, options, Form::Plain))?;
        // What was just built needs no check of every node.
        Ok(Self::view(words).unwrap_or(Self::NOTHING))
    }

    /// Words of arena that always suffice to build a tree over `primitives`, scratch included.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        build::words(primitives, options, Form::Plain)
    }

    /// A tree over no primitives.
    const NOTHING: Self = Self {
        words: &[],
        nodes: &[],
        references: References::IDENTITY,
        reference_count: 0,
        primitives: 0,
        depth: 0,
        bounds: Aabb::EMPTY,
    };

    /// The same tree for walks with a lower stack; none if it is [deeper](Self::depth).
    ///
    /// ```
    /// # use hitscan::{Arena, KdTree, Mesh, Scene, glam::Vec3, kdtree::Options};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let mut memory = vec![0; KdTree::words(1, &Options::small())];
    /// let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::small())?;
    /// if let Some(shallow) = tree.for_height::<16>() {
    ///     let scene = Scene::new(shallow, &mesh)?;
    ///     # let _ = scene;
    /// }
    /// # assert_eq!(tree.depth(), 0);
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn for_height<const LOWER: usize>(self) -> Option<KdTree<'a, LOWER>> {
        let Self { words, nodes, references, reference_count, primitives, depth, bounds } = self;
        let same = KdTree { words, nodes, references, reference_count, primitives, depth, bounds };
        (depth as usize <= LOWER).then_some(same)
    }
}

impl<'a, const HEIGHT: usize> KdTree<'a, HEIGHT> {
    /// What a node says to all rays of a bundle.
    #[inline(always)]
    fn opened(&self, node: u32) -> Option<Opened> {
        Some(match self.nodes.get(node as usize)?.kind() {
            Kind::Inner { axis, position, right, empty } => {
                let planes = Planes { axis, begin: position, end: position };
                Opened::Parted { planes, left: node + 1, right, empty }
            }
            Kind::Leaf { count, .. } => Opened::Leaf { is_empty: count == 0 },
        })
    }

    /// The tree as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// How many nodes it has.
    #[must_use]
    pub const fn node_count(&self) -> usize {
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

    /// The work that the surface area heuristic expects of a ray through the bounds: nodes and primitive tests.
    ///
    /// Nothing is expected to be hit, so real rays do less.
    #[must_use]
    pub fn expected_work(&self) -> (f32, f32) {
        let mut stack: heapless::Vec<(u32, Aabb), MAX_DEPTH> = heapless::Vec::new();
        let whole = self.bounds.half_area();
        let (mut nodes, mut tests) = (0.0, 0.0);
        let mut next = Some((0, self.bounds));
        while let Some((index, cell)) = next {
            let chance = if whole > 0.0 { cell.half_area() / whole } else { 1.0 };
            nodes += chance;
            next = match self.nodes.get(index as usize).map(|node| node.kind()) {
                Some(Kind::Inner { axis, position, right, empty }) => {
                    let (left_cell, right_cell) = cell.split(axis, position);
                    match empty {
                        None => {
                            let _ = stack.push((right, right_cell));
                            Some((index + 1, left_cell))
                        }
                        Some(Side::Left) => Some((index + 1, right_cell)),
                        Some(Side::Right) => Some((index + 1, left_cell)),
                    }
                }
                Some(Kind::Leaf { count, .. }) => {
                    tests += chance * count as f32;
                    stack.pop()
                }
                None => None,
            };
        }
        (nodes, tests)
    }
}

impl<'a, const HEIGHT: usize> Accelerator for KdTree<'a, HEIGHT> {
    type Traversal = KdTraversal<'a, HEIGHT>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> KdTraversal<'a, HEIGHT> {
        KdTraversal::new(self, &self.bounds, 0, ray)
    }

    /// One entry: a second one costs each ray more than it spares.
    fn enter(&self, bundle: &Bundle) -> Entries {
        enter::entries(self.bounds, bundle, |node| self.opened(node))
    }

    fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(Leaf<'a>) -> f32) -> bool {
        let visit = |node: u32| match self.nodes.get(node as usize).map(|node| node.kind()) {
            Some(Kind::Leaf { first, count: 1 }) => visit(Leaf::of(References::IDENTITY, first, 1)),
            Some(Kind::Leaf { first, count }) => visit(Leaf::of(self.references, first, count)),
            _ => f32::NEG_INFINITY,
        };
        let whole = Segment::of_bundle(&self.bounds, 0, bundle);
        sweep::<HEIGHT>(whole, |segment| enter::ahead(bundle, segment, |node| self.opened(node)), visit);
        true
    }

    #[inline]
    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> KdTraversal<'a, HEIGHT> {
        KdTraversal::new(self, &entry.bounds, entry.node, ray)
    }
}

impl<'a, const HEIGHT: usize> Hierarchy for KdTree<'a, HEIGHT> {
    type Node = u32;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<u32>> {
        (self.primitives > 0).then_some(Cell { bounds: self.bounds, node: 0 })
    }

    fn open(&self, cell: &Cell<u32>) -> Inside<u32, Leaf<'a>> {
        let Some(node) = self.nodes.get(cell.node as usize) else { return Inside::Cells([None; 2]) };
        match node.kind() {
            Kind::Inner { axis, position, right, empty } => {
                let (below, above) = cell.bounds.split(axis, position);
                let below = (empty != Some(Side::Left)).then_some(Cell { bounds: below, node: cell.node + 1 });
                let above = (empty != Some(Side::Right)).then_some(Cell { bounds: above, node: right });
                Inside::Cells([below, above])
            }
            Kind::Leaf { first, count: 1 } => Inside::Leaf(Leaf::of(References::IDENTITY, first, 1)),
            Kind::Leaf { first, count } => Inside::Leaf(Leaf::of(self.references, first, count)),
        }
    }
}

/// The section of a kD-tree, no deeper than the stack of its walks is high.
impl<'a, const HEIGHT: usize> Stored<'a> for KdTree<'a, HEIGHT> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let tree = KdTree::open(asset.section(crate::asset::Kind::KdTree)?)?;
        Ok(tree.for_height().ok_or(KdTree::too_deep())?)
    }
}
