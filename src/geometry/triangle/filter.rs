//! The first tier: the shear test in `f32` with a proven bound on its error.

use super::Crossing;
use crate::{
    geometry::{Axis, Lattice, PreparedRay, beyond, ray::LIFT},
    math::greatest,
};

/// Half an ulp of 1.
pub(super) const U: f32 = 1.0 / 16_777_216.0;

/// 2^-125: covers what underflow can take from an edge function.
pub(super) const UNDERFLOW: f32 = 2.0 * f32::MIN_POSITIVE;

/// 2^-21 over [`LIFT`]: by how much the coordinates of a point at depth 1 may be off for a slope's sake, which is at most 1:
/// five roundings, and what their products and underflow add.
pub(super) const SHEARED: f32 = 1.0 / 2_097_152.0 / LIFT;

/// The relative error within which `t` is certified, 2^-17.
pub(super) const TOLERANCE: f32 = 1.0 / 131_072.0;

/// 2^-100: smaller magnitudes are left to the tiers with a wider range.
pub(super) const SMALL: f32 = 7.888_609e-31;

/// Beyond these determinants cubes of lengths may leave the range of `f32`: 2^-20 and 2^60.
pub(super) const SMALL_AREA: f32 = 1.0 / 1_048_576.0;
pub(super) const LARGE_AREA: f32 = 1_152_921_504_606_846_976.0;

/// By which lengths are then multiplied or divided, 2^40.
const SCALE: f32 = 1_099_511_627_776.0;

/// What `f32` can prove of the edge functions' signs.
pub(super) enum Verdict {
    /// The ray misses.
    Miss,
    /// The ray hits.
    Hit(Certain),
    /// Nothing.
    Unproven,
}

/// A hit, and what was found out on the way.
pub(super) struct Certain {
    /// The edge functions.
    edges: [f32; 3],
    /// The depths of the corners: how far away they are along the major axis.
    depths: [f32; 3],
    /// The sum of the sheared coordinates' magnitudes.
    spread: f32,
}

/// A corner where it lies, asked by axis.
pub(crate) trait Corner: Copy {
    /// The coordinate along an axis.
    fn along(self, axis: Axis) -> f32;
}

impl Corner for &[f32; 3] {
    #[inline(always)]
    fn along(self, axis: Axis) -> f32 {
        self[axis as usize]
    }
}

/// Half-words that number planes.
impl Corner for (&Lattice, &[u16; 3]) {
    #[inline(always)]
    fn along(self, axis: Axis) -> f32 {
        self.0.plane(axis as u32, u32::from(self.1[axis as usize]))
    }
}

/// The corners relative to the ray's origin, sheared so that the ray runs along the third axis.
pub(super) struct Sheared<const N: usize = 3> {
    x: [f32; N],
    y: [f32; N],
    z: [f32; N],
}

/// For three corners or four: loops over as many would be 600 bytes more at -Os.
macro_rules! sheared {
    ($shear:ident, $in_order:ident, $count:literal: $($corner:ident $depth:ident),+) => {
        /// [`Sheared`] with the axes in this order; none if `leave` says so of the corners' first coordinates and depths,
        /// before the second are asked for, or of the second.
        #[inline(always)]
        fn $in_order(
            [x, y, z]: [Axis; 3],
            [$($corner),+]: [impl Corner; $count],
            ray: &PreparedRay,
            leave: impl Fn([f32; $count], [f32; $count]) -> bool,
        ) -> Option<Sheared<$count>> {
            let [ox, oy, oz] = [x, y, z].map(|axis| ray.views[axis as usize].origin);
            let [sx, sy] = [x, y].map(|axis| ray.shear.slope[axis as usize]);
            let depths = [$($corner.along(z) - oz),+];
            let [$($depth),+] = depths;
            let first = [$(($corner.along(x) - ox) - sx * $depth),+];
            if leave(first, depths) {
                return None;
            }
            let second = [$(($corner.along(y) - oy) - sy * $depth),+];
            if leave(second, depths) {
                return None;
            }
            Some(Sheared { x: first, y: second, z: depths })
        }

        /// A way for each major axis: all tests of a ray take the same one, and no address has to be computed.
        #[inline(always)]
        pub(super) fn $shear(
            corners: [impl Corner; $count],
            ray: &PreparedRay,
            leave: impl Fn([f32; $count], [f32; $count]) -> bool,
        ) -> Option<Sheared<$count>> {
            match ray.shear.major {
                Axis::X => $in_order([Axis::Y, Axis::Z, Axis::X], corners, ray, leave),
                Axis::Y => $in_order([Axis::Z, Axis::X, Axis::Y], corners, ray, leave),
                Axis::Z => $in_order([Axis::X, Axis::Y, Axis::Z], corners, ray, leave),
            }
        }
    };
}

