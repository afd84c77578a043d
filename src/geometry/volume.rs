use glam::Vec3;

use super::{Aabb, Obb, PreparedRay, Sphere, beyond};

/// Part of the distances involved by which spheres and oriented boxes are enlarged for a test, 2^-14.
///
/// Shapes that are not certified are hit wherever the slab test of their bounds says, which is up to 2^-14.3 of the way
/// from the origin outside of these (rule R2: 3 · 2^-16 where parameters are negative). What is left is a hundred
/// roundings.
const SLACK: f32 = f32::from_bits((127 - 14) << 23);

/// Absolute part, 2^-60: above what underflow can take from a square, so that smaller volumes are hardly ever missed.
const LEAST: f32 = f32::from_bits((127 - 60) << 23);

/// 2^-123, of the ray's direction: above what the absolute slack of parameters, 2^-126, amounts to in space.
const STEP: f32 = f32::from_bits((127 - 123) << 23);

/// Something around an object, that rays are tested against first.
///
/// ```
/// use hitscan::{Ray, geometry::{Sphere, Volume}, glam::Vec3};
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let ball = Sphere::welzl(corners.iter().copied()).unwrap();
/// let meets = |origin, direction| ball.may_meet(&Ray::new(origin, direction).prepare().unwrap(), f32::MAX);
/// assert!(meets(Vec3::new(0.2, 0.2, -1.0), Vec3::Z));
/// assert!(!meets(Vec3::new(0.2, 0.2, -1.0), Vec3::NEG_Z));
/// assert!(!meets(Vec3::new(2.0, 0.2, -1.0), Vec3::Z));
/// ```
pub trait Volume {
    /// Whether `ray` may hit something in the volume from its own beginning up to `t_max`.
    ///
    /// `false` is a promise: no certified primitive that lies in the volume is hit there, and no other one whose bounds
    /// do ([`Primitives::is_certified`](crate::Primitives::is_certified)), by what the tests of primitives answer,
    /// roundings included.
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool;

    /// The cubic measure, rounded.
    fn volume(&self) -> f64;
}

/// How far from a volume of this size, at this distance from the ray's origin, a hit may seem to be.
#[inline(always)]
fn pad(ray: &PreparedRay, distance: f32, size: f32) -> f32 {
    let major = ray.shear.major;
    (distance + size) * SLACK + (major.of(ray.ray().direction).abs() * STEP + LEAST)
}

impl Volume for Aabb {
    /// The slab test: by its monotony nothing that lies within is met where the box is not.
    #[inline]
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool {
        match self.interval(ray) {
            Some((enter, exit)) => !(enter > beyond(t_max)) && !(exit < ray.ray().t_min),
            None => false,
        }
    }

    fn volume(&self) -> f64 {
        let edge = |min: f32, max: f32| f64::from(max) - f64::from(min);
        let (a, b) = (self.min, self.max);
        if self.is_empty() { 0.0 } else { edge(a.x, b.x) * edge(a.y, b.y) * edge(a.z, b.z) }
    }
}

impl Volume for Sphere {
    /// In `f32`, without division or root.
    ///
    /// With `D` the direction over its largest component and `a` the way from the origin to the centre, the line's
    /// distance is `|a × D| / |D|`. The centre's parameter is `a·D / |D|²`, the sphere's reach in it at most `r / |D|`.
    ///
    /// *Errors*, in u = 2^-24 of `|a|₁ + r`: 8 in the cross product, 10 from the direction, squares and sums; 187 of
    /// those by which the sphere is enlarged are left for them. Infinite and NaN sides never reject, so that nothing is
    /// rejected where distances exceed 2^63, and hardly anything below 2^-60.
    #[inline]
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool {
        let inverse = ray.shear.inverse;
        let (away, along) = (self.center - ray.ray().origin, ray.ray().direction * inverse);
        let reach = self.radius + pad(ray, away.x.abs() + away.y.abs() + away.z.abs(), self.radius);
        let square = along.dot(along);
        let across = away.cross(along);
        let aside = across.dot(across) > reach * reach * square;

        // All three times the square; its root is at most half of one more.
        let middle = away.dot(along) * inverse;
        let half = reach * (0.5 + 0.5 * square) * inverse.abs();
        let outside = (middle + half < ray.ray().t_min * square) | (middle - half > t_max * square);
        !(aside | outside) | ray.is_undecided()
    }

    fn volume(&self) -> f64 {
        let radius = f64::from(self.radius);
        radius * radius * radius * (4.0 / 3.0 * core::f64::consts::PI)
    }
}

impl Volume for Obb {
    /// The separating axes of a segment and a box, in `f32` and without division: three faces and three cross products.
    /// Gottschalk, Lin and Manocha, *OBBTree: a hierarchical structure for rapid interference detection*, 1996.
    ///
    /// *Errors* of the cross products, in u = 2^-24 of `|a|₁ + |h|₁`: 36 from the rotated origin and direction, 16 from
    /// the reach, 128 are allowed, of a valid box. Faces: a point within the interval lies before or behind the face by
    /// less than 20 on the line as rotated, and so does one of the ends, or is so far off on the other side that its
    /// roundings do not matter. Infinite and NaN sides never reject.
    #[inline]
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool {
        let major = ray.shear.major;
        let (axes, size) = (&self.axes, self.half_size);
        let turn = |v| Vec3::new(axes.x_axis.dot(v), axes.y_axis.dot(v), axes.z_axis.dot(v));
        let away = ray.ray().origin - self.center;
        let pad = pad(ray, away.x.abs() + away.y.abs() + away.z.abs(), size.x + size.y + size.z);
        let reach = size + Vec3::splat(pad);

        // The direction over its largest component, so that no product vanishes.
        let (o, d) = (turn(away), turn(ray.ray().direction * ray.shear.inverse));
        let (across, wide, pad) = (d.cross(o).abs(), d.abs(), pad * 0.125);
        let aside = (across.x > reach.y * wide.z + reach.z * wide.y + pad)
            | (across.y > reach.z * wide.x + reach.x * wide.z + pad)
            | (across.z > reach.x * wide.y + reach.y * wide.x + pad);

        let step = major.of(ray.ray().direction);
        let (first, last) = (o + d * (ray.ray().t_min * step), o + d * (t_max * step));
        let beyond = |first: f32, last: f32, reach: f32| {
            ((first > reach) & (last > reach)) | ((first < -reach) & (last < -reach))
        };
        let outside =
            beyond(first.x, last.x, reach.x) | beyond(first.y, last.y, reach.y) | beyond(first.z, last.z, reach.z);
        !(aside | outside) | ray.is_undecided()
    }

    fn volume(&self) -> f64 {
        let [x, y, z] = self.half_size.to_array().map(f64::from);
        8.0 * x * y * z
    }
}

/// One test after the other: what lies in both volumes.
impl<V: Volume, W: Volume> Volume for (V, W) {
    #[inline]
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool {
        self.0.may_meet(ray, t_max) && self.1.may_meet(ray, t_max)
    }

    /// Of the smaller one.
    fn volume(&self) -> f64 {
        let (first, second) = (self.0.volume(), self.1.volume());
        if first < second { first } else { second }
    }
}
