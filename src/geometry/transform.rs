use core::fmt;

use glam::{Mat3, Vec3};

use super::{Aabb, Ray};
use crate::math;

/// An affine map and its inverse: a linear part (rotation, scale, shear, mirroring), then a translation.
///
/// ```
/// use hitscan::{geometry::Transform, glam::{Mat3, Vec3}};
/// let place = Transform::new(Mat3::from_diagonal(Vec3::splat(2.0)), Vec3::X)?;
/// assert_eq!(place.point(Vec3::Y), Vec3::new(1.0, 2.0, 0.0));
/// assert_eq!(place.inverse().point(Vec3::new(1.0, 2.0, 0.0)), Vec3::Y);
/// # Ok::<(), hitscan::geometry::Singular>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Transform {
    linear: Mat3,
    inverse: Mat3,
    translation: Vec3,
}

/// The linear part of a transform has no inverse, or a component is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Singular {
    /// The determinant found.
    pub determinant: f32,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the transform cannot be inverted: its determinant is {}", self.determinant)
    }
}

impl core::error::Error for Singular {}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { linear: Mat3::IDENTITY, inverse: Mat3::IDENTITY, translation: Vec3::ZERO };

    /// The map of `p` to `linear * p + translation`.
    ///
    /// # Errors
    ///
    /// [`Singular`] if `linear` cannot be inverted in `f32` or anything is not finite.
    pub fn new(linear: Mat3, translation: Vec3) -> Result<Self, Singular> {
        let determinant = linear.determinant();
        let inverse = linear.inverse();
        if determinant != 0.0 && inverse.is_finite() && linear.is_finite() && translation.is_finite() {
            Ok(Self { linear, inverse, translation })
        } else {
            Err(Singular { determinant })
        }
    }

    /// The map that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { linear: self.inverse, inverse: self.linear, translation: -(self.inverse * self.translation) }
    }

    /// Where a point goes.
    #[must_use]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.translation
    }

    /// Where a point comes from.
    #[must_use]
    pub(crate) fn point_back(&self, p: Vec3) -> Vec3 {
        self.inverse * (p - self.translation)
    }

    /// The factor by which all lengths are multiplied; `None` if some differ from others or angles change, by more than
    /// 2^-16.
    #[must_use]
    pub fn factor(&self) -> Option<f32> {
        let Mat3 { x_axis, y_axis, z_axis } = self.linear;
        let dot = |a: Vec3, b: Vec3| {
            let [x, y, z] = [(a.x, b.x), (a.y, b.y), (a.z, b.z)].map(|(a, b)| f64::from(a) * f64::from(b));
            x + y + z
        };
        let squares = [dot(x_axis, x_axis), dot(y_axis, y_axis), dot(z_axis, z_axis)];
        let [x, y, z] = squares;
        let mean = (x + y + z) / 3.0;
        let off = [x - mean, y - mean, z - mean, dot(x_axis, y_axis), dot(y_axis, z_axis), dot(z_axis, x_axis)];
        let factor = math::sqrt64(mean) as f32;
        let similar = off.iter().all(|x| (-mean / 65_536.0..=mean / 65_536.0).contains(x));
        (similar && factor > 0.0 && factor.is_finite()).then_some(factor)
    }

    /// Where a direction goes; the translation does not touch it.
    #[must_use]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.linear * v
    }

    /// Where a surface normal goes, not normalised: by the inverse transposed.
    #[must_use]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        self.inverse.transpose() * n
    }

    /// Where a ray goes: `t` counts the same points.
    #[must_use]
    pub fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point(ray.origin), direction: self.vector(ray.direction), ..*ray }
    }

    /// Where a ray comes from: the one that [`ray`](Self::ray) would take here.
    ///
    /// The translation is taken off first: far from the origin, where a mapped translation would swamp it, the origin of
    /// the ray keeps its digits (at 2 * 10^5 it is 0.02 against 5 * 10^-7 off).
    #[must_use]
    pub fn ray_back(&self, ray: &Ray) -> Ray {
        let origin = self.point_back(ray.origin);
        Ray { origin, direction: self.inverse * ray.direction, ..*ray }
    }

    /// Whether all of it is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.linear.is_finite() && self.inverse.is_finite() && self.translation.is_finite()
    }

    /// How far, per axis, a point of at most this magnitude may end from where it came from by [`ray_back`](Self::ray_back).
    ///
    /// An error in the last places of the inverse moves a point `q` by `|M| |M⁻¹| |M| |q|` times as much.
    pub(crate) fn error(&self, magnitude: Vec3) -> Vec3 {
        let grown = |m: &Mat3, v: Vec3| m.x_axis.abs() * v.x + m.y_axis.abs() * v.y + m.z_axis.abs() * v.z;
        let placed = grown(&self.linear, magnitude);
        (grown(&self.linear, grown(&self.inverse, placed)) + self.translation.abs()) * (16.0 / 16_777_216.0)
    }

    /// As [`bounds`](Self::bounds), but with room for the roundings here and in [`ray_back`](Self::ray_back).
    pub(crate) fn padded_bounds(&self, aabb: &Aabb) -> Aabb {
        let corner = Aabb::new(aabb.min.abs(), aabb.min.abs()).union(&Aabb::new(aabb.max.abs(), aabb.max.abs())).max;
        let (moved, pad) = (self.bounds(aabb), self.error(corner));
        let outward = |v: Vec3, f: fn(f32) -> f32| Vec3::new(f(v.x), f(v.y), f(v.z));
        Aabb::new(outward(moved.min - pad, f32::next_down), outward(moved.max + pad, f32::next_up))
    }

    /// By how much the error of a point grows on its way through the map.
    pub(crate) fn stretch(&self) -> f32 {
        let sum = self.linear.x_axis.abs() + self.linear.y_axis.abs() + self.linear.z_axis.abs();
        sum.max_element()
    }

    /// Where the origin goes.
    #[must_use]
    pub const fn translation(&self) -> Vec3 {
        self.translation
    }

    /// A box around where a box goes, up to rounding. Arvo, *Transforming axis-aligned bounding boxes*, 1990.
    #[must_use]
    pub fn bounds(&self, aabb: &Aabb) -> Aabb {
        let mut moved = Aabb::new(self.translation, self.translation);
        let sides = [(aabb.min.x, aabb.max.x), (aabb.min.y, aabb.max.y), (aabb.min.z, aabb.max.z)];
        for (column, (min, max)) in [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis].into_iter().zip(sides)
        {
            let (a, b) = (column * min, column * max);
            moved.min += a.min(b);
            moved.max += a.max(b);
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        math::greatest,
        testing::{Random, cases},
    };

    #[test]
    fn singular_and_non_finite_maps_are_refused() {
        assert!(Transform::new(Mat3::ZERO, Vec3::ZERO).is_err());
        assert!(Transform::new(Mat3::IDENTITY, Vec3::NAN).is_err());
        assert!(Transform::new(Mat3::from_diagonal(Vec3::new(1.0, f32::NAN, 1.0)), Vec3::ZERO).is_err());
        assert!(Transform::new(Mat3::from_diagonal(Vec3::new(1.0, 1.0, 0.0)), Vec3::ZERO).is_err());
    }

    #[test]
    fn only_similar_maps_have_a_factor() {
        let factor = |linear| Transform::new(linear, Vec3::ONE).unwrap().factor();
        assert_eq!(factor(Mat3::from_diagonal(Vec3::new(-2.0, 2.0, 2.0))), Some(2.0));
        let turned = factor(Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(0.3) * 1.0e-10).unwrap();
        assert!((turned / 1.0e-10 - 1.0).abs() < 1.0e-6);
        assert_eq!(factor(Mat3::from_diagonal(Vec3::new(1.0, 1.0, 1.001))), None);
        assert_eq!(factor(Mat3::from_cols(Vec3::X, Vec3::Y, Vec3::new(0.001, 0.0, 1.0))), None);
    }

    #[test]
    fn errors_grow_as_far_as_is_said_and_no_farther() {
        let mut random = Random::new(5);
        for _ in 0..cases(2000) {
            let mut number = |scale: f32| (random.unit() - 0.5) * scale;
            let mut column = |scale: f32| Vec3::new(number(2.0), number(2.0), number(2.0)) * scale;
            let linear = Mat3::from_cols(column(1.0), column(0.01), column(30.0));
            let (p, translation) = (column(10.0), column(1000.0));
            let Ok(map) = Transform::new(linear, translation) else { continue };
            // What is farthest along an axis: a corner of the cube.
            let corners = Aabb::new(Vec3::NEG_ONE, Vec3::ONE).corners();
            let farthest = corners.map(|corner| map.vector(corner).abs().max_element()).into_iter().fold(0.0, greatest);
            assert!((map.stretch() / farthest - 1.0).abs() < 1.0e-5, "{map:?}");
            // There and back and, without rounding, there again.
            let there = map.point(p);
            let back = map.point_back(there).as_dvec3();
            let off = (map.linear.as_dmat3() * back + map.translation.as_dvec3() - there.as_dvec3()).abs();
            assert!(off.cmple(map.error(p.abs()).as_dvec3()).all(), "{map:?} {p}");
            let known = (map.linear.abs() * p.abs() + translation.abs()) * (16.0 / 16_777_216.0);
            assert!(map.error(p.abs()).cmpge(known * 0.999).all(), "{map:?} {p}");
        }
    }

    #[test]
    fn mirrored_normals_stay_across_their_surface() {
        let mirror = Transform::new(Mat3::from_diagonal(Vec3::new(-2.0, 1.0, 3.0)), Vec3::ONE).unwrap();
        let (u, v) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 0.5, 0.0));
        let n = mirror.normal(u.cross(v));
        assert!(n.dot(mirror.vector(u)).abs() < 1.0e-5 && n.dot(mirror.vector(v)).abs() < 1.0e-5);
    }

    #[test]
    fn bounds_contain_every_corner() {
        let turn = Transform::new(Mat3::from_rotation_y(0.7), Vec3::new(5.0, 0.0, 1.0)).unwrap();
        let cube = Aabb::new(Vec3::splat(-1.0), Vec3::new(2.0, 1.0, 1.0));
        let moved = turn.bounds(&cube);
        for x in [cube.min.x, cube.max.x] {
            for z in [cube.min.z, cube.max.z] {
                let p = turn.point(Vec3::new(x, 0.0, z));
                assert!((moved.min - 1.0e-5).cmple(p).all() && p.cmple(moved.max + 1.0e-5).all());
            }
        }
    }
}
