//! The second tier in lanes: [`shortcut`](super::shortcut) operation by operation, for a triangle and many rays at a time, or for
//! the four determinants of one ray and a triangle.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, f64x4, f64x8, mask64x8};

use super::{
    Triangle,
    shortcut::{self, SURE, U, WIDER},
};
use crate::geometry::Ray;

/// Values and bounds on their errors.
#[derive(Clone, Copy)]
struct Bounded<F> {
    value: F,
    error: F,
}

#[inline(always)]
fn determinant<S: Simd, F: SimdFloat<S, Element = f64>>(x: &[F; 3], y: &[F; 3], z: &[F; 3]) -> Bounded<F> {
    let (p0, q0) = (y[1] * z[2], y[2] * z[1]);
    let (p1, q1) = (y[2] * z[0], y[0] * z[2]);
    let (p2, q2) = (y[0] * z[1], y[1] * z[0]);
    let value = x[0] * (p0 - q0) + x[1] * (p1 - q1) + x[2] * (p2 - q2);
    let scale =
        x[0].abs() * (p0.abs() + q0.abs()) + x[1].abs() * (p1.abs() + q1.abs()) + x[2].abs() * (p2.abs() + q2.abs());
    Bounded { value, error: scale * (16.0 * U) }
}

/// Between which two numbers the parameters lie, and where this is certain, for corners relative to the rays' origins.
#[inline(always)]
fn between<S: Simd>(
    a: &[f64x8<S>; 3],
    b: &[f64x8<S>; 3],
    c: &[f64x8<S>; 3],
    d: &[f64x8<S>; 3],
) -> (f64x8<S>, f64x8<S>, mask64x8<S>) {
    let (u, v, w) = (determinant(d, b, c), determinant(d, c, a), determinant(d, a, b));
    let volume = determinant(a, b, c);
    let area = u.value + v.value + w.value;
    let area_error = (u.error + v.error + w.error) * 1.01;
    let inverse = f64x8::splat(area.token(), 1.0) / area;
    let quotient = volume.value * inverse;
    let size = quotient.abs();
    let error = (volume.error + size * area_error) * (inverse.abs() * WIDER) + size * (8.0 * U);
    // Numbers of different signs may both become zero.
    let known = area.abs().simd_gt(area_error * SURE) & error.simd_lt(size);
    (quotient - error, quotient + error, known)
}

/// Where rays of these origins and directions hit the triangle if they do, and a bit for each of which this is known.
#[inline(always)]
pub(crate) fn parameters<S: Simd>(
    simd: S,
    triangle: &Triangle,
    origin: [f32x16<S>; 3],
    direction: [f32x16<S>; 3],
) -> (f32x16<S>, u32) {
    let [ox, oy, oz] = [simd.widen_f32x16(origin[0]), simd.widen_f32x16(origin[1]), simd.widen_f32x16(origin[2])];
    let [dx, dy, dz] =
        [simd.widen_f32x16(direction[0]), simd.widen_f32x16(direction[1]), simd.widen_f32x16(direction[2])];
    let (low0, high0, certain0) = half(simd, triangle, [ox.0, oy.0, oz.0], [dx.0, dy.0, dz.0]);
    let (low1, high1, certain1) = half(simd, triangle, [ox.1, oy.1, oz.1], [dx.1, dy.1, dz.1]);
    let (low, high) = (simd.narrow_f64x8(low0, low1), simd.narrow_f64x8(high0, high1));
    let agreed = low.simd_eq(high) & low.abs().simd_le(f32::MAX);
    let certain = certain0.to_bitmask() & 0xff | (certain1.to_bitmask() & 0xff) << 8;
    (low, (agreed.to_bitmask() & certain) as u32)
}

/// As [`between`], for half of the rays.
#[inline(always)]
fn half<S: Simd>(
    simd: S,
    triangle: &Triangle,
    origin: [f64x8<S>; 3],
    direction: [f64x8<S>; 3],
) -> (f64x8<S>, f64x8<S>, mask64x8<S>) {
    let (a, b, c) = (triangle.a, triangle.b, triangle.c);
    let splat = |x: f32| f64x8::splat(simd, f64::from(x));
    let a = [splat(a.x) - origin[0], splat(a.y) - origin[1], splat(a.z) - origin[2]];
    let b = [splat(b.x) - origin[0], splat(b.y) - origin[1], splat(b.z) - origin[2]];
    let c = [splat(c.x) - origin[0], splat(c.y) - origin[1], splat(c.z) - origin[2]];
    between(&a, &b, &c, &direction)
}

/// The least and the greatest parameter at which a ray may hit a triangle if it does; none if next to nothing is known.
///
/// Of the corners `a`, `b` and `c` there are along each axis `b c a b`, then `c a b c`, so that each determinant has a lane; and `a` once
/// more.
#[inline(always)]
pub(crate) fn range<S: Simd>(simd: S, [x, y, z]: [f32x8<S>; 3], a: [f32; 3], ray: &Ray) -> Option<[f32; 2]> {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    let splat = |axis: usize| f64x4::splat(simd, f64::from(origin[axis]));
    let [ox, oy, oz] = [splat(0), splat(1), splat(2)];
    let (x, y, z) = (simd.widen_f32x8(x), simd.widen_f32x8(y), simd.widen_f32x8(z));
    // The direction three times, then the corner.
    let first = |axis: usize| {
        let (d, a) = (f64::from(direction[axis]), f64::from(a[axis]) - f64::from(origin[axis]));
        f64x4::load_array(simd, [d, d, d, a])
    };
    let Bounded { value, error } =
        determinant(&[first(0), first(1), first(2)], &[x.0 - ox, y.0 - oy, z.0 - oz], &[x.1 - ox, y.1 - oy, z.1 - oz]);
    let bounded = |lane: usize| shortcut::Bounded { value: value.as_array()[lane], error: error.as_array()[lane] };
    shortcut::range([bounded(0), bounded(1), bounded(2)], bounded(3))
}
