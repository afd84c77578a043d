//! Scenes in flash, made by `build.rs`: opened, not copied.

use hitscan::{KdTree, Mesh};

use crate::Answer;

/// A mesh, its tree, and what the host found in them.
#[derive(Clone, Copy, Debug)]
pub struct Baked {
    vertices: &'static [u32],
    triangles: &'static [[u16; 3]],
    tree: &'static [u32],
    /// The host's answer to the camera's rays.
    pub answer: Answer,
}

impl Baked {
    /// The triangles, once all are checked.
    pub fn mesh(&self) -> Mesh<'static> {
        Mesh::new(bytemuck::cast_slice(self.vertices), self.triangles).expect("build.rs made a valid mesh")
    }

    /// The tree, once all its words are checked.
    pub fn tree(&self) -> KdTree<'static> {
        KdTree::open(self.tree).expect("build.rs made a valid tree")
    }

    /// Bytes of flash: vertices, corners, tree.
    pub const fn bytes(&self) -> [usize; 3] {
        [size_of_val(self.vertices), size_of_val(self.triangles), size_of_val(self.tree)]
    }
}

include!(concat!(env!("OUT_DIR"), "/baked.rs"));
