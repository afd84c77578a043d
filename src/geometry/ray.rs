use core::hint::select_unpredictable;

use glam::Vec3;

use super::{Axis, MAX_COORDINATE};

/// The relative slack of every exit, 2^-16 (rule R2 of ARCHITECTURE.md): exits are multiplied by `1 + WIDENING`.
///
/// It covers the 2^-17 within which a triangle's `t` is certified and the three roundings of a plane's
/// parameter, with as much again to spare.
pub(crate) const WIDENING: f32 = 1.0 / 65536.0;

/// Absolute slack of every exit, 2^-126: more than what underflow can take from a product.
pub(crate) const TINY: f32 = f32::MIN_POSITIVE;

/// The bits of a number without its sign: they order as magnitudes do, infinity and NaN above all.
///
/// Where there is no FPU, this is a fraction of a comparison of floats.
#[inline(always)]
const fn magnitude(x: f32) -> u32 {
    x.to_bits() & 0x7fff_ffff
}

/// 2^64, by which bounds on errors are lifted, so that they overflow before what they bound does.
pub(crate) const LIFT: f32 = 18_446_744_073_709_551_616.0;

/// A half-line with a closed interval of parameters and a visibility mask.
///
/// A point on it is `origin + t * direction`; the direction need not have unit length.
///
/// A ray is *invalid* and misses everything if a component is not finite, an origin coordinate exceeds
/// [`MAX_COORDINATE`](super::MAX_COORDINATE), the interval is empty, the largest direction component is not within
/// 2^-100 … 2^100 in magnitude, or it sees nothing: its mask is 0.
///
/// ```
/// use hitscan::{Ray, glam::Vec3};
/// let ray = Ray::new(Vec3::ZERO, Vec3::Z).up_to(10.0);
/// assert_eq!(ray.at(2.0), Vec3::new(0.0, 0.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at `t = 0`.
    pub origin: Vec3,
    /// The step for one unit of `t`.
    pub direction: Vec3,
    /// The least `t` that counts, itself included; may be negative.
    pub t_min: f32,
    /// The greatest `t` that counts, itself included; may be infinite.
    pub t_max: f32,
    /// Only primitives whose mask shares a bit with this one are seen.
    pub mask: u32,
}

impl Ray {
    /// The ray from `origin` along `direction`, for `t` from 0 to infinity, seeing everything.
    #[inline]
    #[must_use]
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY, mask: u32::MAX }
    }

    /// The segment from `a` (`t = 0`) to `b` (`t = 1`).
    #[inline]
    #[must_use]
    pub fn between(a: Vec3, b: Vec3) -> Self {
        Self::new(a, b - a).up_to(1.0)
    }

    /// The same ray for `t >= t_min` only.
    #[inline]
    #[must_use]
    pub const fn starting_at(self, t_min: f32) -> Self {
        Self { t_min, ..self }
    }

    /// The same ray for `t <= t_max` only.
    #[inline]
    #[must_use]
    pub const fn up_to(self, t_max: f32) -> Self {
        Self { t_max, ..self }
    }

    /// The same ray, seeing only primitives whose mask shares a bit with `mask`.
    #[inline]
    #[must_use]
    pub const fn seeing(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// The point at parameter `t`.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }

    /// What all tests of this ray share, or `None` if the ray is invalid.
    #[inline]
    #[must_use]
    pub fn prepare(&self) -> Option<PreparedRay> {
        PreparedRay::new(self)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Ray {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (origin, direction) = (self.origin.to_array(), self.direction.to_array());
        defmt::write!(f, "{} + t * {}, t in {}..={}, mask {:#x}", origin, direction, self.t_min, self.t_max, self.mask);
    }
}

/// 2^-100 and 2^100, between which the largest component of a direction lies.
pub(crate) const SHORT: f32 = 7.888_609e-31;
pub(crate) const LONG: f32 = 1.267_650_6e30;

/// Their bits.
const LARGEST: core::ops::RangeInclusive<u32> = magnitude(SHORT)..=magnitude(LONG);

/// A ray as one axis sees it: the parameter of the plane at `p` is `(p - origin) * entry`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisView {
    pub(crate) origin: f32,
    /// Reciprocal direction, for planes where the ray enters.
    pub(crate) entry: f32,
    /// Reciprocal direction times `1 + WIDENING`, for planes where it leaves.
    pub(crate) exit: f32,
}

