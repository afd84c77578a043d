//! The first tier for a ray and many triangles at a time, or for a triangle and many rays: [`filter`](super::filter) operation
//! by operation, so that where it answers it returns the same bits.

use core::marker::PhantomData;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, mask32x8};

use super::filter::{LARGE_AREA, SHEARED, SMALL, SMALL_AREA, TOLERANCE, U, UNDERFLOW};
use crate::geometry::{
    Axis, PreparedRay,
    ray::{LIFT, TINY, WIDENING},
};

/// The numbers of many lanes.
pub(crate) trait Floats<S: Simd>: SimdFloat<S, Element = f32> {}

impl<S: Simd, F: SimdFloat<S, Element = f32>> Floats<S> for F {}

/// Rays with one major axis, which they go along the same way, as the test of triangles wants them: one in all lanes, or another
/// in each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearLanes<S: Simd, F: Floats<S> = f32x8<S>> {
    /// The axes in the order of the shear.
    pub(crate) axes: [usize; 3],
    /// The origins in this order.
    origin: [F; 3],
    slope: [F; 2],
    inverse: F,
    /// Whether the rays go the other way along the major axis.
    backward: bool,
    simd: PhantomData<S>,
}

/// What bounds rays with one major axis: the test of eight triangles, all of which pass them by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wedge<S: Simd> {
    /// The axes in the order of the shear.
    pub(crate) axes: [usize; 3],
    /// The least and the greatest origins, in this order.
    pub(crate) origin: [[f32x8<S>; 2]; 3],
    /// The least and the greatest slopes.
    pub(crate) slope: [[f32x8<S>; 2]; 2],
}

impl<S: Simd> Wedge<S> {
    /// The least and the greatest sheared coordinates of three corners, given the intervals of what they are computed of; as
    /// roundings keep order, each ray's are between them.
    #[inline(always)]
    fn span(&self, simd: S, axis: usize, x: [f32x8<S>; 3], depths: [[f32x8<S>; 2]; 3]) -> (f32x8<S>, f32x8<S>) {
        let ([first, last], [flat, steep]) = (self.origin[axis], self.slope[axis]);
        let mut low = f32x8::splat(simd, f32::INFINITY);
        let mut high = -low;
        for (x, [near, far]) in x.into_iter().zip(depths) {
            let (p, q, r, s) = (flat * near, flat * far, steep * near, steep * far);
            low = low.min((x - last) - p.max(q).max(r.max(s)));
            high = high.max((x - first) - p.min(q).min(r.min(s)));
        }
        (low, high)
    }

    /// Which of the triangles some ray may hit; the corners' coordinates stand in the order of `axes`.
    ///
    /// The others have all corners on one side of each ray, along the first axis or the second, as far as the filter's
    /// `is_beside` proves it.
    #[inline(always)]
    pub(crate) fn may_hit(&self, simd: S, [a, b, c]: [[f32x8<S>; 3]; 3]) -> u32 {
        let [first, last] = self.origin[2];
        let depths = [[a[2] - last, a[2] - first], [b[2] - last, b[2] - first], [c[2] - last, c[2] - first]];
        let [da, db, dc] = depths;
        let deep = (da[0].abs().max(da[1].abs()) + db[0].abs().max(db[1].abs())) + dc[0].abs().max(dc[1].abs());
        let error = (deep * SHEARED + UNDERFLOW) * LIFT;
        let (x0, x1) = self.span(simd, 0, [a[0], b[0], c[0]], depths);
        let (y0, y1) = self.span(simd, 1, [a[1], b[1], c[1]], depths);
        let beside = x0.simd_gt(error) | x1.simd_lt(-error) | y0.simd_gt(error) | y1.simd_lt(-error);
        !beside.to_bitmask() as u32 & 0xff
    }
}

/// Pairs of rays and triangles of which some may be hits.
pub(crate) struct Possible<F> {
    edges: [F; 3],
    depths: [F; 3],
    spread: F,
    bound: F,
    least: F,
    greatest: F,
    /// A bit for each that is not proven to be missed.
    pub(crate) lanes: u32,
}

/// What is known of pairs that are possibly hits.
pub(crate) struct Crossings<F> {
    /// The rays' parameters.
    pub(crate) t: F,
    /// A bit for each that is hit, with a proven parameter within the limits.
    pub(crate) proven: u32,
    /// A bit for each that may be hit, but within the limits only as far as is known.
    pub(crate) open: u32,
    /// A bit for each open one that is hit, and of a size at which no other scale is tried: the slow tiers come next.
    pub(crate) decided: u32,
    /// A bit for each decided one that is hit within the limits, wherever that is; found out for any hits only.
    pub(crate) certain: u32,
    /// A bit for each determinant above zero.
    positive: u32,
    backward: bool,
}

/// [`beyond`](crate::geometry::beyond) in lanes.
#[inline(always)]
fn beyond_all<S: Simd, F: Floats<S>>(t: F) -> F {
    t + t.abs() * (4.0 * WIDENING) + 4.0 * TINY
}

