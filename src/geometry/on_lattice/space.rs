use glam::Vec3;

use super::{
    LatticeRay,
    fixed::{Scaled, high, reciprocal, shifted},
    ray::{LAST, Line},
};
use crate::geometry::{Aabb, Axis, Lattice, MAX_COORDINATE, Ray};

/// The coordinates in which the planes of a lattice of 16 bits are whole numbers.
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

impl Scale {
    /// The plane at a position relative to the middle one, in 2^-8, within the lattice and one beyond.
    fn plane(&self, from_middle: Scaled) -> i32 {
        (from_middle.times(self.density).in_units(-8).saturating_add(MIDDLE << 8)).clamp(-1, (LAST + 1) << 8)
    }
}

/// The number of the middle plane.
const MIDDLE: i32 = 0x8000;

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
        if !(is_in_range(ray.origin) && is_in_range(ray.direction) && ray.t_min <= ray.t_max) {
            return None;
        }
        let speed = |axis: Axis| Scaled::new(axis.of(ray.direction)).times(self.axes[axis as usize].density);
        let speeds = [speed(Axis::X), speed(Axis::Y), speed(Axis::Z)];
        let major = fastest(&speeds)?;
        let descends = speeds[major as usize].mantissa < 0;
        // From the middle of the lattice to the origin, all in the unit that the farthest needs.
        let from_middle = |axis: Axis| {
            let scale = &self.axes[axis as usize];
            Scaled::new(axis.of(ray.origin) - scale.middle).roughly_times(scale.density)
        };
        let origin = [from_middle(Axis::X), from_middle(Axis::Y), from_middle(Axis::Z)];
        let [x, y, z] = &origin;
        let unit = x.exponent.max(y.exponent).max(z.exponent).max(-30);
        let start = origin[major as usize].in_units(unit);
        let inverse = reciprocal(speeds[major as usize].mantissa.saturating_abs());
        let cross = |axis: Axis| {
            let speed = speeds[axis as usize];
            // In 2^-30, 1 at most.
            let slope = high(speed.mantissa, inverse) << 1;
            let slope = shifted(slope, speed.exponent - speeds[major as usize].exponent).clamp(-(1 << 30), 1 << 30);
            let slope = if descends { -slope } else { slope };
            // Where the line is in the middle plane: as far from the origin as the slope makes of the way there.
            let middle = origin[axis as usize].in_units(unit) - (high(slope, start) << 2);
            let middle = shifted(middle, unit + LatticeRay::FRACTION);
            (middle.saturating_add(MIDDLE << LatticeRay::FRACTION), (slope + (1 << 15)) >> 16)
        };
        let line = Line { major, descends, crossings: [cross(major.next()), cross(major.next().next())] };
        let scale = self.axes[major as usize];
        let (from, to) = (major.of(ray.origin), major.of(ray.direction));
        let depth = |t: f32| {
            let plane = if t.to_bits() << 1 == 0 {
                shifted(start, unit + 8).saturating_add(MIDDLE << 8).clamp(-1, (LAST + 1) << 8)
            } else {
                let end = from + t * to - scale.middle;
                scale.plane(Scaled::new(if end.abs() < f32::MAX { end } else { f32::MAX.copysign(end) }))
            };
            if descends { (LAST << 8) - plane } else { plane }
        };
        let start = if ray.t_min.to_bits() == f32::NEG_INFINITY.to_bits() { 0 } else { depth(ray.t_min) };
        let end = if ray.t_max.to_bits() == f32::INFINITY.to_bits() { LAST << 8 } else { depth(ray.t_max) };
        LatticeRay::new(&line, (start, end), (scale.first, scale.step), ray)
    }
}

/// Whether all components are finite and at most [`MAX_COORDINATE`]: magnitudes are ordered as their bits are.
fn is_in_range(v: Vec3) -> bool {
    let fits = |x: f32| x.to_bits() & 0x7fff_ffff <= MAX_COORDINATE.to_bits();
    fits(v.x) & fits(v.y) & fits(v.z)
}

/// The first axis along which the speed is greatest; none if it is 0 along all.
fn fastest(speeds: &[Scaled; 3]) -> Option<Axis> {
    let [x, y, z] = speeds;
    let exceeds = |a: &Scaled, b: &Scaled| {
        a.exponent > b.exponent || (a.exponent == b.exponent && a.mantissa.unsigned_abs() > b.mantissa.unsigned_abs())
    };
    let (first, speed) = if exceeds(y, x) { (Axis::Y, y) } else { (Axis::X, x) };
    let (axis, speed) = if exceeds(z, speed) { (Axis::Z, z) } else { (first, speed) };
    (speed.mantissa != 0).then_some(axis)
}
