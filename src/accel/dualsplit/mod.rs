//! The dual-split tree: a bounding volume hierarchy whose nodes are two planes of 16 bits.
//!
//! After Lin, Shkurko, Mallett and Yuksel, *Dual-Split Trees*, I3D 2019. A node's two planes along one axis are where its
//! left child ends and where its right one begins; a node of one child *carves*, it cuts off empty space at two of
//! its faces. A box is implied by the planes above it. Leaves are ranges of positions; if the primitives stand in this order, nothing
//! else is stored ([`DualSplit::ordered`]).
//!
//! Built top-down by the surface area heuristic over the implied boxes. A [`DualSplit`] is made by [`DualSplit::build`] or
//! checked by [`DualSplit::open`]; after either, no walk can leave its words or fail to end.

mod block;
mod build;
mod lattice;
mod node;
mod open;
mod options;
mod quick;
mod split;
mod stage;
mod traverse;

pub use options::{Method, Options};
pub use traverse::DualSplitTraversal;

use self::{
    block::{Block, Face},
    node::{Head, Kind},
    open::{Form, Header},
};
use super::{
    Accelerator, Cell, Entries, Entry, Hierarchy, Inside, Leaf,
    leaf::References,
    segment::Segment,
    sweep::{Ahead, sweep},
};
use crate::{
    arena::{Arena, Full},
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, Lattice, PreparedRay},
    math::{greatest, least},
    primitives::Primitives,
};

/// The greatest depth of a tree, and the height of a walk's stack: 384 bytes.
pub const MAX_DEPTH: usize = 32;

/// Words before the nodes: counts and bounds.
const HEADER_WORDS: usize = 10;

/// Whether numbers of so many primitives take 16 bits.
const fn is_narrow(primitives: u32) -> bool {
    primitives <= 1 << 16
}

/// Words of the numbers of so many primitives.
const fn number_words(primitives: u32) -> usize {
    (if is_narrow(primitives) { primitives.div_ceil(2) } else { primitives }) as usize
}

/// A dual-split tree in borrowed words.
///
/// ```
/// use hitscan::{Arena, DualSplit, Mesh, Ray, Scene, dualsplit::Options, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = [0; DualSplit::words(4, &Options::balanced())];
/// let tree = DualSplit::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
/// let scene = Scene::new(tree, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
///
/// A walk keeps `HEIGHT` segments on its stack, of 12 bytes each, in whole numbers of 8: see
/// [`for_height`](Self::for_height).
#[derive(Clone, Copy, Debug)]
pub struct DualSplit<'a, const HEIGHT: usize = MAX_DEPTH> {
    words: &'a [u32],
    nodes: &'a [u32],
    references: References<'a>,
    lattice: Lattice,
    form: Form,
    primitives: u32,
    depth: u32,
    bounds: Aabb,
}

impl<'a> DualSplit<'a> {
    /// Builds a tree over `primitives` in the free words of `arena`, of which it keeps only the tree.
    ///
    /// O(n log n) time. Neither recursion nor heap; all scratch is in the arena, and [`words`](Self::words) always suffice. The same primitives and options give the same words on every target.
    ///
    /// # Errors
    ///
    /// [`BuildError::Full`] if the arena is too small, [`BuildError::Bounds`] if a primitive has no valid bounds,
    /// [`BuildError::TooMany`] above 2^26 primitives. The arena is then as it was.
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| match options.method {
            Method::Thorough => build::build(primitives, words, options),
            Method::Quick => quick::build(primitives, words, options),
        })?;
        // What was just built needs no check of every node.
        Ok(Self::view(words).unwrap_or_else(Self::nothing))
    }

    /// Words of arena that suffice to build a tree over `primitives`, scratch included.
    ///
    /// Of [`Method::Thorough`] also words without which it does not go; [`Method::Quick`] makes do with a kilobyte beside
    /// what the tree turns out to take, or beside 4.5 bytes per primitive if that is more: 6.5 above 65,536 primitives, and more
    /// where leaves are small.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        match options.method {
            Method::Thorough => stage::words(primitives),
            Method::Quick => quick::words(primitives, options.most()),
        }
    }

    /// A tree over no primitives.
    fn nothing() -> Self {
        Self {
            words: &[],
            nodes: &[],
            references: References::IDENTITY,
            lattice: Lattice::over(&Aabb::EMPTY, [Block::LAST; 3]),
            form: Form::Ordered,
            primitives: 0,
            depth: 0,
            bounds: Aabb::EMPTY,
        }
    }

    /// The same tree for walks with a lower stack; none if it is [deeper](Self::depth).
    ///
    /// ```
    /// # use hitscan::{Arena, DualSplit, Mesh, dualsplit::Options, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let mut memory = [0; DualSplit::words(1, &Options::balanced())];
    /// let tree = DualSplit::build(&mesh, &mut Arena::new(&mut memory), &Options::balanced())?;
    /// let tree: DualSplit<'_, 16> = tree.for_height().expect("12 levels or so are enough for a thousand triangles");
    /// # assert_eq!(tree.depth(), 0);
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn for_height<const LOWER: usize>(self) -> Option<DualSplit<'a, LOWER>> {
        let Self { words, nodes, references, lattice, form, primitives, depth, bounds } = self;
        let same = DualSplit { words, nodes, references, lattice, form, primitives, depth, bounds };
        (depth as usize <= LOWER).then_some(same)
    }
}