impl<S: Simd> ShearLanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &PreparedRay) -> Self {
        let (shear, [x, y, z, _]) = (&ray.shear, &ray.views);
        // By masks, because which axis it is cannot be guessed; written out, as all that is for kernels.
        let (is_y, is_z) = (shear.major == Axis::Y, shear.major == Axis::Z);
        let axes = [(shear.major as usize + 1) % 3, (shear.major as usize + 2) % 3, shear.major as usize];
        let (is_y, is_z) = (mask32x8::splat(simd, is_y), mask32x8::splat(simd, is_z));
        let among = |x: f32, y: f32, z: f32| {
            is_z.select(f32x8::splat(simd, z), is_y.select(f32x8::splat(simd, y), f32x8::splat(simd, x)))
        };
        let (ox, oy, oz) = (x.origin, y.origin, z.origin);
        let (x, y, z) = (among(oy, oz, ox), among(oz, ox, oy), among(ox, oy, oz));
        let [sx, sy, sz] = shear.slope;
        let slope = [among(sy, sz, sx), among(sz, sx, sy)];
        Self::of(axes, [x, y, z], slope, (f32x8::splat(simd, shear.inverse), shear.inverse <= 0.0))
    }
}

impl<S: Simd, F: Floats<S>> ShearLanes<S, F> {
    /// As [`Shear`](crate::geometry::ray::Shear) has it of each ray, in its order; and whether all go backward.
    #[inline(always)]
    pub(crate) const fn of(axes: [usize; 3], origin: [F; 3], slope: [F; 2], (inverse, backward): (F, bool)) -> Self {
        Self { axes, origin, slope, inverse, backward, simd: PhantomData }
    }

    /// Points as the rays see them; their coordinates stand in the order of `axes`.
    #[inline(always)]
    pub(crate) fn shear(&self, [x, y, z]: [F; 3]) -> [F; 3] {
        let [ox, oy, oz] = self.origin;
        let [sx, sy] = self.slope;
        let z = z - oz;
        [(x - ox) - sx * z, (y - oy) - sy * z, z]
    }

    /// Which pairs may be hits; the triangles' corners are [sheared](Self::shear).
    #[inline(always)]
    pub(crate) fn test(&self, [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: [[F; 3]; 3]) -> Possible<F> {
        let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        let lifted = ((az.abs() + bz.abs()) + cz.abs()) * SHEARED;
        let spread = ((ax.abs() + ay.abs()) + (bx.abs() + by.abs())) + (cx.abs() + cy.abs());
        let bound = (lifted + spread * (2.0 * U / LIFT)) * (spread * LIFT) + UNDERFLOW;
        // A NaN makes the bound one, too.
        let (least, greatest) = (u.min(v).min(w), u.max(v).max(w));
        let missed = greatest.simd_gt(bound) & least.simd_lt(-bound);
        let lanes = !missed.to_bitmask() as u32 & ((1 << F::LEN) - 1);
        Possible { edges: [u, v, w], depths: [az, bz, cz], spread, bound, least, greatest, lanes }
    }

    /// Where the triangles are hit between the limits; `lanes` are those that may be hit. With `any`, which of them are certainly hit
    /// there, too.
    #[inline(always)]
    pub(crate) fn place(
        &self,
        simd: S,
        possible: &Possible<F>,
        lanes: u32,
        (t_min, t_max): (F, F),
        any: bool,
    ) -> Crossings<F> {
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
        let hit: F::Mask = least.simd_gt(bound) | greatest.simd_lt(-bound);
        let narrow = (edge * 16.0).simd_lt(area) & area.simd_lt(1.0e30);
        let near = (error * (8.0 * U)).simd_lt(limit) & limit.simd_gt(SMALL);
        let normal = magnitude.simd_gt(SMALL) & size.simd_gt(1.0e-30) & size.simd_lt(1.0e37);
        let within = t.simd_ge(t_min) & t.simd_le(t_max);
        let placed = hit & narrow & near & normal;
        let mut open = lanes & !placed.to_bitmask() as u32;
        let (mut decided, mut certain) = (0, 0);
        if open != 0 {
            decided = (hit & area.simd_ge(SMALL_AREA) & area.simd_le(LARGE_AREA)).to_bitmask() as u32;
            let error = ((error * (8.0 * U) + 1.0e-36) / area + magnitude * (8.0 * U) + 1.0e-36) * self.inverse.abs();
            let error = error + 1.0e-36;
            let outside = (t + error).simd_lt(t_min) | (t - error).simd_gt(beyond_all(t_max));
            if any {
                // The slow tiers round a number between two others, so that it stays there.
                let between = hit & narrow & (t - error).simd_ge(t_min) & (t + error).simd_le(t_max);
                certain = between.to_bitmask() as u32 & decided & open;
            }
            // A crossing lies between the corners' parameters along the major axis, with as much before it as behind.
            let (a, b, c) = (az * self.inverse, bz * self.inverse, cz * self.inverse);
            let (first, last) = (a.min(b).min(c), a.max(b).max(c));
            let beside = first.simd_gt(beyond_all(t_max)) | last.simd_lt(-beyond_all(-t_min));
            open &= !((hit & narrow & outside) | beside).to_bitmask() as u32;
        }
        let positive = determinant.simd_gt(F::splat(simd, 0.0)).to_bitmask() as u32;
        let proven = (placed & within).to_bitmask() as u32 & lanes;
        Crossings { t, proven, open, decided, certain, positive, backward: self.backward }
    }
}

impl<F> Crossings<F> {
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
