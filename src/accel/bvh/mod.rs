//! The bounding volume hierarchy: boxes in boxes, in nodes of 16 bytes.
//!
//! Boxes stand on a lattice of 16 bits per axis over the whole, rounded outward; children stand in pairs. It is built from
//! the top down (Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007) or from the bottom up
//! (Meister and Bittner, *Parallel locally-ordered clustering for bounding volume hierarchy construction*, 2018), first
//! with a leaf for each primitive; then subtrees become leaves where that is expected to pay. A [`Bvh`] is made by
//! [`Bvh::build`], fitted to primitives that moved by [`Bvh::refit`] or checked by [`Bvh::open`]; after any of these, no
//! walk can leave its words or fail to end.
//!
//! Leaves are ranges of positions, and a list at the end of the words says which primitive stands where. Who stores
//! the primitives in the [order](Bvh::order) of the leaves needs no list: [`Bvh::ordered`].

mod build;
mod collapse;
mod descend;
mod fit;
mod node;
mod open;
mod options;
mod ploc;
mod reinsert;
mod sah;
mod traverse;
mod weight;

pub use options::{Method, Options};
pub use traverse::BvhTraversal;

use self::node::{Link, Node, PAIR_WORDS, Pair};
use super::{
    Accelerator, Cell, Entries, Entry, Hierarchy, Inside, Leaf,
    leaf::References,
    segment::Segment,
    sweep::{Ahead, sweep},
};
use crate::{
    arena::Arena,
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, Lattice, PreparedRay},
    primitives::Primitives,
};

/// The greatest number of pairs within one another, and the height of a walk's stack: 256 bytes.
pub const MAX_DEPTH: usize = 32;

/// Words before the pairs: counts, root and bounds.
const HEADER_WORDS: usize = 10;

/// A bounding volume hierarchy in borrowed words.
///
/// ```
/// use hitscan::{Arena, Bvh, Mesh, Ray, Scene, bvh::Options, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = vec![0; Bvh::words(4, &Options::fast())];
/// let bvh = Bvh::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
/// let scene = Scene::new(bvh, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bvh<'a> {
    words: &'a [u32],
    pairs: &'a [Pair],
    references: References<'a>,
    root: Link,
    primitives: u32,
    depth: u32,
    bounds: Aabb,
    lattice: Lattice,
}

impl<'a> Bvh<'a> {
    /// Builds a hierarchy over `primitives` in the free words of `arena`, of which it keeps only the hierarchy.
    ///
    /// O(n log n) time. Neither recursion nor heap; all scratch is in the arena, and [`words`](Self::words) are just
    /// enough. The same primitives and options give the same words on every target.
    ///
    /// # Errors
    ///
    /// [`BuildError::Full`] if the arena is too small, [`BuildError::Bounds`] if a primitive has no valid bounds,
    /// [`BuildError::TooMany`] above 2^28 - 1 primitives. The arena is then as it was.
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| build::build(primitives, words, options))?;
        // What was just built needs no check of every node.
        Ok(Self::view(words).unwrap_or_else(Self::nothing))
    }

    /// Words of arena that building a hierarchy over `primitives` takes, scratch included.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        build::words(primitives, options)
    }

    /// A hierarchy over no primitives.
    fn nothing() -> Self {
        let (bounds, lattice) = (Aabb::EMPTY, Self::lattice(&Aabb::EMPTY));
        let (references, root) = (References::IDENTITY, Link::inner(0));
        Self { words: &[], pairs: &[], references, root, primitives: 0, depth: 0, bounds, lattice }
    }

    /// The hierarchy as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// How many pairs of nodes it has.
    #[must_use]
    pub const fn pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// How many pairs lie within one another.
    #[must_use]
    pub const fn depth(&self) -> u32 {
        self.depth
    }

    /// The numbers of the primitives in the order of the leaves.
    pub fn order(&self) -> impl ExactSizeIterator<Item = u32> + use<'a> {
        let references = self.references;
        (0..self.primitives).map(move |position| references.get(position))
    }

    /// Whether it expects the primitives in the order of its leaves, and has no list.
    #[must_use]
    pub const fn is_ordered(&self) -> bool {
        self.words.len() == HEADER_WORDS + self.pairs.len() * PAIR_WORDS
    }

    /// The same hierarchy without the list, over primitives that stand in its [`order`](Self::order): fewer words, the
    /// first ones of the same memory.
    ///
    /// Hits then carry the numbers of that order.
    ///
    /// ```
    /// use hitscan::{Arena, Bvh, Mesh, Scene, bvh::Options, glam::Vec3};
    /// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = [[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    /// let mesh = Mesh::new(&vertices, &triangles)?;
    /// let mut memory = vec![0; Bvh::words(4, &Options::fast())];
    /// let bvh = Bvh::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
    ///
    /// let sorted: Vec<[u16; 3]> = bvh.order().map(|number| triangles[number as usize]).collect();
    /// let mesh = Mesh::new(&vertices, &sorted[..])?;
    /// let scene = Scene::new(bvh.ordered(), &mesh)?;
    /// assert!(bvh.ordered().as_words().len() < bvh.as_words().len());
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn ordered(&self) -> Self {
        let words = self.words.get(..HEADER_WORDS + self.pairs.len() * PAIR_WORDS).unwrap_or(self.words);
        Self { words, references: References::IDENTITY, ..*self }
    }

    /// The work that the surface area heuristic expects of a ray through the bounds: pairs of nodes and primitive tests.
    ///
    /// Nothing is expected to be hit, so real rays do less.
    #[must_use]
    pub fn expected_work(&self) -> (f32, f32) {
        let whole = self.bounds.half_area();
        let chance = |bounds: &Aabb| if whole > 0.0 { bounds.half_area() / whole } else { 1.0 };
        let (mut steps, mut tests) = (0.0, 0.0);
        let mut count = |link: Link, chance: f32| {
            if link.is_leaf() {
                tests += chance * link.count() as f32;
            } else {
                steps += chance;
            }
        };
        count(self.root, 1.0);
        for node in self.pairs.iter().flatten() {
            count(node.link, chance(&node.planes.bounds(&self.lattice)));
        }
        (steps, tests)
    }

    /// When rays are in a box.
    #[inline(always)]
    fn segment(&self, node: &Node, bundle: &Bundle) -> Option<Segment> {
        Segment::of_bundle(&node.planes.bounds(&self.lattice), node.link.to_bits(), bundle)
    }

    /// Of a box: the planes on which nodes stand.
    fn lattice(bounds: &Aabb) -> Lattice {
        Lattice::over(bounds, [u32::from(u16::MAX); 3])
    }
}

