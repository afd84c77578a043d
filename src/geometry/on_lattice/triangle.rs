use super::{LatticeRay, ray::LAST};
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
type Corners<'t> = [&'t [u16; 3]; 3];

/// Edge functions that agree: twice the areas that the ray spans with the edges, exact, in units of a sixteenth.
enum Weights {
    /// Of triangles smaller than an eighth of the lattice.
    Small([u32; 3]),
    Large([u64; 3]),
}

impl Weights {
    /// The same weights to 15 or 16 bits.
    #[inline(always)]
    fn cut(self) -> [u32; 3] {
        match self {
            Self::Small([u, v, w]) => {
                // Below 2^32: the triangle lies in a square of 2^16.
                let shift = 16_u32.saturating_sub((u + v + w).leading_zeros());
                [u >> shift, v >> shift, w >> shift]
            }
            Self::Large([u, v, w]) => {
                let shift = 48_u32.saturating_sub((u + v + w).leading_zeros());
                [(u >> shift) as u32, (v >> shift) as u32, (w >> shift) as u32]
            }
        }
    }
}

impl LatticeRay {
    /// Where the line of the ray crosses a triangle, borders included.
    #[inline(always)]
    pub(crate) fn crossing(&self, corners: Corners<'_>) -> Option<Depth> {
        let (weights, front) = self.weights(corners)?;
        Some(Depth { depth: self.depth(corners, weights), front })
    }

    /// Whether it crosses the triangle between two depths, and from the front.
    #[inline(always)]
    pub(crate) fn crosses(&self, corners: Corners<'_>, (from, until): (i32, i32)) -> Option<bool> {
        let (weights, front) = self.weights(corners)?;
        // No depth lies outside of those of the corners: mostly that is enough to know.
        let [.., major] = self.axes;
        let certain = corners.into_iter().all(|corner| {
            let depth = self.oriented(i32::from(corner[major as usize]) << 8);
            from <= depth && depth <= until
        });
        let within = || {
            let depth = self.depth(corners, weights);
            from <= depth && depth <= until
        };
        (certain || within()).then_some(front)
    }

    /// The depth of a plane, both in 2^-8.
    #[inline(always)]
    fn oriented(&self, plane: i32) -> i32 {
        let [.., major] = self.axes;
        if self.descending >> (major as u32) & 1 != 0 { (LAST << 8) - plane } else { plane }
    }

    /// The edge functions if they make a hit, and from which side.
    #[inline(always)]
    fn weights(&self, corners: Corners<'_>) -> Option<(Weights, bool)> {
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
        let (weights, counter_clockwise) = if all_small {
            let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
            if (u | v | w) >= 0 {
                (Weights::Small([u as u32, v as u32, w as u32]), true)
            } else if u <= 0 && v <= 0 && w <= 0 {
                (Weights::Small([u.unsigned_abs(), v.unsigned_abs(), w.unsigned_abs()]), false)
            } else {
                return None;
            }
        } else {
            wide([ax, bx, cx], [ay, by, cy])?
        };
        let area = match weights {
            Weights::Small([u, v, w]) => (u | v | w) != 0,
            Weights::Large([u, v, w]) => (u | v | w) != 0,
        };
        let descends = self.descending >> (major as u32) & 1 != 0;
        area.then_some((weights, counter_clockwise != descends))
    }

    /// The mean of the corners' depths by their weights: never outside of them.
    #[inline(always)]
    fn depth(&self, corners: Corners<'_>, weights: Weights) -> i32 {
        let [.., major] = self.axes;
        let [a, b, c] = corners.map(|corner| u32::from(corner[major as usize]));
        let [u, v, w] = weights.cut();
        let least = a.min(b).min(c);
        let area = (u + v + w).max(1);
        // Below 2^32: the weights sum up to less than 2^16.
        let sum = u * (a - least) + v * (b - least) + w * (c - least);
        let (whole, rest) = (sum / area, sum % area);
        self.oriented(((least + whole) << 8 | (rest << 8) / area) as i32)
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

/// The edge functions of triangles of any size.
#[inline(never)]
fn wide(x: [i32; 3], y: [i32; 3]) -> Option<(Weights, bool)> {
    let ([ax, bx, cx], [ay, by, cy]) = (x.map(i64::from), y.map(i64::from));
    let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
    if u >= 0 && v >= 0 && w >= 0 {
        Some((Weights::Large([u as u64, v as u64, w as u64]), true))
    } else if u <= 0 && v <= 0 && w <= 0 {
        Some((Weights::Large([u.unsigned_abs(), v.unsigned_abs(), w.unsigned_abs()]), false))
    } else {
        None
    }
}
