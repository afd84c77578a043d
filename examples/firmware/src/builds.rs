//! What is built on the device.

use hitscan::{
    Arena, Bvh, CompactKdTree, DualSplit, Grid, KdTree, Mesh, Octree, bvh, dualsplit, error::BuildError, grid, kdtree,
    octree,
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
    ($($name:literal: $structure:ident by $options:expr,)*) => {
        [$(Build {
            name: $name,
            words: |triangles| $structure::words(triangles, &$options),
            build: |mesh, arena| Ok($structure::build(mesh, arena, &$options)?.as_words()),
        },)*]
    };
}

/// The quickest first, then those with the fewest bytes.
pub const BUILDS: [Build; 7] = builds! {
    "grid-quick": Grid by grid::Options::quick(),
    "dual-split-quick": DualSplit by dualsplit::Options::quick(),
    "dual-split": DualSplit by dualsplit::Options::small(),
    "bvh": Bvh by bvh::Options::small(),
    "octree": Octree by octree::Options::small(),
    "kdtree": KdTree by kdtree::Options::small(),
    "kdtree-compact": CompactKdTree by kdtree::Options::small(),
};
