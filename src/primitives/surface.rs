use glam::{Vec2, Vec3};

use super::Hit;
use crate::{
    geometry::{Ray, Triangle},
    math,
};

/// A surface at a hit: what shading and secondary rays need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, in the scene's coordinates.
    pub point: Vec3,
    /// The unit normal of the shape itself, on its front.
    pub geometric_normal: Vec3,
    /// The unit normal to shade with, on the front; the geometric one unless the shape has better.
    pub shading_normal: Vec3,
    /// Texture coordinates, if the shape has some ([`Mapped`](super::Mapped)); otherwise, on a triangle, the weights of its
    /// second and third corner.
    pub uv: Vec2,
    /// Whether the ray came from the front.
    pub front: bool,
    /// How far `point` may lie off the surface, along the normal.
    pub error: f32,
}

impl Surface {
    /// The surface at `t` of a shape of which nothing else is known: it faces the ray.
    #[must_use]
    pub fn facing(ray: &Ray, t: f32) -> Self {
        let point = ray.at(t);
        let normal = unit(-ray.direction);
        let magnitude = ray.origin.abs() + (ray.direction * t).abs();
        // t to 2^-17, three roundings for the point.
        let error = magnitude.max_element() / 65_536.0;
        Self { point, geometric_normal: normal, shading_normal: normal, uv: Vec2::ZERO, front: true, error }
    }

    /// The surface of a triangle that `ray` hits.
    ///
    /// The point is made from the corners, so its error does not grow with the distance from which it was hit.
    pub(super) fn of_triangle(triangle: &Triangle, ray: &Ray, hit: &Hit) -> Self {
        let Some(prepared) = ray.prepare() else { return Self::facing(ray, hit.t) };
        let (v, w) = triangle.weights(&prepared);
        let point = triangle.a * (1.0 - v - w) + triangle.b * v + triangle.c * w;
        let normal = unit(triangle.normal());
        let front = match triangle.intersect(&prepared, f32::MIN, f32::MAX) {
            Some(crossing) => crossing.front,
            None => ray.direction.dot(normal) < 0.0,
        };
        // Seven roundings: three products, two sums, and the weights' two; Physically Based Rendering, §6.8.
        let magnitude = triangle.a.abs() + triangle.b.abs() + triangle.c.abs();
        let error = magnitude.max_element() * (8.0 / 16_777_216.0);
        Self { point, geometric_normal: normal, shading_normal: normal, uv: Vec2::new(v, w), front, error }
    }

    /// The geometric normal on the side from which the ray came.
    #[inline]
    #[must_use]
    pub fn normal_towards_ray(&self) -> Vec3 {
        if self.front { self.geometric_normal } else { -self.geometric_normal }
    }

    /// Where a ray that leaves along `direction` must start not to meet this surface again.
    ///
    /// The point is moved along the normal by its error bound, not by a magic epsilon, and rounded away from the surface.
    /// Wächter and Binder, *A fast and robust method for avoiding self-intersection*, Ray Tracing Gems, 2019; bounds after
    /// Pharr, Jakob and Humphreys, *Physically Based Rendering*, §6.8.
    #[must_use]
    pub fn start_towards(&self, direction: Vec3) -> Vec3 {
        let normal =
            if direction.dot(self.geometric_normal) < 0.0 { -self.geometric_normal } else { self.geometric_normal };
        // A box of half-width `error` around the point has this extent along the normal.
        let reach = self.error * (normal.x.abs() + normal.y.abs() + normal.z.abs());
        let moved = self.point + normal * reach;
        let away = |x: f32, n: f32| {
            if n > 0.0 {
                x.next_up()
            } else if n < 0.0 {
                x.next_down()
            } else {
                x
            }
        };
        Vec3::new(away(moved.x, normal.x), away(moved.y, normal.y), away(moved.z, normal.z))
    }
}

/// `v` at length 1, whatever its length was; x if it has none.
pub(crate) fn unit(v: Vec3) -> Vec3 {
    let largest = v.abs().max_element();
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec3::X;
    }
    // Scaled first, so that no square overflows or vanishes.
    let v = v / largest;
    v / math::sqrt(v.dot(v))
}
