//! The second tier for a triangle and many rays at a time: [`shortcut`](super::shortcut) operation by operation.

use fearless_simd::{Simd, SimdBase, SimdMask, f32x16, f64x8, mask64x8};

use super::{Triangle, shortcut::U};

/// Values and bounds on their errors.
#[derive(Clone, Copy)]
struct Bounded<S: Simd> {
    value: f64x8<S>,
    error: f64x8<S>,
}

#[inline(always)]
fn determinant<S: Simd>(x: &[f64x8<S>; 3], y: &[f64x8<S>; 3], z: &[f64x8<S>; 3]) -> Bounded<S> {
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
    let quotient = volume.value / area;
    let relative = volume.error / volume.value.abs() + area_error / (area.abs() - area_error) + 4.0 * U;
    let (low, high) = (quotient * (-relative + 1.0), quotient * (relative + 1.0));
    (low, high, area.abs().simd_gt(area_error * 2.0) & relative.simd_lt(1.0e-3))
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
