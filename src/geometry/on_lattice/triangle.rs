use super::{LatticeRay, sight::Sight};
use crate::geometry::Axis;

/// How deep a ray hits a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Depth {
    /// In 2^-8 planes of the major axis.
    pub(crate) depth: i32,
    /// Whether the ray comes from the front.
    pub(crate) front: bool,
}

/// The corners of a triangle, by the numbers of their planes.
pub(crate) type Corners<'t> = [&'t [u16; 3]; 3];

/// Edge functions that agree, which make a hit: each cut to as many bits as leave 16 to their sum.
#[derive(Clone, Copy)]
struct Weights {
    of: [u32; 3],
    /// Whether the corners run counter-clockwise, seen against the major axis.
    counter_clockwise: bool,
}

impl Weights {
    /// Twice the areas that the ray spans with the edges, exact, in sixteenths; none if there is no area.
    #[inline(always)]
    fn small([u, v, w]: [u32; 3], counter_clockwise: bool) -> Option<Self> {
        // Below 2^32: the triangle lies in a square of 2^16.
        let area = u + v + w;
        let shift = 16_u32.saturating_sub(area.leading_zeros());
        (area != 0).then_some(Self { of: [u >> shift, v >> shift, w >> shift], counter_clockwise })
    }

    /// The same of triangles of any size.
    #[inline(never)]
    fn large(x: [i32; 3], y: [i32; 3]) -> Option<Self> {
        let ([ax, bx, cx], [ay, by, cy]) = (x.map(i64::from), y.map(i64::from));
        let (u, v) = (cx * by - cy * bx, ax * cy - ay * cx);
        // A product of 64 bits takes 50 instructions where there is none in hardware.
        if (u < 0 && v > 0) || (u > 0 && v < 0) {
            return None;
        }
        let w = bx * ay - by * ax;
        let counter_clockwise = (u | v | w) >= 0;
        if !(counter_clockwise || (u <= 0 && v <= 0 && w <= 0)) {
            return None;
        }
        let [u, v, w] = [u, v, w].map(i64::unsigned_abs);
        let area = u + v + w;
        let shift = 48_u32.saturating_sub(area.leading_zeros());
        (area != 0).then_some(Self { of: [u, v, w].map(|edge| (edge >> shift) as u32), counter_clockwise })
    }
}

impl Sight {
    /// Where the line of the ray crosses a triangle, borders included.
    #[inline(always)]
    pub(crate) fn crossing(&self, corners: Corners<'_>) -> Option<Depth> {
        let weights = self.weights(corners)?;
        Some(Depth { depth: self.depth(corners, &weights), front: self.is_front(&weights) })
    }

    /// Whether the ray comes from the front.
    #[inline(always)]
    const fn is_front(&self, weights: &Weights) -> bool {
        weights.counter_clockwise != self.descends
    }

    /// The edge functions if they make a hit.
    #[inline(always)]
    fn weights(&self, corners: Corners<'_>) -> Option<Weights> {
        let [first, second, major] = self.axes;
        let [az, bz, cz] = corners.map(|corner| i32::from(corner[major as usize]));
        // Where a corner is when seen along the ray, in 2^-14. The products fit, and so do the differences (`anchor`),
        // whatever wraps on the way.
        let seen = |axis: Axis, slope: i32, anchor: i32| {
            let [a, b, c] = corners.map(|corner| (i32::from(corner[axis as usize]) << LatticeRay::FRACTION) - anchor);
            [a.wrapping_sub(slope * az), b.wrapping_sub(slope * bz), c.wrapping_sub(slope * cz)]
        };
        let [ax, bx, cx] = seen(first, self.slope[0], self.anchor[0]);
        if are_on_one_side(ax, bx, cx) {
            return None;
        }
        let [ay, by, cy] = seen(second, self.slope[1], self.anchor[1]);
        if are_on_one_side(ay, by, cy) {
            return None;
        }
        let ([ax, bx, cx], [ay, by, cy]) = ([ax, bx, cx].map(rounded), [ay, by, cy].map(rounded));
        let is_small = |x: i32| (x + 0x8000) as u32 <= 0xffff;
        let all_small = is_small(ax) && is_small(bx) && is_small(cx) && is_small(ay) && is_small(by) && is_small(cy);
        if !all_small {
            return Weights::large([ax, bx, cx], [ay, by, cy]);
        }
        let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        if (u | v | w) >= 0 {
            Weights::small([u as u32, v as u32, w as u32], true)
        } else if u <= 0 && v <= 0 && w <= 0 {
            Weights::small([u.unsigned_abs(), v.unsigned_abs(), w.unsigned_abs()], false)
        } else {
            None
        }
    }

    /// The mean of the corners' depths by their weights: never outside of them.
    #[inline(always)]
    fn depth(&self, corners: Corners<'_>, weights: &Weights) -> i32 {
        let [.., major] = self.axes;
        let [a, b, c] = corners.map(|corner| u32::from(corner[major as usize]));
        let [u, v, w] = weights.of;
        let least = a.min(b).min(c);
        let area = (u + v + w).max(1);
        // Below 2^32: the weights sum up to less than 2^16.
        let sum = u * (a - least) + v * (b - least) + w * (c - least);
        let (whole, rest) = (sum / area, sum % area);
        self.plane((((least + whole) << 8) + (rest << 8) / area) as i32)
    }
}

/// To the middle of a half step, in quarters: never 0, so that the sign alone says on which side a corner is.
#[inline(always)]
const fn rounded(x: i32) -> i32 {
    x >> 12 | 1
}

/// Whether three numbers have the same sign, 0 being positive.
#[inline(always)]
const fn are_on_one_side(a: i32, b: i32, c: i32) -> bool {
    (a & b & c) < 0 || (a | b | c) >= 0
}
