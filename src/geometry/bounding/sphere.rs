//! The lecture's two spheres, and the pass that makes every sphere contain its points.

use glam::Vec3;

use super::wide::{Wide, add, mean, narrow, scale, square, sub, upward, wide};
use crate::{
    geometry::{Aabb, Sphere, in_range},
    math,
};

/// The sphere around all of `points` with its centre there, to the nearest `f32`; `None` of none, or if one is not in
/// range.
///
/// *Contains them:* a square of a distance is off by less than `2^-50` of it, its root by less, and the radius is
/// rounded upward from a product with `1 + 2^-48`.
pub(super) fn centered(center: Wide, points: impl Iterator<Item = Vec3>) -> Option<Sphere> {
    let center = narrow(center);
    let (mut largest, mut none) = (0.0, true);
    for point in points {
        if !in_range(point) {
            return None;
        }
        let square = square(sub(wide(point), wide(center)));
        largest = if square > largest { square } else { largest };
        none = false;
    }
    let radius = math::sqrt64(largest) * (1.0 + 1.0 / 281_474_976_710_656.0);
    (!none).then(|| Sphere::new(center, upward(radius)))
}

/// Spheres around points. All of them contain every point as real numbers; `None` of no points, or if a coordinate is
/// not finite or exceeds [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
impl Sphere {
    /// The barycentre of the points and the greatest distance from it: two passes.
    ///
    /// Where points are dense, the centre is drawn to them, and the sphere is larger than it need be.
    #[must_use]
    pub fn around_barycenter(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        centered(mean(points.clone())?, points)
    }

    /// The centre of the axis-aligned box and the greatest distance from it: two passes.
    #[must_use]
    pub fn around_box_center(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let Aabb { min, max } = Aabb::around(points.clone());
        centered(scale(add(wide(min), wide(max)), 0.5), points)
    }
}