impl<'a> Accelerator for Bvh<'a> {
    type Traversal = BvhTraversal<'a>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> BvhTraversal<'a> {
        BvhTraversal::new(self, ray)
    }

    /// Some entries: a look at a pair of boxes costs a ray more than an entry does.
    fn enter(&self, bundle: &Bundle) -> Entries {
        Entries::find(self, bundle, 4)
    }

    fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(Leaf<'a>) -> f32) -> bool {
        let look = |segment: Segment| {
            let link = Link::from_bits(segment.node);
            if link.is_leaf() {
                return Ahead::Primitives;
            }
            let Some(pair) = self.pairs.get(link.number() as usize) else { return Ahead::Nothing };
            let [left, right] = pair.each_ref().map(|node| self.segment(node, bundle));
            match (left, right) {
                (Some(left), Some(right)) if left.enter > right.enter => Ahead::Two(right, left),
                (Some(left), Some(right)) => Ahead::Two(left, right),
                (Some(only), None) | (None, Some(only)) => Ahead::One(only),
                (None, None) => Ahead::Nothing,
            }
        };
        let whole = Segment::of_bundle(&self.bounds, self.root.to_bits(), bundle);
        sweep::<MAX_DEPTH>(whole, look, |node| {
            let link = Link::from_bits(node);
            visit(Leaf::of(self.references, link.number(), link.count()))
        });
        true
    }

    #[inline]
    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> BvhTraversal<'a> {
        BvhTraversal::within(self, entry, ray)
    }
}

impl<'a> Hierarchy for Bvh<'a> {
    type Node = u32;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<u32>> {
        (self.primitives > 0).then_some(Cell { bounds: self.bounds, node: self.root.to_bits() })
    }

    fn open(&self, cell: &Cell<u32>) -> Inside<u32, Leaf<'a>> {
        let link = Link::from_bits(cell.node);
        if link.is_leaf() {
            return Inside::Leaf(Leaf::of(self.references, link.number(), link.count()));
        }
        let Some(pair) = self.pairs.get(link.number() as usize) else { return Inside::Cells([None; 2]) };
        Inside::Cells(
            pair.map(|node| Some(Cell { bounds: node.planes.bounds(&self.lattice), node: node.link.to_bits() })),
        )
    }
}

/// The section of a bounding volume hierarchy.
impl<'a> Stored<'a> for Bvh<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::open(asset.section(crate::asset::Kind::Bvh)?)?)
    }
}
