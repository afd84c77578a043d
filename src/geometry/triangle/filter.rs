//! The first tier: the shear test in `f32` with a proven bound on its error.

use super::Crossing;
use crate::geometry::{Axis, Lattice, PreparedRay, ray::Shear};

/// Half an ulp of 1.
const U: f32 = 1.0 / 16_777_216.0;

/// 2^-125: covers what underflow can take from an edge function.
const UNDERFLOW: f32 = 2.0 * f32::MIN_POSITIVE;

/// The relative error within which `t` is certified, 2^-17.
const TOLERANCE: f32 = 1.0 / 131_072.0;

/// 2^-100: smaller magnitudes are left to the tiers with a wider range.
const SMALL: f32 = 7.888_609e-31;

/// What `f32` can prove.
pub(super) enum Verdict {
    /// The ray misses.
    Miss,
    /// The ray hits here.
    Hit(Crossing),
    /// The ray hits within `error` of this parameter.
    Near { crossing: Crossing, error: f32 },
    /// Nothing.
    Unproven,
}

/// A corner where it lies: asked by axis, which in memory costs one load and in registers a detour.
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
pub(super) struct Sheared {
    x: [f32; 3],
    y: [f32; 3],
    z: [f32; 3],
}

#[inline(always)]
pub(super) fn shear(corners: [impl Corner; 3], ray: &PreparedRay) -> Sheared {
    let Shear { axes: [kx, ky, kz], origin: [ox, oy, oz], slope: [sx, sy], .. } = ray.shear;
    // Corner by corner, without an index: at opt-level "s" it would be checked.
    let [a, b, c] = corners.map(|v| {
        let z = v.along(kz) - oz;
        [(v.along(kx) - ox) - sx * z, (v.along(ky) - oy) - sy * z, z]
    });
    Sheared { x: [a[0], b[0], c[0]], y: [a[1], b[1], c[1]], z: [a[2], b[2], c[2]] }
}

/// Twice the areas that the ray spans with the edges opposite `a`, `b` and `c`.
///
/// An edge shared with another triangle gives exactly the negative there, so nothing can pass between the two.
#[inline(always)]
pub(super) fn edges(s: &Sheared) -> [f32; 3] {
    let ([ax, bx, cx], [ay, by, cy]) = (s.x, s.y);
    [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax]
}

#[inline(always)]
pub(super) fn test(corners: [impl Corner; 3], ray: &PreparedRay) -> Verdict {
    let s = shear(corners, ray);
    let [u, v, w] = edges(&s);
    let ([ax, bx, cx], [ay, by, cy], [az, bz, cz]) = (s.x, s.y, s.z);
    let spread = ((ax.abs() + ay.abs()) + (bx.abs() + by.abs())) + (cx.abs() + cy.abs());
    let (za, zb, zc) = (az.abs(), bz.abs(), cz.abs());
    let depth = if za > zb { za } else { zb };
    let depth = if zc > depth { zc } else { depth };

    // Signs are proven outside ±bound; comparisons are written so that NaN and infinity prove nothing.
    let bound = (depth * (8.0 * U) + spread * (4.0 * U)) * spread + UNDERFLOW;
    if (u > bound) | (v > bound) | (w > bound) {
        if (u < -bound) | (v < -bound) | (w < -bound) {
            return if bound < f32::INFINITY { Verdict::Miss } else { Verdict::Unproven };
        }
        if !((u > bound) & (v > bound) & (w > bound)) {
            return Verdict::Unproven;
        }
    } else if !((u < -bound) & (v < -bound) & (w < -bound)) {
        return Verdict::Unproven;
    }

    // The determinant has the sign of -(d . N) * d_major.
    let determinant = (u + v) + w;
    let inverse = ray.shear.inverse;
    let front = (determinant > 0.0) == (inverse > 0.0);
    let (e1, e2) = (bz - az, cz - az);
    let q = az + (v * e1 + w * e2) / determinant;
    let t = q * inverse;

    let extent = e1.abs() + e2.abs();
    let area = determinant.abs();
    let error = extent * spread * (depth + spread) + (depth + extent) * area; // |q - exact| <= 8 U error / area
    let crossing = Crossing { t, front };
    if bound * 16.0 < area && area < 1.0e30 {
        let limit = TOLERANCE * q.abs() * area;
        if error * (8.0 * U) < limit && limit > SMALL && q.abs() > SMALL && t.abs() > 1.0e-30 && t.abs() < 1.0e37 {
            return Verdict::Hit(crossing);
        }
        let error = ((error * (8.0 * U) + 1.0e-36) / area + q.abs() * (8.0 * U) + 1.0e-36) * inverse.abs() + 1.0e-36;
        Verdict::Near { crossing, error }
    } else {
        Verdict::Near { crossing, error: f32::INFINITY }
    }
}