impl<'a, const HEIGHT: usize> DualSplit<'a, HEIGHT> {
    /// The tree as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// The numbers of the primitives in the order of the leaves.
    pub fn order(&self) -> impl ExactSizeIterator<Item = u32> + use<'a, HEIGHT> {
        let references = self.references;
        (0..self.primitives as usize).map(move |position| references.get(position as u32))
    }

    /// Whether it is over primitives in the order of the leaves, and so holds no numbers.
    #[must_use]
    pub fn is_ordered(&self) -> bool {
        self.form == Form::Ordered
    }

    /// The words of the same tree over primitives that the caller has put into [`order`](Self::order): without numbers.
    pub fn ordered_words(&self) -> impl Iterator<Item = u32> + use<'a, HEIGHT> {
        let (primitives, depth, bounds) = (self.primitives, self.depth, self.bounds);
        let nodes = self.nodes.len() as u32;
        let header = Header { nodes, primitives, depth, form: Form::Ordered, bounds };
        header.to_words().into_iter().chain(self.nodes.iter().copied())
    }

    /// The same tree over primitives that the caller has put into [`order`](Self::order): without numbers.
    ///
    /// ```
    /// # use hitscan::{Arena, DualSplit, Mesh, Scene, dualsplit::Options, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// # let triangles = [[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    /// # let mut memory = [0; 2 * DualSplit::words(4, &Options::balanced())];
    /// # let mut arena = Arena::new(&mut memory);
    /// let tree = DualSplit::build(&Mesh::new(&vertices, &triangles)?, &mut arena, &Options::small())?;
    /// let sorted: Vec<_> = tree.order().map(|number| triangles[number as usize]).collect();
    /// let scene = Scene::new(tree.ordered(&mut arena)?, Mesh::new(&vertices, &sorted[..])?)?;
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Full`] if the arena is too small.
    pub fn ordered<'m>(&self, arena: &mut Arena<'m>) -> Result<DualSplit<'m>, Full> {
        let at_least = HEADER_WORDS + self.nodes.len();
        let words = arena.build(|words| {
            let available = words.len();
            let places = words.get_mut(..at_least).ok_or(Full { at_least, available })?;
            places.iter_mut().zip(self.ordered_words()).for_each(|(place, word)| *place = word);
            Ok(at_least)
        })?;
        Ok(DualSplit::view(words).unwrap_or_else(DualSplit::nothing))
    }

    /// The number of splits above its deepest leaf.
    #[must_use]
    pub const fn depth(&self) -> u32 {
        self.depth
    }

    /// What the rays of a bundle find in a cell.
    #[inline(always)]
    fn ahead(&self, segment: Segment, bundle: &Bundle) -> Ahead {
        let Some(&word) = self.nodes.get(segment.node as usize) else { return Ahead::Nothing };
        let Some(kind) = Head::from_word(word).kind() else { return Ahead::Nothing };
        let planes = self.nodes.get(segment.node as usize + 1).copied().unwrap_or(0);
        let [first, second] = [planes & Block::LAST, planes >> 16];
        let next = segment.at(segment.node + 2);
        let cut = |segment: Segment, Face { axis, upper }: Face, plane: u32| {
            let plane = self.lattice.position(axis, plane);
            if upper { segment.below(axis, plane, bundle) } else { segment.above(axis, plane, bundle) }
        };
        match kind {
            Kind::Leaf { .. } => Ahead::Primitives,
            Kind::Carve { faces: [face, other] } => {
                let (rest, _) = cut(next, face, first);
                let (rest, _) = cut(rest, other, second);
                if rest.is_missed() { Ahead::Nothing } else { Ahead::One(rest) }
            }
            Kind::Split { axis, right } => {
                let (left, _) = cut(next, Face { axis, upper: true }, first);
                let (right, descends) = cut(segment.at(right), Face { axis, upper: false }, second);
                if descends { Ahead::of(right, left) } else { Ahead::of(left, right) }
            }
        }
    }

    /// A box cut by a plane, of which it keeps what lies before an upper face, or behind a lower one.
    fn cut(&self, bounds: Aabb, face: Face, plane: u32) -> Aabb {
        let Face { axis, upper } = face;
        let position = self.lattice.position(axis, plane);
        // The lattice may reach a little beyond the bounds.
        if upper {
            bounds.split(axis, least(position, axis.of(bounds.max))).0
        } else {
            bounds.split(axis, greatest(position, axis.of(bounds.min))).1
        }
    }
}

impl<'a, const HEIGHT: usize> Accelerator for DualSplit<'a, HEIGHT> {
    type Traversal = DualSplitTraversal<'a, HEIGHT>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> DualSplitTraversal<'a, HEIGHT> {
        DualSplitTraversal::new(self, ray)
    }

    /// One entry: a second one costs each ray more than it spares.
    fn enter(&self, bundle: &Bundle) -> Entries {
        Entries::find(self, bundle, 1)
    }

    fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(Leaf<'a>) -> f32) -> bool {
        let whole = Segment::of_bundle(&self.bounds, 0, bundle);
        sweep::<HEIGHT>(
            whole,
            |segment| self.ahead(segment, bundle),
            |node| {
                let head = self.nodes.get(node as usize).map_or(Head::leaf(0, 0), |&word| Head::from_word(word));
                visit(Leaf::of(self.references, head.first(), head.count()))
            },
        );
        true
    }

    #[inline]
    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> DualSplitTraversal<'a, HEIGHT> {
        DualSplitTraversal::within(self, entry, ray)
    }
}

/// What a node is known by is its word. Carves are opened with what they lead to.
impl<'a, const HEIGHT: usize> Hierarchy for DualSplit<'a, HEIGHT> {
    type Node = u32;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<u32>> {
        (self.primitives > 0).then_some(Cell { bounds: self.bounds, node: 0 })
    }

    fn open(&self, cell: &Cell<u32>) -> Inside<u32, Leaf<'a>> {
        let Cell { mut bounds, mut node } = *cell;
        // Ends, because each carve leads on.
        while let Some(kind) = self.nodes.get(node as usize).and_then(|&word| Head::from_word(word).kind()) {
            let planes = self.nodes.get(node as usize + 1).copied().unwrap_or(0);
            let planes = [planes & Block::LAST, planes >> 16];
            match kind {
                Kind::Carve { faces } => {
                    for (face, plane) in faces.into_iter().zip(planes) {
                        bounds = self.cut(bounds, face, plane);
                    }
                    node += 2;
                }
                Kind::Split { axis, right } => {
                    let [left_max, right_min] = planes;
                    let left = self.cut(bounds, Face { axis, upper: true }, left_max);
                    let right_bounds = self.cut(bounds, Face { axis, upper: false }, right_min);
                    let (left, right) =
                        (Cell { bounds: left, node: node + 2 }, Cell { bounds: right_bounds, node: right });
                    return Inside::Cells([Some(left), Some(right)]);
                }
                Kind::Leaf { first, count } => return Inside::Leaf(Leaf::of(self.references, first, count)),
            }
        }
        Inside::Cells([None; 2])
    }
}

/// The section of a dual-split tree, no deeper than the stack of its walks is high.
impl<'a, const HEIGHT: usize> Stored<'a> for DualSplit<'a, HEIGHT> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let tree = DualSplit::open(asset.section(crate::asset::Kind::DualSplit)?)?;
        Ok(tree.for_height().ok_or(DualSplit::too_deep())?)
    }
}
