use glam::Vec3;

use super::{Aabb, PreparedRay, moved};
use crate::math;

/// A sphere.
///
/// Around points it is made by [`welzl`](Self::welzl), the least; [`ritter`](Self::ritter), in two passes;
/// [`around_barycenter`](Self::around_barycenter) and [`around_box_center`](Self::around_box_center).
///
/// ```
/// use hitscan::{Ray, geometry::Sphere, glam::Vec3};
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, 5.0), 1.0);
/// let ray = Ray::new(Vec3::ZERO, Vec3::Z).prepare().unwrap();
/// assert_eq!(sphere.intersect(&ray), Some([4.0, 6.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Sphere {
    /// The middle.
    pub center: Vec3,
    /// The distance of its surface from the middle: above 0 for one to be hit, 0 around a single point.
    pub radius: f32,
}

impl Sphere {
    /// The sphere of this centre and radius.
    #[inline]
    #[must_use]
    pub const fn new(center: Vec3, radius: f32) -> Self {
        Self { center, radius }
    }

    /// The least box around it, rounded outward.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let reach = Vec3::splat(self.radius);
        let (min, max) = (self.center - reach, self.center + reach);
        let outward = |v: Vec3, f: fn(f32) -> f32| Vec3::from_array(v.to_array().map(f));
        Aabb::new(outward(min, f32::next_down), outward(max, f32::next_up))
    }

    /// Where the ray's line enters and leaves the sphere, if it meets it.
    ///
    /// Haines, Günther and Akenine-Möller, *Precision improvements for ray/sphere intersection*, Ray Tracing Gems, 2019,
    /// in `f64`: a large sphere nearby loses half of the digits. That is a dozen soft operations where there are no
    /// doubles in hardware.
    #[must_use]
    pub fn intersect(&self, ray: &PreparedRay) -> Option<[f32; 2]> {
        let d = ray.ray().direction.to_array().map(f64::from);
        let (o, c) = (ray.ray().origin, self.center);
        let f = [(o.x, c.x), (o.y, c.y), (o.z, c.z)].map(|(o, c)| f64::from(o) - f64::from(c));
        let dot = |p: &[f64; 3], q: &[f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let radius = f64::from(self.radius);

        // The part of f across the direction decides; it loses nothing to a far origin.
        let (a, b) = (dot(&d, &d), -dot(&f, &d));
        let s = b / a;
        let across = [f[0] + s * d[0], f[1] + s * d[1], f[2] + s * d[2]];
        let discriminant = radius * radius - dot(&across, &across);
        if !(discriminant >= 0.0) {
            return None;
        }
        // Of the two roots the larger is computed, the smaller follows without cancellation.
        let root = math::sqrt64(a * discriminant);
        let q = if b < 0.0 { b - root } else { b + root };
        let (p, r) = ((dot(&f, &f) - radius * radius) / q, q / a);
        let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (p as f32, r as f32) };
        Some(if t1 < t0 { [t1, t0] } else { [t0, t1] })
    }

    /// From `point` to the middle, and how far that is.
    fn to_center(self, point: Vec3) -> ([f64; 3], f64) {
        let (p, c) = (point, self.center);
        let [x, y, z] = [(p.x, c.x), (p.y, c.y), (p.z, c.z)].map(|(p, c)| f64::from(c) - f64::from(p));
        ([x, y, z], math::sqrt64(x * x + y * y + z * z))
    }

    /// The point of the surface closest to `point`; from the middle, along the first axis.
    #[must_use]
    pub fn closest_point(&self, point: Vec3) -> Vec3 {
        let ([x, y, z], far) = self.to_center(point);
        let radius = f64::from(self.radius);
        if far > 0.0 {
            let part = 1.0 - radius / far;
            moved(point, [x * part, y * part, z * part])
        } else {
            moved(point, [radius, 0.0, 0.0])
        }
    }

    /// The distance of the surface from `point`, outside or inside.
    ///
    /// ```
    /// # use hitscan::{geometry::Sphere, glam::Vec3};
    /// let sphere = Sphere::new(Vec3::ZERO, 2.0);
    /// assert_eq!((sphere.distance(Vec3::X * 5.0), sphere.distance(Vec3::Y)), (3.0, 1.0));
    /// ```
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f32 {
        let difference = self.to_center(point).1 - f64::from(self.radius);
        (if difference < 0.0 { -difference } else { difference }) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ray;

    fn intersect(center: [f32; 3], radius: f32, origin: [f32; 3], direction: [f32; 3]) -> Option<[f32; 2]> {
        let ray = Ray::new(origin.into(), direction.into()).prepare().unwrap();
        Sphere::new(center.into(), radius).intersect(&ray)
    }

    #[test]
    fn roots_are_ordered_and_scale_with_the_direction() {
        assert_eq!(intersect([0.0; 3], 1.0, [0.0, 0.0, 3.0], [0.0, 0.0, -4.0]), Some([0.5, 1.0]));
        assert_eq!(intersect([0.0; 3], 1.0, [0.0; 3], [0.0, 0.5, 0.0]), Some([-2.0, 2.0]));
        assert_eq!(intersect([0.0; 3], 1.0, [0.0, 1.0 + f32::EPSILON, -3.0], [0.0, 0.0, 1.0]), None);
    }

    #[test]
    fn closest_points_lie_between_point_and_middle() {
        let sphere = Sphere::new(Vec3::new(1.0, -2.0, 0.5), 3.0);
        for (far, sign) in [(9.0, 1.0), (1.5, -1.0)] {
            let towards = Vec3::new(2.0, 1.0, -2.0) * (sign / 3.0);
            let closest = sphere.closest_point(sphere.center + towards * far);
            assert!((closest - (sphere.center + towards * 3.0)).length() < 1.0e-6, "{closest}");
        }
        assert_eq!(sphere.closest_point(sphere.center), sphere.center + Vec3::X * 3.0);
    }

    #[test]
    fn a_huge_sphere_nearby_keeps_its_digits() {
        let [t, _] = intersect([0.0, -1.0e5, 0.0], 99_999.0, [1000.0, 5.0, 0.0], [0.0, -1.0, 0.0]).unwrap();
        assert!((t / 11.000_175 - 1.0).abs() < 1.0e-5, "{t}");
    }
}
