use glam::Vec3;

use super::{
    LatticeRay, LatticeRays,
    fixed::{Scaled, cut, high, reciprocal, shifted},
    ray::{Interval, LAST, MIDDLE},
    sight::Line,
};
use crate::geometry::{Aabb, Axis, Lattice, Ray, in_range};

/// The coordinates in which the planes of a lattice of 16 bits are whole numbers: they turn rays into [`LatticeRay`]s.
///
/// ```
/// use hitscan::{Ray, geometry::{Aabb, LatticeSpace}, glam::Vec3};
/// let space = LatticeSpace::over(&Aabb::new(Vec3::ZERO, Vec3::ONE)).unwrap();
/// assert!(space.ray(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)).is_some());
/// assert!(space.ray(&Ray::new(Vec3::new(0.2, 1.2, -1.0), Vec3::Z)).is_none());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LatticeSpace {
    axes: [Scale; 3],
}

/// One axis of a space.
#[derive(Clone, Copy, Debug)]
struct Scale {
    /// Where plane 0 is.
    first: f32,
    /// Where the middle plane is.
    middle: f32,
    /// The distance between planes.
    step: f32,
    /// Planes per unit.
    density: Scaled,
}

/// Planes counted from the middle one, or per unit of t, along each axis; in 2^`unit`, of at most 29 bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    pub(super) along: [i32; 3],
    pub(super) unit: i32,
}

impl LatticeSpace {
    /// The space of the lattice over `frame`; `None` if the box is not valid, or so far from 0 for its size that the
    /// lattice's planes are not all different in `f32`.
    #[must_use]
    pub fn over(frame: &Aabb) -> Option<Self> {
        let lattice = Lattice::over(frame, [LAST as u32; 3]);
        let scale = |axis: Axis| {
            let (first, step) = lattice.along(axis as u32);
            let middle = lattice.position(axis, MIDDLE as u32);
            Scale { first, middle, step, density: Scaled::new(1.0 / step) }
        };
        let is_fine = |axis: Axis| {
            let (first, step) = lattice.along(axis as u32);
            let end = axis.of(frame.max).abs();
            let largest = if first.abs() > end { first.abs() } else { end };
            // Two units in the last place or more: a position is then within a quarter of a step of where it should be.
            axis.of(frame.size()) > 0.0 && step * 4_194_304.0 >= largest && 1.0 / step >= f32::MIN_POSITIVE
        };
        let is_fine = frame.is_valid() && Axis::ALL.into_iter().all(is_fine);
        is_fine.then(|| Self { axes: Axis::ALL.map(scale) })
    }

    /// The ray in whole numbers; `None` if it misses the lattice or is not valid.
    ///
    /// Made in integers, too, but for three differences and, where the interval has them, ends other than 0 and infinity.
    #[must_use]
    pub fn ray(&self, ray: &Ray) -> Option<LatticeRay> {
        if !(in_range(ray.origin) && in_range(ray.direction) && ray.t_min <= ray.t_max) {
            return None;
        }
        let (start, speed) = (self.start(ray.origin), self.speed(ray.direction));
        let line = line(&start, speed.along)?;
        let scale = &self.axes[line.major as usize];
        let (origin, direction) = (line.major.of(ray.origin), line.major.of(ray.direction));
        let depth = |t: f32| {
            // Twice the magnitude's bits: 0 of either sign, most rays' beginning, needs no arithmetic.
            if t.to_bits() << 1 == 0 {
                return line.depth_of(&start);
            }
            let end = origin + t * direction - scale.middle;
            let end = if end.abs() < f32::MAX { end } else { f32::MAX.copysign(end) };
            line.depth(Scaled::new(end).times(scale.density).in_units(-8))
        };
        let depths = (
            if ray.t_min.to_bits() == f32::NEG_INFINITY.to_bits() { 0 } else { depth(ray.t_min) },
            if ray.t_max.to_bits() == f32::INFINITY.to_bits() { LAST << 8 } else { depth(ray.t_max) },
        );
        let interval = Interval { depths, limits: (ray.t_min, ray.t_max) };
        LatticeRay::new(&line, &interval, (scale.first, scale.step), (origin, direction), ray.mask)
    }

