use super::sight::{Line, Sight};
use crate::geometry::Axis;

/// The number of the last plane.
pub(super) const LAST: i32 = 0xffff;

/// The number of the middle plane.
pub(super) const MIDDLE: i32 = 0x8000;

/// What a plane across a minor axis may be off by, in its axis's steps, with something to spare:
/// 1/4 for the rounding of corners, 1 for what is cut off the crossing of the middle plane, 4 for slopes below 2^-13,
/// 7 for planes of a lattice of 14 bits that are a step thick, 1 for the float roundings of planes and clipped triangles.
const ACROSS: i32 = 16;

/// What a depth may be off by, with something to spare: 6.1 for that of a hit, 4.1 for a slope's reciprocal of 13 bits,
/// 1 for what is cut off at the end.
const ALONG: i32 = 16;

/// A ray in the whole numbers of a lattice: see [`LatticeSpace::ray`](super::LatticeSpace::ray).
#[derive(Clone, Copy, Debug)]
pub struct LatticeRay {
    /// Per axis, the depth of its planes.
    pub(crate) views: [View; 3],
    /// A bit per axis along which the ray meets higher numbers first, repeated every four bits.
    pub(crate) descending: u32,
    /// How it sees triangles.
    pub(crate) sight: Sight,
    /// The depths between which hits count, both included, in 2^-8 planes.
    pub(crate) depths: (i32, i32),
    /// The whole depths between which the ray is in the lattice.
    pub(crate) inside: (u16, u16),
    pub(crate) mask: u32,
    /// The coordinate of the major axis's plane 0, and the distance of its planes.
    planes: (f32, f32),
    /// The coordinate of the origin, and the direction, along the major axis.
    line: (f32, f32),
    /// The parameters between which hits count.
    limits: (f32, f32),
}

/// How deep a ray is at the planes across an axis: `(plane * factor + entry) >> shift`, counted in planes of the major axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Depth per plane, as an integer of 13 bits.
    factor: i32,
    /// Makes it too small by the slack.
    entry: i32,
    /// Makes it too large by the slack.
    exit: i32,
    shift: u32,
}

impl View {
    /// The depth at which the ray enters what is behind a plane at the earliest.
    #[inline(always)]
    pub(crate) const fn entry(&self, plane: u32) -> i32 {
        self.cut((plane as i32).wrapping_mul(self.factor).wrapping_add(self.entry))
    }

    /// The depth at which it leaves what is before the plane at the latest.
    #[inline(always)]
    pub(crate) const fn exit(&self, plane: u32) -> i32 {
        self.cut((plane as i32).wrapping_mul(self.factor).wrapping_add(self.exit))
    }

    #[inline(always)]
    const fn cut(&self, depth: i32) -> i32 {
        depth >> (self.shift & 31)
    }

    /// The earliest entries where planes may be off by so many more steps.
    pub(super) const fn entries(&self, steps: i32) -> Passing {
        Passing {
            constant: self.entry - steps * self.factor.abs(),
            factor: self.factor as i16,
            shift: self.shift as u8,
        }
    }

    /// And the latest exits.
    pub(super) const fn exits(&self, steps: i32) -> Passing {
        Passing { constant: self.exit + steps * self.factor.abs(), factor: self.factor as i16, shift: self.shift as u8 }
    }

    /// The planes of the major axis itself.
    pub(super) const fn along(descends: bool) -> Self {
        let (factor, first) = if descends { (-1, LAST) } else { (1, 0) };
        Self { factor, entry: first - ALONG, exit: first + ALONG, shift: 0 }
    }

    /// The planes of an axis that the ray crosses at `middle` with a slope, both in 2^-14.
    pub(super) fn across(middle: i32, slope: i32, descends: bool) -> Self {
        // As flat as a reciprocal of 13 bits can tell: within the lattice that is 4 planes off at most.
        let steps = slope.unsigned_abs().max(2);
        let log = steps.ilog2();
        let shift = log - 1;
        // In 2^12 … 2^13.
        let reciprocal = ((1 << (13 + log)) / steps) as i32;
        let factor = if (slope < 0) == descends { reciprocal } else { -reciprocal };
        let depth = if descends { LAST - MIDDLE } else { MIDDLE };
        // At most 98,303 · 2^13 + 2^28 in magnitude, and planes add 2^29: no overflow.
        let constant = (depth << shift) - (middle >> LatticeRay::FRACTION) * factor;
        let slack = (ALONG << shift) + ACROSS * reciprocal;
        Self { factor, entry: constant - slack, exit: constant + slack + (1 << shift), shift }
    }