sheared!(shear, in_order, 3: a az, b bz, c cz);
sheared!(shear_quad, quad_in_order, 4: a az, b bz, c cz, d dz);

/// Whether the coordinates along one axis are looked at before anything else is computed: the first ones tell more than a
/// third of the triangles that are missed, the second ones as many of the rest. On hosts, which cannot predict this, a query
/// takes 4 % longer by it.
const ONE_BY_ONE: bool = cfg!(any(test, target_pointer_width = "32"));

/// Whether the ray, at 0, passes all corners on the same side, which no other coordinate can make up for.
///
/// A coordinate is off by at most `2 u` of itself and `5 u` of slope times depth, and what underflow takes; `error` is more
/// than `8 u` of slope times all depths, and 2^-61: the lifted error itself may underflow.
#[inline(always)]
fn is_beside([a, b, c]: [f32; 3], error: f32) -> bool {
    if a > error { (b > error) & (c > error) } else { (a < -error) & (b < -error) & (c < -error) }
}

/// Twice the areas that the ray spans with the edges opposite `a`, `b` and `c`.
///
/// An edge shared with another triangle gives exactly the negative there, so nothing can pass between the two.
#[inline(always)]
pub(super) fn edges(s: &Sheared) -> [f32; 3] {
    let ([ax, bx, cx], [ay, by, cy]) = (s.x, s.y);
    [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax]
}

/// More than `8 u` of slope times all depths, and what underflow takes of it.
#[inline(always)]
fn lifted([az, bz, cz]: [f32; 3]) -> f32 {
    SHEARED * ((az.abs() + bz.abs()) + cz.abs())
}

/// Whether the ray hits, as far as `f32` can prove it.
#[inline(always)]
pub(super) fn test(corners: [impl Corner; 3], ray: &PreparedRay) -> Verdict {
    let leave = |x, z| ONE_BY_ONE && is_beside(x, (lifted(z) + UNDERFLOW) * LIFT);
    match shear(corners, ray, leave) {
        Some(sheared) => judge(&sheared),
        None => Verdict::Miss,
    }
}

/// The same of corners that are sheared.
#[inline(always)]
fn judge(s: &Sheared) -> Verdict {
    let [u, v, w] = edges(s);
    let ([ax, bx, cx], [ay, by, cy]) = (s.x, s.y);
    let spread = ((ax.abs() + ay.abs()) + (bx.abs() + by.abs())) + (cx.abs() + cy.abs());

    // Signs are proven outside ±bound; comparisons are written so that NaN and infinity prove nothing. If a product of
    // coordinates has overflowed, so has the bound.
    let bound = (lifted(s.z) + spread * (2.0 * U / LIFT)) * (spread * LIFT) + UNDERFLOW;
    let hit = if (u > bound) | (v > bound) | (w > bound) {
        if (u < -bound) | (v < -bound) | (w < -bound) {
            return Verdict::Miss;
        }
        (u > bound) & (v > bound) & (w > bound)
    } else {
        (u < -bound) & (v < -bound) & (w < -bound)
    };
    if hit { Verdict::Hit(Certain { edges: [u, v, w], depths: s.z, spread }) } else { Verdict::Unproven }
}

/// What is proven of two triangles.
pub(crate) enum Either<T> {
    /// The ray misses both.
    Neither,
    /// It misses the other one than this, 0 or 1, of which this is known.
    One(u32, T),
    /// Of neither that the ray misses it.
    Both,
}

