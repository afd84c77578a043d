//! The uniform grid: space in equal cells, quick to build and the least work per ray where primitives lie evenly.
//!
//! One table and one list, without pointers, after Lagae and Dutré, *Compact, fast and robust grids for ray tracing*,
//! 2008: cells are counted, the counts summed, and the references filled in from behind; then they are packed ([`Met`]). A [`Grid`] is made by
//! [`Grid::build`] or checked by [`Grid::open`]; after either, no walk can leave its words or fail to end.

mod along;
mod build;
mod cells;
mod course;
mod cover;
mod line;
mod met;
mod open;
mod options;
mod resolution;
mod sweep;
mod traverse;

pub use met::Met;
pub use options::{Form, Options};
pub use traverse::GridTraversal;

use self::{cells::Cells, course::Course};
use super::{Accelerator, Cell, Hierarchy, Inside};
use crate::{
    arena::Arena,
    asset::{Asset, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Axis, Lattice, PreparedRay},
    primitives::Primitives,
};

/// Words before the table: counts, resolution and bounds.
const HEADER_WORDS: usize = 13;

/// The most cells along an axis: two planes of the lattice for each.
const MAX_RESOLUTION: u32 = Lattice::MAX / 2;

/// The most cells, and the most primitives.
const MAX_COUNT: u32 = 1 << 28;

/// A uniform grid in borrowed words.
///
/// ```
/// use hitscan::{Arena, Grid, Mesh, Ray, Scene, glam::Vec3, grid::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let mut memory = vec![0; Grid::words(4, &Options::fast())];
/// let grid = Grid::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?;
/// let scene = Scene::new(grid, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::ONE, Vec3::NEG_ONE)).unwrap();
/// assert_eq!(hit.primitive, 3);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    words: &'a [u32],
    cells: Cells<'a>,
    /// Of all cells: see [`met`].
    entries: &'a [u16],
    reference_count: u32,
    primitives: u32,
    resolution: [u32; 3],
    bounds: Aabb,
    lattice: Lattice,
    course: Course,
}

impl<'a> Grid<'a> {
    /// Builds a grid over `primitives` in the free words of `arena`, of which it keeps only the grid.
    ///
    /// O(n) time. Neither recursion nor heap; all scratch is in the arena, and [`words`](Self::words) always suffice. The
    /// same primitives and options give the same words on every target.
    ///
    /// # Errors
    ///
    /// [`BuildError::Full`] if the arena is too small, [`BuildError::Bounds`] if a primitive has no valid bounds,
    /// [`BuildError::Budget`] if not even a single cell fits into [`Options::max_bytes`], [`BuildError::TooMany`] above
    /// 2^28 primitives, or from 2^24 on with [`Form::Octants`]. The arena is then as it was.
    pub fn build<P: Primitives + ?Sized>(
        primitives: &P,
        arena: &mut Arena<'a>,
        options: &Options,
    ) -> Result<Self, BuildError> {
        let words = arena.build(|words| build::build(primitives, words, options))?;
        // What was just built needs no check of every cell.
        Ok(Self::view(words).unwrap_or_else(Self::nothing))
    }

    /// Words of arena that always suffice to build a grid over `primitives`, scratch included.
    #[must_use]
    pub const fn words(primitives: usize, options: &Options) -> usize {
        build::words(primitives, options)
    }

    /// A grid over no primitives.
    fn nothing() -> Self {
        Self {
            words: &[],
            cells: Cells::NONE,
            entries: &[],
            reference_count: 0,
            primitives: 0,
            resolution: [1; 3],
            bounds: Aabb::EMPTY,
            lattice: Lattice::over(&Aabb::EMPTY, [2; 3]),
            course: Course::new(&Lattice::over(&Aabb::EMPTY, [2; 3]), &Aabb::EMPTY),
        }
    }

    /// The grid as words: what a file, flash, a GPU or a message holds.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// How many cells it has along each axis.
    #[must_use]
    pub const fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// How many references its cells hold, or somewhat more: a number far above the last one in its cell counts twice.
    #[must_use]
    pub const fn reference_count(&self) -> usize {
        self.reference_count as usize
    }
}

impl<'a> Accelerator for Grid<'a> {
    type Traversal = GridTraversal<'a>;

    fn primitives(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> GridTraversal<'a> {
        GridTraversal::new(self, ray)
    }

    #[inline(always)]
    fn visit(&self, ray: &PreparedRay, t_max: f32, visit: impl FnMut(Met<'a>) -> Option<f32>) {
        self.sweep(ray, t_max, visit);
    }
}

/// Cells of a grid: the first of them and how many there are, along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    first: [u32; 3],
    count: [u32; 3],
}

/// Blocks of cells, halved along their longest side until there is one cell.
impl<'a> Hierarchy for Grid<'a> {
    type Node = Block;
    type Leaf = Met<'a>;

    fn root(&self) -> Option<Cell<Block>> {
        let node = Block { first: [0; 3], count: self.resolution };
        (self.primitives > 0).then_some(Cell { bounds: self.bounds, node })
    }

    fn open(&self, cell: &Cell<Block>) -> Inside<Block, Met<'a>> {
        let Block { first: [x, y, z], count: [nx, ny, nz] } = cell.node;
        let axis = if nx >= ny && nx >= nz {
            Axis::X
        } else if ny >= nz {
            Axis::Y
        } else {
            Axis::Z
        };
        let (first, count) = match axis {
            Axis::X => (x, nx),
            Axis::Y => (y, ny),
            Axis::Z => (z, nz),
        };
        if count <= 1 {
            let references = self.cells.of(cells::index(self.resolution, [x, y, z]));
            let met = references.and_then(|references| Met::new(self.entries, references, 0xff));
            return Inside::Leaf(met.unwrap_or(Met::NOTHING));
        }
        let half = count / 2;
        let with = |first: u32, count: u32| match axis {
            Axis::X => Block { first: [first, y, z], count: [count, ny, nz] },
            Axis::Y => Block { first: [x, first, z], count: [nx, count, nz] },
            Axis::Z => Block { first: [x, y, first], count: [nx, ny, count] },
        };
        let (below, above) = cell.bounds.split(axis, self.lattice.position(axis, (first + half) * 2));
        Inside::Cells([
            Some(Cell { bounds: below, node: with(first, half) }),
            Some(Cell { bounds: above, node: with(first + half, count - half) }),
        ])
    }
}

/// The section of a grid.
impl<'a> Stored<'a> for Grid<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::open(asset.section(crate::asset::Kind::Grid)?)?)
    }
}
