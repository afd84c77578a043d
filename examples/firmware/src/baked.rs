//! Assets in flash, made by `build.rs`: checked once, then used where they lie.

use hitscan::{
    KdTree, LatticeMesh, LatticeScene, Mesh, Primitives, Scene,
    accel::{Accelerator, LatticeAccelerator},
    asset::{Asset, Stored},
    primitives::LatticeTriangles,
};

use crate::{Answer, hash::Hash};

/// An asset, and what the host found in it.
#[derive(Clone, Copy, Debug)]
pub struct Baked {
    /// The asset: a mesh and its kD-tree.
    pub bytes: &'static [u8],
    /// The host's answer to the camera's rays.
    pub answer: Answer,
}

impl Baked {
    fn asset(&self) -> Asset<'static> {
        Asset::open(self.bytes).expect("build.rs bakes valid assets")
    }

    /// A part of the asset.
    pub fn read<T: Stored<'static>>(&self) -> T {
        self.asset().read().expect("build.rs bakes meshes and trees")
    }

    /// The tree with its mesh.
    pub fn scene(&self) -> Scene<KdTree<'static>, Mesh<'static>> {
        self.scene_under()
    }

    /// The structure with its mesh.
    pub fn scene_under<A: Accelerator + Stored<'static>>(&self) -> Scene<A, Mesh<'static>> {
        self.scene_of()
    }

    /// The structure with its primitives.
    pub fn scene_of<A: Accelerator + Stored<'static>, P: Primitives + Stored<'static>>(&self) -> Scene<A, P> {
        self.asset().scene().expect("build.rs bakes meshes with their structures")
    }

    /// The structure with its mesh on a lattice, in floating point.
    pub fn scene_on_lattice<A: Accelerator + Stored<'static>>(&self) -> Scene<A, LatticeMesh<'static>> {
        self.asset().scene().expect("build.rs bakes meshes with their structures")
    }

    /// The structure with its mesh on a lattice, in whole numbers.
    pub fn lattice_scene<A: LatticeAccelerator + Stored<'static>, P: LatticeTriangles + Stored<'static>>(
        &self,
    ) -> LatticeScene<A, P> {
        self.asset().lattice_scene().expect("build.rs bakes meshes with their structures")
    }
}

/// A structure over a knot.
#[derive(Clone, Copy, Debug)]
pub struct Contestant {
    /// The structure and its options.
    pub name: &'static str,
    /// How many triangles the knot has.
    pub triangles: usize,
    /// What the structure takes.
    pub bytes: usize,
    /// The asset.
    pub baked: Baked,
}

/// A function of a structure's type, for the structure that a contestant is named after.
#[macro_export]
macro_rules! for_structure {
    ($contestant:expr, $function:ident) => {
        match $contestant.name.split(' ').next() {
            Some("grid") => $function::<hitscan::Grid>,
            Some("octree") => $function::<hitscan::Octree>,
            Some("kdtree") => $function::<hitscan::KdTree>,
            Some("kdtree-compact") => $function::<hitscan::CompactKdTree>,
            Some("bvh") => $function::<hitscan::Bvh>,
            _ => $function::<hitscan::DualSplit>,
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/baked.rs"));
