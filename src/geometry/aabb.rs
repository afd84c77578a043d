use glam::Vec3;

use super::{
    Axis, PreparedRay, in_range,
    ray::{TINY, WIDENING},
};
use crate::math::{self, greatest, least};

/// An axis-aligned box: all points between two corners, both included.
///
/// ```
/// use hitscan::{Ray, geometry::Aabb, glam::Vec3};
/// let cube = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let ray = Ray::new(Vec3::new(0.5, 0.5, -1.0), Vec3::Z).prepare().unwrap();
/// let (enter, exit) = cube.interval(&ray).unwrap();
/// assert!(enter == 1.0 && (2.0..2.001).contains(&exit));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Aabb {
    /// The least coordinates.
    pub min: Vec3,
    /// The greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing and leaves every [`union`](Self::union) as it is.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box between two corners.
    #[inline]
    #[must_use]
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// The least box around `points`; [`EMPTY`](Self::EMPTY) around none.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |a, p| a.union(&Self::new(p, p)))
    }

    /// The least box that contains both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            min: Vec3::new(least(a.min.x, b.min.x), least(a.min.y, b.min.y), least(a.min.z, b.min.z)),
            max: Vec3::new(greatest(a.max.x, b.max.x), greatest(a.max.y, b.max.y), greatest(a.max.z, b.max.z)),
        }
    }

    /// The points that both contain.
    #[inline]
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            min: Vec3::new(greatest(a.min.x, b.min.x), greatest(a.min.y, b.min.y), greatest(a.min.z, b.min.z)),
            max: Vec3::new(least(a.max.x, b.max.x), least(a.max.y, b.max.y), least(a.max.z, b.max.z)),
        }
    }

    /// Whether it contains no point.
    #[inline]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Whether its corners are in order, finite and at most [`MAX_COORDINATE`](super::MAX_COORDINATE).
    #[inline]
    #[must_use]
    pub fn is_valid(&self) -> bool {
        in_range(self.min) && in_range(self.max) && !self.is_empty()
    }

    /// Whether `point` lies inside or on the surface.
    #[inline]
    #[must_use]
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// How far `point` lies outside along each axis; 0 within.
    #[inline(always)]
    #[must_use]
    pub fn gaps(&self, point: Vec3) -> Vec3 {
        // A NaN, which only damaged words hold, counts as within.
        let gap = |min: f32, max: f32, x: f32| greatest(greatest(min - x, x - max), 0.0);
        let (min, max) = (self.min, self.max);
        Vec3::new(gap(min.x, max.x, point.x), gap(min.y, max.y, point.y), gap(min.z, max.z, point.z))
    }

    /// The distance of the box from `point`; 0 within it.
    ///
    /// ```
    /// # use hitscan::{geometry::Aabb, glam::Vec3};
    /// assert_eq!(Aabb::new(Vec3::ZERO, Vec3::ONE).distance(Vec3::new(4.0, 0.5, 5.0)), 5.0);
    /// ```
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f32 {
        // In `f64`, where no square of an `f32` over- or underflows.
        let [x, y, z] = self.gaps(point).to_array().map(f64::from);
        math::sqrt64(x * x + y * y + z * z) as f32
    }

    /// The edge lengths.
    #[inline]
    #[must_use]
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The middle.
    #[inline]
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The eight corners.
    #[inline]
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        let (a, b) = (self.min, self.max);
        [(a.x, a.y), (b.x, a.y), (a.x, b.y), (b.x, b.y)]
            .map(|(x, y)| [Vec3::new(x, y, a.z), Vec3::new(x, y, b.z)])
            .as_flattened()
            .first_chunk()
            .copied()
            .unwrap_or([a; 8])
    }

    /// Half the surface area, as the surface area heuristic weighs boxes; 0 if empty.
    #[inline]
    #[must_use]
    pub fn half_area(&self) -> f32 {
        let s = self.size();
        if self.is_empty() { 0.0 } else { s.x * s.y + s.y * s.z + s.z * s.x }
    }

    /// The two parts before and behind the plane at `position` of `axis`.
    #[inline]
    #[must_use]
    pub fn split(&self, axis: Axis, position: f32) -> (Self, Self) {
        let (mut left, mut right) = (*self, *self);
        match axis {
            Axis::X => (left.max.x, right.min.x) = (position, position),
            Axis::Y => (left.max.y, right.min.y) = (position, position),
            Axis::Z => (left.max.z, right.min.z) = (position, position),
        }
        (left, right)
    }

    /// The slab test: where the ray's line enters the box and where it leaves, the exit widened by 2^-16; `None` if it
    /// certainly misses, or if all of the box is farther away than a parameter can say.
    ///
    /// Conservative: whatever the box contains is met within the interval, roundings included (ARCHITECTURE.md, R1
    /// and R2). The ray's own interval is not consulted. Kay and Kajiya, *Ray tracing complex scenes*, 1986.
    #[inline]
    #[must_use]
    pub fn interval(&self, ray: &PreparedRay) -> Option<(f32, f32)> {
        let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in Axis::ALL {
            let (min, max) = (axis.of(self.min), axis.of(self.max));
            let (near, far) = if ray.views[axis as usize].ascends() { (min, max) } else { (max, min) };
            enter = greatest(ray.entry(axis, near), enter);
            exit = least(ray.exit(axis, far), exit);
        }
        // At infinity the order of faces is lost, and a line that misses would seem to be within all of them.
        let is_missed = enter > exit || enter == f32::INFINITY || exit == f32::NEG_INFINITY;
        if is_missed { None } else { Some((enter, exit)) }
    }

    /// A finite parameter before which the line hits nothing in the box: what is certified may be hit 2^-16 before the
    /// [interval](Self::interval), all else only within it. `None` if it misses the box.
    #[inline]
    pub(crate) fn beginning(&self, ray: &PreparedRay) -> Option<f32> {
        let (enter, _) = self.interval(ray)?;
        Some(greatest(enter - enter.abs() * (4.0 * WIDENING) - 4.0 * TINY, f32::MIN))
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Aabb {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} to {}", self.min.to_array(), self.max.to_array());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ray;

    const CUBE: Aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);

    fn meets(origin: [f32; 3], direction: [f32; 3]) -> bool {
        let ray = Ray::new(origin.into(), direction.into()).prepare().unwrap();
        CUBE.interval(&ray).is_some_and(|(_, exit)| exit >= 0.0)
    }

    #[test]
    fn faces_edges_and_corners_belong_to_the_box() {
        for on in [0.0, 1.0] {
            for zero in [0.0, -0.0, 1.0e-41, -1.0e-41] {
                assert!(meets([on, on, -1.0], [zero, zero, 1.0]), "{on} {zero}");
            }
        }
        assert!(!meets([1.0 + f32::EPSILON, 0.5, -1.0], [0.0, 0.0, 1.0]));
        assert!(!meets([-1.0e-40, 0.5, -1.0], [-0.0, 0.0, 1.0]));
        assert!(meets([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]));
        assert!(!meets([0.5, 0.5, 2.0], [0.0, 0.0, 1.0]));
    }

    #[test]
    fn the_empty_box_is_missed_and_neutral() {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z).prepare().unwrap();
        assert_eq!(Aabb::EMPTY.interval(&ray), None);
        assert_eq!(Aabb::EMPTY.union(&CUBE), CUBE);
        assert_eq!(Aabb::EMPTY.half_area(), 0.0);
        assert!(Aabb::EMPTY.is_empty() && !Aabb::EMPTY.is_valid() && CUBE.is_valid());
    }
}
