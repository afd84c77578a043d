//! What is built on the device.

use hitscan::{
    Arena, Bvh, DualSplit, Grid, KdTree, Mesh, Octree, bvh, dualsplit, error::BuildError, grid, kdtree, octree,
};

/// A structure and the options for it.
#[derive(Debug)]
pub struct Build {
    /// What it is called.
    pub name: &'static str,
    /// As many words as always suffice for so many triangles.
    pub words: fn(usize) -> usize,
    /// Builds it; its words.
    pub build: Builder,
}

/// A function of its own for each structure, so that none pays for the stack of another.
type Builder = for<'m> fn(&Mesh<'_>, &mut Arena<'m>) -> Result<&'m [u32], BuildError>;

macro_rules! builds {
    ($($(#[$condition:meta])? $name:literal: $structure:ty => $options:expr,)*) => {
        &[$($(#[$condition])? Build {
            name: $name,
            words: |triangles| <$structure>::words(triangles, &$options),
            build: |mesh, arena| Ok(<$structure>::build(mesh, arena, &$options)?.as_words()),
        },)*]
    };
}

/// The quickest first, then those with the fewest bytes; a micro:bit has no flash for all of their builders.
pub const BUILDS: &[Build] = builds! {
    "grid-quick": Grid => grid::Options::quick(),
    "dual-split-quick": DualSplit => dualsplit::Options::quick(),
    "dual-split": DualSplit => dualsplit::Options::small(),
    "bvh": Bvh => bvh::Options::small(),
    "octree": Octree => octree::Options::small(),
    "kdtree": KdTree => kdtree::Options::small(),
    #[cfg(not(small))]
    "kdtree-compact": hitscan::CompactKdTree => kdtree::Options::small(),
};