impl AxisView {
    /// Chooses reciprocals so that no case needs a branch in a traversal (rule R1).
    #[inline(always)]
    fn new(origin: f32, direction: f32, forward: bool) -> Self {
        let (entry, exit) = if magnitude(direction) < magnitude(f32::MIN_POSITIVE) {
            parallel(direction, forward)
        } else {
            let entry = 1.0 / direction;
            (entry, entry * (1.0 + WIDENING))
        };
        Self { origin, entry, exit }
    }

    /// Whether the ray meets lower coordinates first.
    #[inline(always)]
    pub(crate) fn ascends(&self) -> bool {
        !self.entry.is_sign_negative()
    }
}

/// Reciprocals of an axis along which the ray hardly moves, for entries and for exits.
///
/// * `direction = 0`: both infinite. A plane's parameter is then -inf before the origin and +inf behind it, which is
///   closed containment; in the plane itself it is NaN, and comparisons are written so that NaN visits.
/// * `1 / direction` overflows: entries use `f32::MAX`, which is too early and so safe. Exits use infinity:
///   too late when ahead of the origin, and a plane behind the origin stays behind it. That is enough where
///   `t >= 0`; for rays that reach back, both are NaN, and the axis never decides.
#[cold]
#[inline(never)]
fn parallel(direction: f32, forward: bool) -> (f32, f32) {
    let inverse = 1.0 / direction;
    let exit = inverse * (1.0 + WIDENING);
    if direction == 0.0 || exit.is_finite() {
        (inverse, exit)
    } else if forward {
        (inverse.clamp(f32::MIN, f32::MAX), exit)
    } else {
        (f32::NAN, f32::NAN)
    }
}

/// A valid ray with what its tests share: reciprocals, and the shear that turns its major axis into z.
///
/// Made by [`Ray::prepare`], once per query; primitives get it in [`intersect`](crate::Primitives::intersect).
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    ray: Ray,
    /// By axis; the fourth is there so that an index of two bits needs no check.
    pub(crate) views: [AxisView; 4],
    /// A bit per axis along which the ray meets higher coordinates first, repeated every four bits.
    pub(crate) descending: u32,
    pub(crate) shear: Shear,
}

/// What turns the ray into the third axis: see the triangle's filter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear {
    /// The axis along which the direction is largest: the third one, behind the other two in cyclic order.
    pub(crate) major: Axis,
    /// By axis: the direction over that along the major one, at most 1 in magnitude.
    pub(crate) slope: [f32; 3],
    /// One over the direction along the major one.
    pub(crate) inverse: f32,
}

/// The axis of the largest of three magnitudes. On hosts, which cannot guess which it is, without a branch.
#[inline(always)]
fn longest([x, y, z]: [u32; 3]) -> (Axis, u32) {
    if cfg!(feature = "std") {
        let (axis, largest) = select_unpredictable(y > x, (Axis::Y, y), (Axis::X, x));
        return select_unpredictable(z > largest, (Axis::Z, z), (axis, largest));
    }
    match (y > x, z > if y > x { y } else { x }) {
        (_, true) => (Axis::Z, z),
        (true, false) => (Axis::Y, y),
        (false, false) => (Axis::X, x),
    }
}

/// The one of an axis, as little guessed.
#[inline(always)]
fn at(axis: Axis, [x, y, z]: [f32; 3]) -> f32 {
    if cfg!(feature = "std") {
        return select_unpredictable(axis == Axis::Z, z, select_unpredictable(axis == Axis::Y, y, x));
    }
    match axis {
        Axis::X => x,
        Axis::Y => y,
        Axis::Z => z,
    }
}