    /// The rays from `origin` along `first`, `first + step`, `first + 2 step` and so on: those of a row of pixels.
    ///
    /// From one to the next there are three sums: a seventh to a third less to do than for a single [`ray`](Self::ray). They see
    /// everything, and t counts from 0 in lengths of their own directions.
    ///
    /// ```
    /// use hitscan::{Ray, geometry::{Aabb, LatticeSpace}, glam::Vec3};
    /// let space = LatticeSpace::over(&Aabb::new(Vec3::ZERO, Vec3::ONE)).unwrap();
    /// let row = space.rays(Vec3::new(0.5, 0.5, -2.0), Vec3::new(-1.0, 0.1, 2.0), Vec3::X * 0.12, 16);
    /// assert_eq!(row.map(|ray| ray.is_some()).filter(|&meets| meets).count(), 8);
    /// ```
    #[must_use]
    pub fn rays(&self, origin: Vec3, first: Vec3, step: Vec3, count: u32) -> LatticeRays<'_> {
        let last = first + step * count as f32;
        let is_valid = in_range(origin) && in_range(first) && in_range(step) && in_range(last);
        let (first, step, last) = (self.speed(first), self.speed(step), self.speed(last));
        // In a unit in which neither end overflows.
        let unit = first.unit.max(last.unit).max(step.unit);
        LatticeRays {
            space: self,
            count: if is_valid { count } else { 0 },
            origin,
            start: self.start(origin),
            speed: Planes { along: first.along.map(|speed| cut(speed, unit - first.unit)), unit },
            step: step.along.map(|speed| cut(speed, unit - step.unit)),
        }
    }

    /// A point where rays begin; `None` if it is not valid.
    pub(super) fn from(&self, point: Vec3) -> Option<Planes> {
        in_range(point).then(|| self.start(point))
    }

    /// The line of a ray from there; `None` if it is not valid.
    #[inline(never)]
    pub(super) fn line(&self, start: &Planes, direction: Vec3) -> Option<Line> {
        if in_range(direction) { line(start, self.speed(direction).along) } else { None }
    }

    /// A vector's lengths of single steps.
    pub(super) fn in_steps(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = &self.axes;
        v * Vec3::new(x.step, y.step, z.step)
    }

    /// The coordinate of an axis's plane 0, and the distance of its planes.
    pub(super) fn planes_of(&self, axis: Axis) -> (f32, f32) {
        self.axes.get(axis as usize).map_or((0.0, 0.0), |scale| (scale.first, scale.step))
    }

    /// From the middle of the lattice to a point.
    fn start(&self, point: Vec3) -> Planes {
        self.planes(|axis, scale| Scaled::new(axis.of(point) - scale.middle))
    }

    /// As many planes per unit of t.
    fn speed(&self, direction: Vec3) -> Planes {
        self.planes(|axis, _| Scaled::new(axis.of(direction)))
    }

    /// Lengths in planes, in the unit that the longest needs.
    #[inline(always)]
    fn planes(&self, length: impl Fn(Axis, &Scale) -> Scaled) -> Planes {
        let along = |axis: Axis| {
            let scale = &self.axes[axis as usize];
            length(axis, scale).roughly_times(scale.density)
        };
        let [x, y, z] = [along(Axis::X), along(Axis::Y), along(Axis::Z)];
        // With a bit of headroom for what is added or taken off.
        let unit = x.exponent.max(y.exponent).max(z.exponent) + 1;
        Planes { along: [x, y, z].map(|length| cut(length.mantissa, unit - length.exponent)), unit }
    }

    /// The ray along a line from `origin`, for t from 0, seeing everything.
    #[inline(always)]
    pub(super) fn first_hits(&self, origin: Vec3, start: &Planes, speed: &Planes) -> Option<LatticeRay> {
        let line = line(start, speed.along)?;
        let scale = &self.axes[line.major as usize];
        let interval = Interval { depths: (line.depth_of(start), LAST << 8), limits: (0.0, f32::INFINITY) };
        // Planes to lengths, by a power of two that a float of 32 bits holds in two parts.
        let half = |exponent: i32| f32::from_bits((exponent.clamp(-126, 127) + 127) as u32 * (1 << 23));
        let (one, other) = (speed.unit / 2, speed.unit - speed.unit / 2);
        let direction = speed.along[line.major as usize] as f32 * half(one) * scale.step * half(other);
        let line_along = (line.major.of(origin), direction);
        LatticeRay::new(&line, &interval, (scale.first, scale.step), line_along, u32::MAX)
    }
}

