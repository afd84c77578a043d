use super::{
    LatticeRay,
    fixed::{fixed, magnitude},
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeSpace {
    origin: [f32; 3],
    /// Planes per unit.
    density: [f32; 3],
}

/// 2^-100 … 2^100, as bits: within them nothing overflows.
const SPEEDS: core::ops::RangeInclusive<u32> = (127 - 100) << 23..=(127 + 100) << 23;

impl LatticeSpace {
    /// The space of the lattice over `frame`; `None` if the box is not valid, or so far from 0 for its size that the
    /// lattice's planes are not all different in `f32`.
    #[must_use]
    pub fn over(frame: &Aabb) -> Option<Self> {
        let lattice = Lattice::over(frame, [LAST as u32; 3]);
        let is_fine = |axis: Axis| {
            let (least, step) = lattice.along(axis as u32);
            let end = axis.of(frame.max).abs();
            let largest = if least.abs() > end { least.abs() } else { end };
            // Two units in the last place or more: a position is then within a quarter of a step of where it should be.
            axis.of(frame.size()) > 0.0 && step * 4_194_304.0 >= largest
        };
        if !(frame.is_valid() && Axis::ALL.into_iter().all(is_fine)) {
            return None;
        }
        let origin = Axis::ALL.map(|axis| lattice.along(axis as u32).0);
        let density = Axis::ALL.map(|axis| 1.0 / lattice.along(axis as u32).1);
        Some(Self { origin, density })
    }

    /// The ray in whole numbers; `None` if it misses the lattice or is not valid.
    ///
    /// About twenty float operations, which without an FPU take half of a query.
    #[must_use]
    pub fn ray(&self, ray: &Ray) -> Option<LatticeRay> {
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        let is_valid = |x: f32| magnitude(x) <= MAX_COORDINATE.to_bits();
        let [ox, oy, oz] = o;
        if !(is_valid(ox) && is_valid(oy) && is_valid(oz)) || !(ray.t_min <= ray.t_max) {
            return None;
        }
        let ([x0, y0, z0], [dx, dy, dz], [kx, ky, kz]) = (self.origin, d, self.density);
        let origin = [(ox - x0) * kx, (oy - y0) * ky, (oz - z0) * kz];
        let direction = [dx * kx, dy * ky, dz * kz];
        let major = largest(direction);
        let speed = direction[major as usize];
        if !SPEEDS.contains(&magnitude(speed)) {
            return None;
        }
        let start = origin[major as usize];
        let inverse = 1.0 / speed;
        // Where the line crosses the middle plane, and how fast.
        let from_start = MIDDLE - start;
        let cross = |axis: Axis| {
            let slope = direction[axis as usize] * inverse;
            // Rounded to the nearest.
            let steps = (fixed(slope, LatticeRay::FRACTION + 1) + 1) >> 1;
            (fixed(origin[axis as usize] + slope * from_start, LatticeRay::FRACTION), steps)
        };
        let line = Line { major, descends: speed < 0.0, crossings: [cross(major.next()), cross(major.next().next())] };
        // The depth of a parameter.
        let depth = |t: f32| {
            let plane = if t == 0.0 { start } else { start + t * speed };
            let plane = fixed(plane, 8).clamp(-1, (LAST + 1) << 8);
            if line.descends { (LAST << 8) - plane } else { plane }
        };
        let from = if ray.t_min == f32::NEG_INFINITY { 0 } else { depth(ray.t_min) };
        let until = if ray.t_max == f32::INFINITY { LAST << 8 } else { depth(ray.t_max) };
        LatticeRay::new(&line, (from, until), (start, inverse), ray)
    }
}

/// The middle plane, at which rays are anchored.
const MIDDLE: f32 = 32_768.0;

/// The first axis along which the magnitude is greatest.
fn largest([x, y, z]: [f32; 3]) -> Axis {
    let (x, y, z) = (magnitude(x), magnitude(y), magnitude(z));
    if y > x {
        if z > y { Axis::Z } else { Axis::Y }
    } else if z > x {
        Axis::Z
    } else {
        Axis::X
    }
}