impl PreparedRay {
    fn new(ray: &Ray) -> Option<Self> {
        Self::here(ray)
    }

    /// As [`Ray::prepare`], in the middle of the code that wants it: what is not asked for is not computed.
    #[inline(always)]
    pub(crate) fn here(ray: &Ray) -> Option<Self> {
        let (o, d) = (ray.origin, ray.direction);
        let (x, y, z) = (magnitude(d.x), magnitude(d.y), magnitude(d.z));
        let (major, largest) = longest([x, y, z]);
        let (x, y, z) = (magnitude(o.x), magnitude(o.y), magnitude(o.z));
        let farthest = x.max(y).max(z);
        // Finite limits spare every primitive the question whether its `t` overflowed; NaN stays what it is.
        let t_min = if ray.t_min < f32::MIN { f32::MIN } else { ray.t_min };
        let t_max = if ray.t_max > f32::MAX { f32::MAX } else { ray.t_max };
        let valid =
            farthest <= magnitude(MAX_COORDINATE) && LARGEST.contains(&largest) && t_min <= t_max && ray.mask != 0;
        if !valid {
            return None;
        }
        let forward = t_min >= 0.0;
        let x = AxisView::new(o.x, d.x, forward);
        let y = AxisView::new(o.y, d.y, forward);
        let z = AxisView::new(o.z, d.z, forward);
        let inverse = at(major, [x.entry, y.entry, z.entry]);
        let shear = Shear { major, slope: [d.x * inverse, d.y * inverse, d.z * inverse], inverse };
        let bit = |view: &AxisView, axis: Axis| view.entry.to_bits() >> 31 << axis as u32;
        let descending = (bit(&x, Axis::X) | bit(&y, Axis::Y) | bit(&z, Axis::Z)) * 0x1111_1111;
        let ray = Ray { origin: o, direction: d, t_min, t_max, mask: ray.mask };
        Some(Self { ray, views: [x, y, z, z], descending, shear })
    }

    /// The ray as it was given, its interval cut to finite numbers.
    #[inline(always)]
    #[must_use]
    pub const fn ray(&self) -> &Ray {
        &self.ray
    }

    /// Looks at another interval of the same line from now on; both limits are finite.
    pub(crate) const fn set_interval(&mut self, t_min: f32, t_max: f32) {
        (self.ray.t_min, self.ray.t_max) = (t_min, t_max);
    }

    /// Whether there is an axis that never decides about a box: a ray that reaches back, whose reciprocal overflows.
    #[inline(always)]
    pub(crate) fn is_undecided(&self) -> bool {
        let [x, y, z, _] = &self.views;
        x.entry.is_nan() | y.entry.is_nan() | z.entry.is_nan()
    }

    /// The parameter at which the ray enters the half-space behind the plane at `p` of `axis`; NaN if undecided.
    #[inline(always)]
    pub(crate) fn entry(&self, axis: Axis, p: f32) -> f32 {
        let view = &self.views[axis as usize];
        (p - view.origin) * view.entry
    }

    /// The widened parameter at which the ray leaves the half-space before the plane at `p` of `axis`; NaN if undecided.
    #[inline(always)]
    pub(crate) fn exit(&self, axis: Axis, p: f32) -> f32 {
        let view = &self.views[axis as usize];
        let t = (p - view.origin) * view.exit;
        // The factor within `view.exit` narrows where t is negative.
        (if t < 0.0 { t * (1.0 - 4.0 * WIDENING) } else { t }) + TINY
    }
}

/// The parameter behind which nothing can matter to a query that accepts hits up to `t`.
#[inline(always)]
pub(crate) fn beyond(t: f32) -> f32 {
    t + t.abs() * (4.0 * WIDENING) + 4.0 * TINY
}

