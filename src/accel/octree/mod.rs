//! The octree: space divided in eight at a point, in nodes of one word.
//!
//! A cell is divided by three planes that meet in a point; which octants have anything in them is a mask, and the children
//! are found by counting its bits. Octrees for rays: Glassner, *Space subdivision for fast ray tracing*, 1984; planes
//! computed from the ray, not cells from neighbours: Revelles, Ureña and Lastra, *An efficient parametric algorithm for
//! octree traversal*, 2000. The point need not be the middle: it is put where the surface area heuristic expects the least
//! work, and axes along which it expects none saved are left alone. An [`Octree`] is made by [`Octree::build`] or checked
//! by [`Octree::open`]; after either, no walk can leave its words or fail to end.

mod build;
mod distribute;
mod division;
mod hierarchy;
mod node;
mod open;
mod options;
mod split;
mod stage;
mod traverse;

pub use hierarchy::Octants;
pub use options::{Options, Split};
pub use traverse::OctreeTraversal;

use self::node::{Node, Point};
use super::{Accelerator, Cell, Hierarchy, Inside, Leaf, MAX_LEVELS, segment::Segment, sweep::sweep};
use crate::{
    arena::Arena,
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, PreparedRay},
    primitives::Primitives,
};

/// The greatest depth of a tree, and the height of a walk's stack: 448 bytes.
pub const MAX_DEPTH: usize = 16;

/// Words before the nodes: counts and bounds.
const HEADER_WORDS: usize = 10;

/// An octree in borrowed words.
///
/// ```
/// use hitscan::{Arena, Mesh, Octree, Ray, Scene, glam::Vec3, octree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = vec![0; Octree::words(4, &Options::fast())];
/// let tree = Octree::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
/// let scene = Scene::new(tree, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Octree<'a> {
    words: &'a [u32],
    /// Nodes, points and references, each behind what leads to it; the root first.
    body: &'a [u32],
    nodes: u32,
    references: u32,
    primitives: u32,
    depth: u32,
    bounds: Aabb,
}

/// The words of a tree of one leaf.
const fn least_words(primitives: usize) -> usize {
    match primitives {
        0 => HEADER_WORDS,
        _ => (HEADER_WORDS + 1).saturating_add(leaf_words(primitives, reference_halves(primitives))),
    }
}

/// The half-words of a reference: one where it suffices.
const fn reference_halves(primitives: usize) -> u32 {
    if primitives <= 1 << 16 { 1 } else { 2 }
}

/// The words behind a leaf of so many references.
const fn leaf_words(count: usize, halves: u32) -> usize {
    match count {
        // How many there are: none.
        0 => 1,
        1 => 0,
        _ => {
            let counted = if count > node::MAX_FEW as usize { 1 } else { 0 };
            count.saturating_mul(halves as usize).saturating_add(1) / 2 + counted
        }
    }
}

impl<'a> Octree<'a> {
    /// Builds a tree over `primitives` in the free words of `arena`, of which it keeps only the tree.
    ///
    /// O(n log n) time. Neither recursion nor heap; all scratch is in the arena, and [`words`](Self::words) always
    /// suffice. The same primitives and options give the same words on every target.
    ///
    /// # Errors
    ///
    /// [`BuildError::Full`] if the arena is too small, [`BuildError::Bounds`] if a primitive has no valid bounds,
    /// [`BuildError::Budget`] if not even a single leaf fits into [`Options::max_bytes`], [`BuildError::TooMany`] above
    /// 2^24 primitives. The arena is then as it was.
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| build::build(primitives, words, options))?;
        // What was just built needs no check of every node.
        Ok(Self::view(words).unwrap_or(Self::NOTHING))
    }

    /// Words of arena that always suffice to build a tree over `primitives`, scratch included.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        build::words(primitives, options)
    }

    /// A tree over no primitives.
    const NOTHING: Self =
        Self { words: &[], body: &[], nodes: 0, references: 0, primitives: 0, depth: 0, bounds: Aabb::EMPTY };

    /// The tree as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// How many nodes it has, leaves included.
    #[must_use]
    pub const fn node_count(&self) -> usize {
        self.nodes as usize
    }

    /// How many references its leaves hold, those of one primitive left out: they stand in the node.
    #[must_use]
    pub const fn reference_count(&self) -> usize {
        self.references as usize
    }

    /// The number of points above its deepest leaf.
    #[must_use]
    pub const fn depth(&self) -> u32 {
        self.depth
    }

    /// The work that the surface area heuristic expects of a ray through the bounds: nodes and primitive tests.
    ///
    /// Nothing is expected to be hit, so real rays do less.
    #[must_use]
    pub fn expected_work(&self) -> (f32, f32) {
        // One waits for each level of cells within one another.
        let mut stack: heapless::Vec<Cell<Octants>, MAX_LEVELS> = heapless::Vec::new();
        let whole = self.bounds.half_area();
        let (mut nodes, mut tests) = (0.0, 0.0);
        let mut next = self.root();
        while let Some(cell) = next {
            let chance = if whole > 0.0 { cell.bounds.half_area() / whole } else { 1.0 };
            // The octants on some sides only are no node.
            if self.node(cell.node.word).is_some_and(|node| node.octants() == cell.node.octants) {
                nodes += chance;
            }
            next = match Hierarchy::open(self, &cell) {
                Inside::Cells([Some(first), Some(second)]) => {
                    let _ = stack.push(second);
                    Some(first)
                }
                Inside::Cells([first, second]) => first.or(second).or_else(|| stack.pop()),
                Inside::Leaf(leaf) => {
                    tests += chance * leaf.count() as f32;
                    stack.pop()
                }
            };
        }
        (nodes, tests)
    }

    /// The node at a word.
    #[inline(always)]
    fn node(&self, word: u32) -> Option<Node> {
        self.body.get(word as usize).map(|&word| Node(word))
    }

    /// The point that begins at a word.
    fn point(&self, word: u32) -> Option<Point> {
        Point::from_words(self.body.get(word as usize..)?)
    }

    /// Whether references take a word.
    #[inline(always)]
    const fn is_wide(&self) -> bool {
        reference_halves(self.primitives as usize) == 2
    }
}

impl<'a> Accelerator for Octree<'a> {
    type Traversal = OctreeTraversal<'a>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> OctreeTraversal<'a> {
        OctreeTraversal::new(self, ray)
    }

    fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(Leaf<'a>) -> f32) -> bool {
        let whole = self.whole(0).and_then(|whole| Segment::of_bundle(&self.bounds, whole.to_bits(), bundle));
        sweep::<{ 3 * MAX_DEPTH }>(
            whole,
            |segment| self.ahead(segment, bundle),
            |bits| {
                let node = self.node(Octants::from_bits(bits).word);
                node.map_or(f32::NEG_INFINITY, |node| visit(node.leaf_in(self.body, self.is_wide())))
            },
        );
        true
    }
}

/// The section of an octree.
impl<'a> Stored<'a> for Octree<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::open(asset.section(crate::asset::Kind::Octree)?)?)
    }
}