/// The two axes behind each, in cyclic order; looked up, so that there is one way for all and not three.
const MINOR: [[Axis; 2]; 3] = [[Axis::Y, Axis::Z], [Axis::Z, Axis::X], [Axis::X, Axis::Y]];

/// The line from `start` along `speed`, whatever that is counted in.
#[inline(always)]
fn line(start: &Planes, speed: [i32; 3]) -> Option<Line> {
    let major = fastest(speed)?;
    let fast = speed[major as usize];
    let descends = fast < 0;
    // Of 31 bits.
    let shift = fast.unsigned_abs().leading_zeros().saturating_sub(1);
    let inverse = reciprocal(((fast.unsigned_abs() << shift) & i32::MAX as u32) as i32);
    // Not so small that the point is beyond the number.
    let unit = start.unit.max(-30);
    let at = |axis: Axis| cut(start.along[axis as usize], unit - start.unit);
    let way = at(major);
    let cross = |axis: Axis| {
        // In 2^-30, 1 at most.
        let slope = (high(speed[axis as usize] << shift, inverse) << 1).clamp(-(1 << 30), 1 << 30);
        let slope = if descends { -slope } else { slope };
        // Where the line is in the middle plane: as far from the origin as the slope makes of the way there.
        let middle = at(axis) - (high(slope, way) << 2);
        let middle = shifted(middle, unit + LatticeRay::FRACTION);
        (middle.saturating_add(MIDDLE << LatticeRay::FRACTION), (slope + (1 << 15)) >> 16)
    };
    let [first, second] = MINOR[major as usize];
    let crossings = [cross(first), cross(second)];
    Some(Line { major, descends, crossings })
}

impl Planes {
    /// The number of 2^-`bits` planes along an axis.
    pub(super) fn whole(&self, axis: Axis, bits: u32) -> i32 {
        let along = self.along.get(axis as usize).copied().unwrap_or(0);
        shifted(along, self.unit.saturating_add(bits as i32))
    }
}

impl Line {
    /// The depth, in 2^-8, of a number of 2^-8 planes from the middle one; one beyond the lattice at most.
    fn depth(&self, from_middle: i32) -> i32 {
        let plane = from_middle.saturating_add(MIDDLE << 8).clamp(-1, (LAST + 1) << 8);
        if self.descends { (LAST << 8) - plane } else { plane }
    }

    /// The depth of a point.
    pub(super) fn depth_of(&self, point: &Planes) -> i32 {
        self.depth(shifted(point.along[self.major as usize], point.unit + 8))
    }
}

/// The first axis along which the speed is greatest; none if it is 0 along all.
fn fastest(speed: [i32; 3]) -> Option<Axis> {
    let [x, y, z] = speed.map(i32::unsigned_abs);
    let (axis, speed) = if y > x { (Axis::Y, y) } else { (Axis::X, x) };
    let (axis, speed) = if z > speed { (Axis::Z, z) } else { (axis, speed) };
    (speed != 0).then_some(axis)
}
