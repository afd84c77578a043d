//! Structures and presets as numbers.

use engine::accel::Plan;

use crate::status::Status;

/// A structure over triangles. All give the same hits.
#[repr(u32)]
#[derive(Clone, Copy)]
pub enum Structure {
    /// None: each ray tests each triangle.
    List = 0,
    /// A uniform grid: the quickest to build.
    Grid = 1,
    /// An octree.
    Octree = 2,
    /// A kD-tree: the fastest rays.
    KdTree = 3,
    /// A kD-tree in two thirds of the bytes.
    CompactKdTree = 4,
    /// A bounding volume hierarchy.
    Bvh = 5,
    /// A dual-split tree: the fewest bytes.
    DualSplit = 6,
}

/// What a structure is tuned for.
#[repr(u32)]
#[derive(Clone, Copy)]
pub enum Preset {
    /// The fewest bytes.
    Small = 0,
    /// Nearly as fast in less than half the bytes of the fastest.
    Balanced = 1,
    /// The least time per ray.
    Fast = 2,
}

impl Structure {
    const ALL: [Self; 7] =
        [Self::List, Self::Grid, Self::Octree, Self::KdTree, Self::CompactKdTree, Self::Bvh, Self::DualSplit];
}

impl Preset {
    /// One of three options.
    fn of<T>(number: u32, small: T, balanced: T, fast: T) -> Result<T, Status> {
        match [Self::Small, Self::Balanced, Self::Fast].get(number as usize) {
            Some(Self::Small) => Ok(small),
            Some(Self::Balanced) => Ok(balanced),
            Some(Self::Fast) => Ok(fast),
            None => Err(Status::Choice),
        }
    }
}

macro_rules! options {
    ($structure:ident, $preset:ident) => {{
        use engine::$structure::Options;
        Preset::of($preset, Options::small(), Options::balanced(), Options::fast())?
    }};
}

/// What two numbers from C choose.
pub fn chosen(structure: u32, preset: u32) -> Result<Plan, Status> {
    Ok(match Structure::ALL.get(structure as usize).ok_or(Status::Choice)? {
        Structure::List => Plan::List,
        Structure::Grid => Plan::Grid(options!(grid, preset)),
        Structure::Octree => Plan::Octree(options!(octree, preset)),
        Structure::KdTree => Plan::KdTree(options!(kdtree, preset)),
        Structure::CompactKdTree => Plan::CompactKdTree(options!(kdtree, preset)),
        Structure::Bvh => Plan::Bvh(options!(bvh, preset)),
        Structure::DualSplit => Plan::DualSplit(options!(dualsplit, preset)),
    })
}
