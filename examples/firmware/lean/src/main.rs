//! As little as a program can be that asks an asset in flash for closest and any hits: what the library takes of flash is
//! its size less that of the same program without queries (no feature). The features name the structure, and say whether
//! the two queries are apart or one piece of code.

#![no_std]
#![no_main]

use core::hint::black_box;

#[cfg(feature = "structure")]
use firmware::baked::KNOT;
use firmware::{camera, entry};
use semihosting::process;

#[cfg(feature = "bvh")]
use hitscan::Bvh as Structure;
#[cfg(any(feature = "kdtree-compact", feature = "lattice-kdtree-compact"))]
use hitscan::CompactKdTree as Structure;
#[cfg(any(feature = "dual-split", feature = "lattice-dual-split"))]
use hitscan::DualSplit as Structure;
#[cfg(any(feature = "grid", feature = "grid-quads"))]
use hitscan::Grid as Structure;
#[cfg(any(feature = "kdtree", feature = "kdtree-quads"))]
use hitscan::KdTree as Structure;
#[cfg(feature = "octree")]
use hitscan::Octree as Structure;

#[cfg(all(feature = "structure", not(feature = "apart")))]
use hitscan::query::Wanted;

#[cfg(feature = "lattice")]
type Triangles = hitscan::LatticeMesh<'static>;
#[cfg(feature = "quads")]
type Triangles = hitscan::primitives::QuadMesh<hitscan::Mesh<'static>>;
#[cfg(all(feature = "structure", not(any(feature = "lattice", feature = "quads"))))]
type Triangles = hitscan::Mesh<'static>;

/// Whether a ray's two queries agree.
#[cfg(feature = "structure")]
fn agree() -> Result<bool, hitscan::Error> {
    let asset = hitscan::asset::Asset::open(black_box(KNOT.bytes))?;
    #[cfg(not(feature = "lattice"))]
    let scene = asset.scene::<Structure, Triangles>()?;
    #[cfg(feature = "lattice")]
    let scene = asset.lattice_scene::<Structure, Triangles>()?;
    let mut rays = camera::row(camera::HEIGHT / 2);
    #[cfg(not(feature = "apart"))]
    let agree = |ray| scene.hit(&ray, Wanted::Closest).is_some() == scene.hit(&ray, Wanted::Any).is_some();
    #[cfg(feature = "apart")]
    let agree = |ray| scene.closest_hit(&ray).is_some() == scene.any_hit(&ray);
    Ok(rays.all(agree))
}

/// Nothing to ask, but the rays are made.
#[cfg(not(feature = "structure"))]
fn agree() -> Result<bool, core::convert::Infallible> {
    Ok(camera::row(camera::HEIGHT / 2).all(|ray| black_box(ray).t_min == 0.0))
}

#[entry]
fn main() -> ! {
    process::exit(i32::from(!agree().unwrap_or(false)))
}
