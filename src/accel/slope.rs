use glam::Vec3;

use super::segment::{Segment, slack_within};
use crate::{
    geometry::{Aabb, Axis, AxisView, Lattice, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// How the parameters of an axis' planes grow with their numbers, for planes where a ray enters and for those where it
/// leaves.
///
/// A conversion, a product and a sum in the place of twice as many steps. These are not the bits that the plane's position
/// gives, but an entry is never later than by position and an exit never earlier: wherever the part of a ray that counts
/// is on one side of a plane by the one, it is by the other (ARCHITECTURE.md, the proof, 3).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope {
    entry: Line,
    exit: Line,
}

/// `slope * number + start`.
#[derive(Clone, Copy, Debug)]
struct Line {
    slope: f32,
    start: f32,
}

impl Line {
    #[inline(always)]
    fn at(self, number: f32) -> f32 {
        self.slope * number + self.start
    }
}

/// By which slopes are late and early, in parts of what [`reach`] says: see [`Slopes`].
const ERROR: f32 = 2.0 / 16_777_216.0;

/// What a slack is multiplied by for the roundings of sums with it, 1 + 2^-21.
const LONGER: f32 = 1.0 + 1.0 / 2_097_152.0;

/// Parameters up to here are far from overflow.
const FAR: f32 = 1.0e36;

/// Along an axis where the direction is 0: from one plane to the next, so many times as far as the ray is long.
const STEEP: f32 = 1024.0;

/// The longest ray of which this is calculated, 2^60.
const LONG: f32 = 1.152_921_5e18;

/// What roundings are measured by: an axis' planes lie in a lattice from `first` on over an `extent`, from `begin` on as
/// seen from the ray's origin.
///
/// A position is rounded relative to coordinates, all else relative to distances from the origin.
#[inline(always)]
fn reach(first: f32, begin: f32, extent: f32) -> f32 {
    first.abs() + (begin.abs() + extent) * 8.0
}

/// The slopes of all axes.
///
/// *The error.* Let `o` be the origin, `r` the reciprocal, `f`, `h` and `l` the first plane, the step and the extent,
/// `g = |f - o| + l`, `u = 2^-24`; all that follows times `u |r|`. What the position gives,
/// `fl(fl(fl(fl(f + fl(k h)) - o) r) + s)`, is off by `l` for the first product, `|f| + l` for the position, and `g` each for the
/// difference, the product with `r` and the sum with `s`: less than `|f| + 5 g`. The line is off by `g` each for the
/// difference `f - o`, a step added to it, its product with `r` and two sums, and by `l` each for `h r` and its product with `k`:
/// less than `7 g`. [`ERROR`] times [`reach`] is `2 |f| + 16 g`, which leaves room for terms in `u²`. Sums with `s` take up to
/// `4 u s` more, for which `s` is lengthened by `8 u`. Underflow takes less than `2^-126`: a step is no denormal, and `2^-150` in
/// its product with `r` counts up to `2^20` times.
#[derive(Clone, Debug)]
pub(crate) struct Slopes {
    axes: [Slope; 3],
}

impl Slopes {
    /// The planes of `lattice` as `ray` sees them, and the part of the ray within the lattice; exits are late by `slack`.
    ///
    /// Of planes that are `thickness` steps thick, a number names the face before, whichever way the ray comes.
    #[inline(always)]
    pub(crate) fn new(ray: &PreparedRay, lattice: &Lattice, thickness: f32) -> (Self, Option<Segment>) {
        let slack = if ray.ray().t_min < 0.0 { slack_within(&whole(lattice), ray) } else { slack(0.0) };
        let along = |axis| Slope::along(axis, ray, lattice, thickness, slack);
        let ((x, a), (y, b), (z, c)) = (along(Axis::X), along(Axis::Y), along(Axis::Z));
        // NaN and infinity are not below.
        let (x, y, z) = if a + b + c < FAR {
            (x, y, z)
        } else {
            let [x, y, z] = Slope::carefully(ray, lattice, thickness, slack);
            (x, y, z)
        };
        let (mut enter, mut exit) = (ray.ray().t_min, beyond(ray.ray().t_max));
        for (axis, slope) in Axis::ALL.into_iter().zip([x, y, z]) {
            let last = lattice.last(axis) as i32 as f32 - thickness;
            let (met_first, met_last) = if ray.views[axis as usize].ascends() {
                (slope.entry.start, slope.exit.at(last))
            } else {
                (slope.entry.at(last), slope.exit.start)
            };
            enter = greatest(met_first, enter);
            exit = least(met_last, exit);
        }
        (Self { axes: [x, y, z] }, Segment::between(enter, exit))
    }

    /// That of an axis.
    #[inline(always)]
    pub(crate) fn of(&self, axis: Axis) -> &Slope {
        &self.axes[axis as usize]
    }

    /// That of the axis of this number, if there is one.
    #[inline(always)]
    pub(crate) fn along(&self, axis: u32) -> Option<&Slope> {
        self.axes.get(axis as usize)
    }
}

impl Slope {
    /// Decides nothing.
    const NONE: Self =
        Self { entry: Line { slope: 0.0, start: f32::NEG_INFINITY }, exit: Line { slope: 0.0, start: f32::INFINITY } };

    /// Leaves nothing of a ray.
    const NEVER: Self =
        Self { entry: Line { slope: 0.0, start: f32::INFINITY }, exit: Line { slope: 0.0, start: f32::NEG_INFINITY } };

    /// Those of all axes, where there are some along which the reciprocal is too large to calculate with.
    #[cold]
    #[inline(never)]
    fn carefully(ray: &PreparedRay, lattice: &Lattice, thickness: f32, slack: f32) -> [Self; 3] {
        let Some(whole) = Segment::within(&whole(lattice), 0, ray, slack) else { return [Self::NEVER; 3] };
        let end = greatest(whole.enter.abs(), whole.exit.abs());
        Axis::ALL.map(|axis| {
            let (slope, largest) = Self::along(axis, ray, lattice, thickness, slack);
            if largest < FAR { slope } else { Self::steep(axis, ray, lattice, thickness, end) }
        })
    }

    /// That of an axis, and the greatest of its parameters, about.
    #[inline(always)]
    fn along(axis: Axis, ray: &PreparedRay, lattice: &Lattice, thickness: f32, slack: f32) -> (Self, f32) {
        let view = &ray.views[axis as usize];
        let (first, step) = lattice.along(axis as u32);
        let begin = first - view.origin;
        let largest = reach(first, begin, lattice.extent(axis)) * view.exit.abs();
        let error = largest * ERROR + f32::MIN_POSITIVE;
        let (enters, leaves) = faces(view, begin, step, thickness);
        let entry = Line { slope: step * view.entry, start: enters * view.entry - error };
        let exit = Line { slope: step * view.exit, start: leaves * view.exit + (slack * LONGER + error) };
        (Self { entry, exit }, largest)
    }

    /// Where the direction is 0: planes before the origin are far before the ray's part in the bounds, which ends by `end`,
    /// those behind it far behind that.
    ///
    /// The sign of a distance in steps is what counts. It is off as a parameter is, `|f| + 13 g` in place of `|f| + 12 g`, and
    /// by `3 u` of `end`, a thousandth of what is left of the error allowed for a step.
    fn steep(axis: Axis, ray: &PreparedRay, lattice: &Lattice, thickness: f32, end: f32) -> Self {
        let view = &ray.views[axis as usize];
        if view.entry.is_finite() || view.entry.is_nan() || !(end < LONG) {
            // A finite reciprocal that is too large, or too long a ray.
            return Self::NONE;
        }
        let (first, step) = lattice.along(axis as u32);
        let begin = first - view.origin;
        let slope = (end * STEEP).copysign(view.entry);
        let error = reach(first, begin, lattice.extent(axis)) / step * ERROR * slope.abs() + end;
        let (enters, leaves) = faces(view, begin, step, thickness);
        let entry = Line { slope, start: enters / step * slope - error };
        let exit = Line { slope, start: leaves / step * slope + error };
        Self { entry, exit }
    }

    /// Where a ray enters at a plane, or before.
    #[inline(always)]
    pub(crate) fn entry(&self, plane: u32) -> f32 {
        // As a signed number: chips and hosts convert these in one instruction.
        self.entry.at(plane as i32 as f32)
    }

    /// Where a ray leaves at a plane, or behind.
    #[inline(always)]
    pub(crate) fn exit(&self, plane: u32) -> f32 {
        self.exit.at(plane as i32 as f32)
    }
}

/// What lies between a lattice's first planes and its last ones.
#[cold]
#[inline(never)]
fn whole(lattice: &Lattice) -> Aabb {
    let at = |axis, number| lattice.position(axis, number);
    let last = |axis| at(axis, lattice.last(axis));
    Aabb::new(
        Vec3::new(at(Axis::X, 0), at(Axis::Y, 0), at(Axis::Z, 0)),
        Vec3::new(last(Axis::X), last(Axis::Y), last(Axis::Z)),
    )
}

/// Where the first plane's face lies at which the ray enters, and that at which it leaves.
#[inline(always)]
fn faces(view: &AxisView, begin: f32, step: f32, thickness: f32) -> (f32, f32) {
    if thickness == 0.0 {
        return (begin, begin);
    }
    let end = begin + step * thickness;
    if view.ascends() { (begin, end) } else { (end, begin) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geometry::Ray,
        testing::{Random, cases},
    };

    /// How many planes cut a ray off, by their positions and by their numbers, in scenes of these sizes at these distances
    /// from the world's origin; nothing may be cut off that was not.
    fn cut_offs(sizes: &[f32], offsets: &[f32], t_mins: &[f32], factors: &[f32]) -> (u32, u32) {
        let mut random = Random::new(7);
        let (mut before, mut now) = (0, 0);
        for _ in 0..cases(30_000) {
            let size = sizes[random.below(sizes.len() as u32) as usize];
            let offset = offsets[random.below(offsets.len() as u32) as usize] * size;
            let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
            let (a, b, origin) = (point(size) + offset, point(size) + offset, point(size * 1.5) + offset);
            let mut direction = point(2.0);
            for axis in 0..3 {
                direction[axis] *= factors[random.below(factors.len() as u32) as usize];
            }
            let t_min = t_mins[random.below(t_mins.len() as u32) as usize];
            let Some(ray) = Ray::new(origin, direction).starting_at(t_min).prepare() else { continue };
            let bounds = Aabb::around([a, b]);
            let slack = slack_within(&bounds, &ray);
            let last = [0xffff, 0x3fff, 1][random.below(3) as usize];
            let thickness = random.below(2);
            let lattice = Lattice::over(&bounds, [last; 3]);
            let (slopes, part) = Slopes::new(&ray, &lattice, thickness as f32);
            let Some(Segment { enter, exit, .. }) = Segment::within(&bounds, 0, &ray, slack) else { continue };
            assert!(part.is_some_and(|part| part.enter <= enter && exit <= part.exit), "{ray:?} {bounds:?} {part:?}");
            for axis in Axis::ALL {
                let (view, slope) = (&ray.views[axis as usize], slopes.of(axis));
                for number in [0, last, random.below(last + 1), random.below(last + 1)] {
                    let (enters, leaves) =
                        if view.ascends() { (number, number + thickness) } else { (number + thickness, number) };
                    let entry = (lattice.position(axis, enters) - view.origin) * view.entry;
                    let leave = (lattice.position(axis, leaves) - view.origin) * view.exit + slack;
                    let (early, late) = (slope.entry(number), slope.exit(number));
                    assert!(greatest(early, enter) <= greatest(entry, enter), "{ray:?} {bounds:?} {number}");
                    assert!(least(late, exit) >= least(leave, exit), "{ray:?} {bounds:?} {number}");
                    before += u32::from(entry > exit || leave < enter);
                    now += u32::from(early > exit || late < enter);
                }
            }
        }
        (before, now)
    }

    #[test]
    fn no_part_of_a_ray_is_lost_against_positions() {
        let extremes = [1.0, 1.0e-3, 1.0e-40, 1.0e30];
        let factors = [1.0, 1.0, 0.0, -0.0, 1.0e-42, 1.0e-30];
        cut_offs(&extremes, &[0.0, 1.0, -1.0e5, 3.0e36], &[0.0, -1.0, -1.0e9, f32::NEG_INFINITY], &factors);
    }

    #[test]
    fn hardly_less_is_cut_off() {
        for (offset, percent) in [(0.0, 99), (-1.0e3, 99), (1.0e5, 95)] {
            let (before, now) = cut_offs(&[1.0, 1.0e-3, 1.0e6], &[offset], &[0.0, -1.0], &[1.0, 1.0, 1.0, 0.0, -0.0]);
            assert!(before > cases(10_000) && now * 100 >= before * percent, "{offset} {before} {now}");
        }
    }
}