    /// Whether the ray meets higher numbers first.
    pub(super) const fn descends(&self) -> bool {
        self.factor < 0
    }
}

/// One bound of a [`View`], in 8 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passing {
    constant: i32,
    factor: i16,
    shift: u8,
}

impl Passing {
    /// The depth at a plane.
    #[inline(always)]
    pub(super) const fn depth(&self, plane: u32) -> i32 {
        (plane as i32).wrapping_mul(self.factor as i32).wrapping_add(self.constant) >> (self.shift & 31)
    }

    /// The latest exits of rays that never leave what is before a plane, above the lowest that any of them is at.
    pub(super) const fn above(lowest: i32) -> Self {
        // A plane lower, and it is never entered.
        const SLACK: i32 = 4 * ACROSS;
        let lowest = if lowest < -SLACK { -SLACK } else { lowest };
        Self { constant: (SLACK - lowest) << 13, factor: 1 << 13, shift: 0 }
    }
}

/// The hits that count.
pub(super) struct Interval {
    /// By their depths, in 2^-8.
    pub(super) depths: (i32, i32),
    /// By their parameters.
    pub(super) limits: (f32, f32),
}

impl LatticeRay {
    /// Bits behind the point of slopes and crossings.
    pub(super) const FRACTION: i32 = 14;

    /// The ray along `line`; `None` if it misses the lattice.
    ///
    /// `planes` are the major axis's: where the first is, and their distance; `along` it are origin and direction.
    #[inline(always)]
    pub(super) fn new(
        line: &Line,
        interval: &Interval,
        planes: (f32, f32),
        along: (f32, f32),
        mask: u32,
    ) -> Option<Self> {
        let sight = Sight::new(line)?;
        let Line { major, descends, crossings: [(x, x_slope), (y, y_slope)] } = *line;
        let Interval { depths, limits } = *interval;
        let (first, second) = (View::across(x, x_slope, descends), View::across(y, y_slope, descends));
        let mut inside = ((depths.0 >> 8).max(0), (depths.1 >> 8).min(LAST));
        for view in [&first, &second] {
            let (from, until) = if view.descends() { (LAST, 0) } else { (0, LAST) };
            inside.0 = inside.0.max(view.entry(from as u32));
            inside.1 = inside.1.min(view.exit(until as u32));
        }
        if inside.0 > inside.1 {
            return None;
        }
        // The two axes follow the major one.
        let view = View::along(descends);
        let views = match major {
            Axis::X => [view, first, second],
            Axis::Y => [second, view, first],
            Axis::Z => [first, second, view],
        };
        let [vx, vy, vz] = &views;
        let bits = u32::from(vx.descends()) | u32::from(vy.descends()) << 1 | u32::from(vz.descends()) << 2;
        Some(Self {
            views,
            descending: bits * 0x1111_1111,
            sight,
            depths,
            inside: (inside.0 as u16, inside.1 as u16),
            mask,
            planes,
            line: along,
            limits,
        })
    }

    /// The ray's parameter at a depth in 2^-8.
    pub(crate) fn parameter(&self, depth: i32) -> f32 {
        let t = parameter(self.sight.plane(depth), self.planes, self.line);
        let t = if t < self.limits.0 { self.limits.0 } else { t };
        if t > self.limits.1 { self.limits.1 } else { t }
    }
}

/// The parameter at which a line, of which origin and direction are given, is at a plane in 2^-8 of its major axis.
#[inline(always)]
pub(super) fn parameter(plane: i32, (first, step): (f32, f32), (origin, direction): (f32, f32)) -> f32 {
    (first + plane as f32 * (step * (1.0 / 256.0)) - origin) / direction
}
