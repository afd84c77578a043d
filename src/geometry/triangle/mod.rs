//! The certified triangle test (rule R3 of ARCHITECTURE.md).
//!
//! The inputs are read as real numbers, so whether a ray hits is a mathematical fact. Three tiers find it out, each
//! answering only what it can prove: [`filter`] in `f32`, one of the two shortcuts with more bits, and [`exact`].

mod clip;
mod closest;
mod double;
mod exact;
mod filter;
#[cfg(feature = "std")]
mod lanes;
mod shortcut;
#[cfg(feature = "std")]
mod shortcut_lanes;

use glam::Vec3;

use self::filter::Verdict;
pub(crate) use self::filter::{Corner, Either};
#[cfg(feature = "std")]
pub(crate) use self::{
    lanes::{Possible, ShearLanes, Wedge},
    shortcut_lanes::{parameters, range},
};
use super::{Aabb, Axis, PreparedRay, moved, ray::beyond};
use crate::math::{self, greatest, least};

/// A triangle given by its corners; counter-clockwise seen from its front.
///
/// ```
/// use hitscan::{Ray, geometry::Triangle, glam::Vec3};
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let ray = Ray::new(Vec3::new(0.25, 0.25, 2.0), Vec3::NEG_Z).prepare().unwrap();
/// let crossing = triangle.intersect(&ray, 0.0, 10.0).unwrap();
/// assert!(crossing.t == 2.0 && crossing.front);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The first corner.
    pub a: Vec3,
    /// The second corner.
    pub b: Vec3,
    /// The third corner.
    pub c: Vec3,
}

/// Where and from which side a ray crosses a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Crossing {
    /// The ray's parameter: within 2^-17 of the real one, a pure function of ray and triangle.
    pub t: f32,
    /// Whether the ray comes from the front.
    pub front: bool,
}

/// The sides on which a real number may lie of zero.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Negative,
    Zero,
    Positive,
}

/// The common sign of the three edge functions if they make a hit: none opposite, not all zero.
#[inline]
fn agreement(signs: [Sign; 3]) -> Option<Sign> {
    let (negative, positive) = (signs.contains(&Sign::Negative), signs.contains(&Sign::Positive));
    match (negative, positive) {
        (true, false) => Some(Sign::Negative),
        (false, true) => Some(Sign::Positive),
        _ => None,
    }
}

/// [`Triangle::intersect`] for corners where they lie; the limits are asked for by a ray that does not clearly miss.
#[inline(always)]
pub(crate) fn intersect<C: Corner>(
    [a, b, c]: [C; 3],
    ray: &PreparedRay,
    limits: impl Fn() -> (f32, f32),
) -> Option<Crossing> {
    match filter::test([a, b, c], ray) {
        Verdict::Miss => None,
        Verdict::Hit(certain) => match certain.place(ray, limits()) {
            Some(crossing) if crossing.t.is_nan() => certify(a, b, c, ray, limits(), Some(crossing.front)),
            proven => proven,
        },
        Verdict::Unproven => certify(a, b, c, ray, limits(), None),
    }
}

/// [`intersect`] of the triangles `a b c` and `a c d`, where the ray misses one of them; `certify` is the slow tiers for the other.
#[inline(always)]
pub(crate) fn intersect_quad<C: Corner>(
    corners: [C; 4],
    ray: &PreparedRay,
    limits: impl Fn() -> (f32, f32),
    certify: impl Fn(u32, Option<bool>) -> Option<Crossing>,
) -> Either<Crossing> {
    let (number, verdict) = match filter::test_quad(corners, ray) {
        Either::Neither => return Either::Neither,
        Either::Both => return Either::Both,
        Either::One(number, verdict) => (number, verdict),
    };
    let crossing = match verdict {
        Verdict::Miss => None,
        Verdict::Hit(certain) => match certain.place(ray, limits()) {
            Some(crossing) if crossing.t.is_nan() => certify(number, Some(crossing.front)),
            proven => proven,
        },
        Verdict::Unproven => certify(number, None),
    };
    crossing.map_or(Either::Neither, |crossing| Either::One(number, crossing))
}

/// The slow tiers; `front` is known if the filter has proven the hit.
///
/// Corners one by one, because an array would be filled for those that are missed, too.
#[cold]
#[inline(never)]
fn certify<C: Corner>(
    a: C,
    b: C,
    c: C,
    ray: &PreparedRay,
    limits: (f32, f32),
    front: Option<bool>,
) -> Option<Crossing> {
    let [a, b, c] = [a, b, c].map(|v| Vec3::new(v.along(Axis::X), v.along(Axis::Y), v.along(Axis::Z)));
    Triangle { a, b, c }.certify(ray, limits, front)
}

