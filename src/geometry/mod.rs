//! Rays and the shapes they meet: pure functions of their inputs, the same bits on every target.
//!
//! Coordinates are `f32` of at most 2^126 in magnitude ([`MAX_COORDINATE`]); a ray's parameter `t` counts
//! lengths of its direction, which need not be normalised.

mod aabb;
mod axis;
pub mod bounding;
mod bundle;
mod lattice;
mod obb;
mod on_lattice;
mod pencil;
pub(crate) mod ray;
mod sphere;
mod transform;
mod triangle;
mod volume;

pub use aabb::Aabb;
pub use axis::Axis;
pub use bounding::{Bounding, BoundingVolume};
pub use bundle::Bundle;

pub use lattice::Lattice;
pub use obb::Obb;
pub(crate) use on_lattice::{Depth, LatticePencil, Sight};
pub use on_lattice::{LatticePath, LatticeRay, LatticeRays, LatticeSpace};
pub use pencil::Pencil;
pub(crate) use pencil::{Screen, place};
pub(crate) use ray::{AxisView, beyond, descends, slack};
pub use ray::{PreparedRay, Ray};
pub use sphere::Sphere;
pub use transform::{Singular, Transform};
pub(crate) use triangle::{Corner, Either, intersect as intersect_triangle, intersect_quad};
pub use triangle::{Crossing, Triangle};
#[cfg(feature = "std")]
pub(crate) use triangle::{Possible, ShearLanes, Wedge, parameters, range};
pub use volume::Volume;

/// The largest coordinate magnitude accepted, 2^126: differences of two such numbers do not overflow.
pub const MAX_COORDINATE: f32 = f32::from_bits((126 + 127) << 23);

/// Whether all coordinates are finite and at most [`MAX_COORDINATE`] in magnitude.
#[inline]
pub(crate) fn in_range(v: glam::Vec3) -> bool {
    // Magnitudes order as their bits do, infinity and NaN above all: without an FPU a fraction of a comparison of floats.
    let fits = |x: f32| x.to_bits() & 0x7fff_ffff <= MAX_COORDINATE.to_bits();
    fits(v.x) & fits(v.y) & fits(v.z)
}

/// The point at `offset` from `point`, rounded once.
pub(crate) fn moved(point: glam::Vec3, [x, y, z]: [f64; 3]) -> glam::Vec3 {
    let sum = |from: f32, by: f64| (f64::from(from) + by) as f32;
    glam::Vec3::new(sum(point.x, x), sum(point.y, y), sum(point.z, z))
}
