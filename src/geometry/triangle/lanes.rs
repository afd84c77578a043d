//! The first tier for eight triangles at a time: [`filter`](super::filter) operation by operation, so that where it answers it
//! returns the same bits.

use fearless_simd::{Simd, SimdBase, SimdMask, f32x8, mask32x8};

use super::filter::{LARGE_AREA, SHEARED, SMALL, SMALL_AREA, TOLERANCE, U, UNDERFLOW};
use crate::geometry::{PreparedRay, beyond, ray::LIFT};

/// A ray as the test of eight triangles wants it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearLanes<S: Simd> {
    /// The axes in the order of the shear.
    pub(crate) axes: [usize; 3],
    origin: [f32x8<S>; 3],
    slope: [f32x8<S>; 2],
    inverse: f32,
}

/// Eight triangles of which some may be hit.
pub(crate) struct Possible<S: Simd> {
    edges: [f32x8<S>; 3],
    depths: [f32x8<S>; 3],
    spread: f32x8<S>,
    bound: f32x8<S>,
    least: f32x8<S>,
    greatest: f32x8<S>,
    /// A bit for each that is not proven to be missed.
    pub(crate) lanes: u32,
}

/// What is known of eight triangles that are possibly hit.
pub(crate) struct Crossings<S: Simd> {
    /// The ray's parameters.
    pub(crate) t: f32x8<S>,
    /// A bit for each that is hit, with a proven parameter within the limits.
    pub(crate) proven: u32,
    /// A bit for each that may be hit, but within the limits only as far as is known.
    pub(crate) open: u32,
    /// A bit for each open one that is hit, and of a size at which no other scale is tried: the slow tiers come next.
    decided: u32,
    /// A bit for each determinant above zero.
    positive: u32,
    backward: bool,
}

/// The greatest parameter that is not [`beyond`] any less than `t`.
#[inline(always)]
fn before(t: f32) -> f32 {
    -beyond(-t)
}

impl<S: Simd> ShearLanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &PreparedRay) -> Self {
        let shear = &ray.shear;
        let splat = |x: f32| f32x8::splat(simd, x);
        let major = shear.major;
        let axes @ [x, y, _] = [major.next() as usize, major.next().next() as usize, major as usize];
        Self {
            axes,
            origin: axes.map(|axis| splat(ray.views[axis].origin)),
            slope: [x, y].map(|axis| splat(shear.slope[axis])),
            inverse: shear.inverse,
        }
    }

    /// Which of the triangles may be hit; the corners' coordinates stand in the order of `axes`.
    #[inline(always)]
    pub(crate) fn test(&self, [a, b, c]: [[f32x8<S>; 3]; 3]) -> Possible<S> {
        let [ox, oy, oz] = self.origin;
        let [sx, sy] = self.slope;
        let (az, bz, cz) = (a[2] - oz, b[2] - oz, c[2] - oz);
        let (ax, bx, cx) = ((a[0] - ox) - sx * az, (b[0] - ox) - sx * bz, (c[0] - ox) - sx * cz);
        let (ay, by, cy) = ((a[1] - oy) - sy * az, (b[1] - oy) - sy * bz, (c[1] - oy) - sy * cz);
        let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        let lifted = ((az.abs() + bz.abs()) + cz.abs()) * SHEARED;
        let spread = ((ax.abs() + ay.abs()) + (bx.abs() + by.abs())) + (cx.abs() + cy.abs());
        let bound = (lifted + spread * (2.0 * U / LIFT)) * (spread * LIFT) + UNDERFLOW;
        // A NaN makes the bound one, too.
        let (least, greatest) = (u.min(v).min(w), u.max(v).max(w));
        let missed = greatest.simd_gt(bound) & least.simd_lt(-bound);
        let lanes = !missed.to_bitmask() as u32 & 0xff;
        Possible { edges: [u, v, w], depths: [az, bz, cz], spread, bound, least, greatest, lanes }
    }

    /// Where the triangles are hit between the limits; `lanes` are those that may be hit.
    #[inline(always)]
    pub(crate) fn place(
        &self,
        simd: S,
        possible: &Possible<S>,
        lanes: u32,
        (t_min, t_max): (f32, f32),
    ) -> Crossings<S> {
        let &Possible { edges: [u, v, w], depths: [az, bz, cz], spread, bound, least, greatest, .. } = possible;
        let determinant = (u + v) + w;
        let (e1, e2) = (bz - az, cz - az);
        let q = az + (v * e1 + w * e2) / determinant;
        let t = q * self.inverse;
        let depth = az.abs().max(bz.abs()).max(cz.abs());
        let extent = e1.abs() + e2.abs();
        let area = determinant.abs();
        let edge = (depth * (8.0 * U) + spread * (4.0 * U)) * spread + UNDERFLOW;
        let error = extent * spread * (depth + spread) + (depth + extent) * area;
        let (magnitude, size) = (q.abs(), t.abs());
        let limit = magnitude * TOLERANCE * area;
        let hit: mask32x8<S> = least.simd_gt(bound) | greatest.simd_lt(-bound);
        let narrow = (edge * 16.0).simd_lt(area) & area.simd_lt(1.0e30);
        let near = (error * (8.0 * U)).simd_lt(limit) & limit.simd_gt(SMALL);
        let normal = magnitude.simd_gt(SMALL) & size.simd_gt(1.0e-30) & size.simd_lt(1.0e37);
        let within = t.simd_ge(t_min) & t.simd_le(t_max);
        let placed = hit & narrow & near & normal;
        let mut open = lanes & !placed.to_bitmask() as u32;
        let mut decided = 0;
        if open != 0 {
            decided = (hit & area.simd_ge(SMALL_AREA) & area.simd_le(LARGE_AREA)).to_bitmask() as u32;
            let error = ((error * (8.0 * U) + 1.0e-36) / area + magnitude * (8.0 * U) + 1.0e-36) * self.inverse.abs();
            let error = error + 1.0e-36;
            let outside = (t + error).simd_lt(t_min) | (t - error).simd_gt(beyond(t_max));
            // A crossing lies between the corners' parameters along the major axis.
            let [a, b, c] = possible.depths.map(|depth| depth * self.inverse);
            let (first, last) = (a.min(b).min(c), a.max(b).max(c));
            let beside = first.simd_gt(beyond(t_max)) | last.simd_lt(before(t_min));
            open &= !((hit & narrow & outside) | beside).to_bitmask() as u32;
        }
        let positive = determinant.simd_gt(f32x8::splat(simd, 0.0)).to_bitmask() as u32;
        let proven = (placed & within).to_bitmask() as u32 & lanes;
        Crossings { t, proven, open, decided, positive, backward: self.inverse <= 0.0 }
    }
}

impl<S: Simd> Crossings<S> {
    /// A bit for each that is hit from its front.
    #[inline(always)]
    pub(crate) fn front(&self) -> u32 {
        if self.backward { !self.positive } else { self.positive }
    }

    /// Whether an open lane's triangle is hit from its front, if only the slow tiers can say where it is hit.
    #[inline(always)]
    pub(crate) fn is_front(&self, lane: usize) -> Option<bool> {
        (self.decided >> lane & 1 != 0).then_some(self.front() >> lane & 1 != 0)
    }
}