/// Whether a ray meets higher coordinates first along the axis whose number is in the lowest two bits of `word`.
///
/// `mask` is [`PreparedRay::descending`], which repeats so that the other bits of the word do not matter: shorter than to find
/// the axis and look at its direction.
#[inline(always)]
pub(crate) const fn descends(mask: u32, word: u32) -> bool {
    // Arm turns by a register's lowest five bits, x86 tests the bit that they number.
    let mask = if cfg!(target_arch = "arm") { mask.rotate_right(word) } else { mask >> (word & 31) };
    mask & 1 != 0
}

/// What a traversal that starts at `t` adds to its exits: where they are negative, it makes up for the factor in them.
///
/// Twice what [`PreparedRay::exit`] takes off, so that no exit of a cell lies before that of a box in it.
#[inline(always)]
pub(crate) fn slack(t: f32) -> f32 {
    if t < 0.0 { 2.0 * TINY - t * (8.0 * WIDENING) } else { 2.0 * TINY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prepared(direction: [f32; 3], t_min: f32) -> Option<PreparedRay> {
        Ray::new(Vec3::ZERO, Vec3::from_array(direction)).starting_at(t_min).prepare()
    }

    #[test]
    fn invalid_rays_are_refused() {
        let good = Ray::new(Vec3::ZERO, Vec3::Z);
        assert!(good.prepare().is_some());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(Ray::new(Vec3::new(0.0, bad, 0.0), Vec3::Z).prepare().is_none());
            assert!(Ray::new(Vec3::ZERO, Vec3::new(bad, 0.0, 1.0)).prepare().is_none());
        }
        assert!(good.starting_at(f32::NAN).prepare().is_none());
        assert!(good.up_to(f32::NAN).prepare().is_none());
        assert!(good.starting_at(2.0).up_to(1.0).prepare().is_none());
        assert!(good.starting_at(f32::INFINITY).prepare().is_none());
        assert!(good.seeing(0).prepare().is_none());
        assert!(prepared([0.0; 3], 0.0).is_none());
        assert!(prepared([2.0e30, 0.0, 0.0], 0.0).is_none());
        assert!(prepared([7.0e-31, 0.0, 0.0], 0.0).is_none());
        assert!(prepared([1.0e-40, -0.0, 1.0], 0.0).is_some());
    }

    #[test]
    fn exits_are_widened_on_both_sides_of_zero() {
        let ray = prepared([1.0, 0.0, 0.0], -10.0).unwrap();
        for p in [-8.0_f32, -1.0e-3, 0.0, 1.0e-3, 8.0] {
            assert!(ray.exit(Axis::X, p) > ray.entry(Axis::X, p), "{p}");
        }
    }

    #[test]
    fn parallel_axes_decide_by_closed_containment() {
        for zero in [0.0, -0.0] {
            let ray = prepared([1.0, zero, 0.0], 0.0).unwrap();
            assert!(ray.entry(Axis::Y, 0.0).is_nan() && ray.exit(Axis::Y, 0.0).is_nan());
            let (before, behind) = if ray.views[1].ascends() { (-1.0, 1.0) } else { (1.0, -1.0) };
            assert_eq!(ray.entry(Axis::Y, before), f32::NEG_INFINITY);
            assert_eq!(ray.exit(Axis::Y, before), f32::NEG_INFINITY);
            assert_eq!(ray.entry(Axis::Y, behind), f32::INFINITY);
            assert_eq!(ray.exit(Axis::Y, behind), f32::INFINITY);
        }
    }

    #[test]
    fn overflowing_reciprocals_enter_early_and_leave_late() {
        let ray = prepared([1.0, 1.0e-40, 0.0], 0.0).unwrap();
        let p = 1.0e-38; // really crossed at t = 100
        assert!(ray.entry(Axis::Y, p) <= 100.0);
        assert!(ray.exit(Axis::Y, p) >= 100.0);
        let back = prepared([1.0, 1.0e-40, 0.0], -1.0).unwrap();
        assert!(back.entry(Axis::Y, p).is_nan() && back.exit(Axis::Y, p).is_nan());
    }
}