/// [`test`] of the triangles `a b c` and `a c d` at once.
#[inline(always)]
pub(super) fn test_quad(corners: [impl Corner; 4], ray: &PreparedRay) -> Either<Verdict> {
    let lifted = |[az, bz, cz, dz]: [f32; 4]| SHEARED * (((az.abs() + bz.abs()) + cz.abs()) + dz.abs());
    let leave = |[a, b, c, d]: [f32; 4], z| {
        let error = (lifted(z) + UNDERFLOW) * LIFT;
        if a > error {
            (b > error) & (c > error) & (d > error)
        } else {
            (a < -error) & (b < -error) & (c < -error) & (d < -error)
        }
    };
    let Some(Sheared { x, y, z }) = shear_quad(corners, ray, |x, z| ONE_BY_ONE && leave(x, z)) else {
        return Either::Neither;
    };
    let ([ax, bx, cx, dx], [ay, by, cy, dy]) = (x, y);
    let spread = (((ax.abs() + ay.abs()) + (bx.abs() + by.abs())) + (cx.abs() + cy.abs())) + (dx.abs() + dy.abs());
    // No less than that of either triangle, because roundings keep order: what is missed by this is missed by that.
    let bound = (lifted(z) + spread * (2.0 * U / LIFT)) * (spread * LIFT) + UNDERFLOW;
    let diagonal = ax * cy - ay * cx;
    let (ab, bc) = (bx * ay - by * ax, cx * by - cy * bx);
    let (cd, da) = (dx * cy - dy * cx, ax * dy - ay * dx);
    // The diagonal runs the other way in the second triangle.
    let missed = if diagonal > bound {
        ((ab < -bound) | (bc < -bound), (cd > bound) | (da > bound))
    } else if diagonal < -bound {
        ((ab > bound) | (bc > bound), (cd < -bound) | (da < -bound))
    } else {
        (false, false)
    };
    let third = |[a, b, c, d]: [f32; 4]| if missed.0 { [a, c, d] } else { [a, b, c] };
    match missed {
        (true, true) => Either::Neither,
        (false, false) => Either::Both,
        _ => Either::One(missed.0.into(), judge(&Sheared { x: third(x), y: third(y), z: third(z) })),
    }
}

impl Certain {
    /// The crossing; none if it is proven to lie outside the limits, NaN for a parameter that `f32` cannot prove.
    ///
    /// Out of line: most triangles are missed, and the loop that tests them needs all registers.
    #[inline(never)]
    pub(super) fn place(&self, ray: &PreparedRay, limits: (f32, f32)) -> Option<Crossing> {
        let inverse = ray.shear.inverse;
        match self.place_scaled(inverse, 1.0, limits) {
            Some(crossing) if crossing.t.is_nan() => self.place_again(inverse, crossing, limits),
            crossing => crossing,
        }
    }

    /// A second chance for what is unproven, with all lengths multiplied by a power of two: cubes of lengths leave the range of
    /// `f32` long before lengths do, and a scene of any scale shall be answered with the same bits.
    #[cold]
    #[inline(never)]
    fn place_again(&self, inverse: f32, unproven: Crossing, limits: (f32, f32)) -> Option<Crossing> {
        let [u, v, w] = self.edges;
        let area = ((u + v) + w).abs();
        let scale = if area < SMALL_AREA {
            SCALE
        } else if area > LARGE_AREA {
            1.0 / SCALE
        } else {
            return Some(unproven);
        };
        let longer = Self {
            edges: self.edges.map(|edge| edge * scale * scale),
            depths: self.depths.map(|depth| depth * scale),
            spread: self.spread * scale,
        };
        longer.place_scaled(inverse / scale, scale, limits)
    }

    /// The crossing, where all lengths are `scale` times as long as they were.
    #[inline(always)]
    fn place_scaled(&self, inverse: f32, scale: f32, (t_min, t_max): (f32, f32)) -> Option<Crossing> {
        let &Self { edges: [u, v, w], depths: [az, bz, cz], spread } = self;
        // The determinant has the sign of -(d . N) * d_major.
        let determinant = (u + v) + w;
        let front = (determinant > 0.0) == (inverse > 0.0);
        let (e1, e2) = (bz - az, cz - az);
        let q = az + (v * e1 + w * e2) / determinant;
        let t = q * inverse;

        let depth = greatest(greatest(az.abs(), bz.abs()), cz.abs());
        let extent = e1.abs() + e2.abs();
        let area = determinant.abs();
        // The errors of an edge function and of q, which is at most 8 U error / area.
        let edge = (depth * (8.0 * U) + spread * (4.0 * U)) * spread + UNDERFLOW * scale * scale;
        let error = extent * spread * (depth + spread) + (depth + extent) * area;
        // What the edge functions had lost by underflow is enlarged with them. Nothing is added where they were not.
        let error = if scale > 1.0 { error + extent * (UNDERFLOW * scale * scale / U) } else { error };
        let unproven = Crossing { t: f32::NAN, front };
        if !(edge * 16.0 < area && area < 1.0e30) {
            return Some(unproven);
        }
        let limit = TOLERANCE * q.abs() * area;
        if error * (8.0 * U) < limit && limit > SMALL && q.abs() > SMALL && t.abs() > 1.0e-30 && t.abs() < 1.0e37 {
            return Some(Crossing { t, front });
        }
        // Proven to lie outside: the slack belongs before any rounding that made `t` (rule R7).
        let error = ((error * (8.0 * U) + 1.0e-36) / area + q.abs() * (8.0 * U) + 1.0e-36) * inverse.abs() + 1.0e-36;
        if t + error < t_min || t - error > beyond(t_max) { None } else { Some(unproven) }
    }
}