/// Whether a crossing cannot lie within the limits: it lies between the corners' parameters along the major axis.
#[inline(never)]
fn is_outside(triangle: &Triangle, ray: &PreparedRay, (t_min, t_max): (f32, f32)) -> bool {
    let major = ray.shear.major;
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| ray.entry(major, major.of(v)));
    least(least(a, b), c) > beyond(t_max) || beyond(greatest(greatest(a, b), c)) < t_min
}

impl Triangle {
    /// The triangle with these corners.
    #[inline(always)]
    #[must_use]
    pub const fn new(a: Vec3, b: Vec3, c: Vec3) -> Self {
        Self { a, b, c }
    }

    /// Where the line of `ray` crosses the triangle, borders included; `None` if it misses, lies in the triangle's plane,
    /// or the parameter exceeds `f32`.
    ///
    /// A crossing outside `t_min..=t_max` may be reported or not: the limits only save work. Watertight: rays do not
    /// pass between triangles that share an edge or a corner. The first tier is the shear of Woop, Benthin and Wald,
    /// *Watertight ray/triangle intersection*, JCGT 2013, with a forward error bound.
    #[inline(always)]
    #[must_use]
    pub fn intersect(&self, ray: &PreparedRay, t_min: f32, t_max: f32) -> Option<Crossing> {
        intersect([self.a.as_ref(), self.b.as_ref(), self.c.as_ref()], ray, || (t_min, t_max))
    }

    /// The slow tiers for all kinds of corners.
    #[inline(never)]
    pub(crate) fn certify(&self, ray: &PreparedRay, limits: (f32, f32), front: Option<bool>) -> Option<Crossing> {
        if is_outside(self, ray, limits) { None } else { self.decide(ray, front) }
    }

    /// The last tiers; `front` is known if the filter has proven the hit.
    #[inline(always)]
    pub(crate) fn decide(&self, ray: &PreparedRay, front: Option<bool>) -> Option<Crossing> {
        // Doubles are in hardware on hosts; on chips pairs of floats are several times faster than soft doubles.
        if cfg!(any(target_pointer_width = "64", target_arch = "x86", target_arch = "wasm32")) {
            shortcut::test(self, ray, front)
        } else {
            double::test(self, ray, front)
        }
    }

    /// The normal `(b - a) x (c - a)`, of twice the triangle's area in length, on the front side.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        (self.b - self.a).cross(self.c - self.a)
    }

    /// The weights of `b` and `c` where the line of `ray` crosses the plane, clamped to the triangle.
    ///
    /// An `f32` estimate for shading and texture coordinates; deterministic like everything else.
    #[must_use]
    pub fn weights(&self, ray: &PreparedRay) -> (f32, f32) {
        let corners = [self.a.as_ref(), self.b.as_ref(), self.c.as_ref()];
        let sheared = filter::shear(corners, ray, |_, _| false);
        let [u, v, w] = sheared.map_or([0.0; 3], |sheared| filter::edges(&sheared).map(f32::abs));
        let sum = u + v + w;
        if sum > 0.0 && sum.is_finite() { (v / sum, w / sum) } else { (1.0 / 3.0, 1.0 / 3.0) }
    }

    /// The least box around the triangle.
    #[inline]
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        // Three comparisons an axis, not four.
        let along = |a: f32, b: f32, c: f32| {
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            (least(low, c), greatest(high, c))
        };
        let (a, b, c) = (self.a, self.b, self.c);
        let [x, y, z] = [along(a.x, b.x, c.x), along(a.y, b.y, c.y), along(a.z, b.z, c.z)];
        Aabb::new(Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1))
    }

    /// A box around the part of the triangle inside `cell`, rounded outward; `None` if there certainly is none.
    #[must_use]
    pub fn clip(&self, cell: &Aabb) -> Option<Aabb> {
        clip::bounds(self, cell)
    }

    /// The point of the triangle closest to `point`, borders included: of a triangle without area, of its edges.
    #[must_use]
    pub fn closest_point(&self, point: Vec3) -> Vec3 {
        moved(point, closest::offset(self, point).0)
    }

    /// The distance of the triangle from `point`: a pure function of both.
    ///
    /// Besides one rounding it may be less than the real one by 2^-50 of the largest difference of coordinates, and more by
    /// 2^-32 of it; for slivers, a thousand times as long as wide, by less than their width.
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f32 {
        math::sqrt64(closest::offset(self, point).1) as f32
    }
}

#[cfg(test)]
mod tests;
