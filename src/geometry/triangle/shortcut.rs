//! The second tier where doubles are in hardware: `f64` with a forward error bound.

use glam::Vec3;

use super::{Crossing, Sign, Triangle, agreement, exact};
use crate::geometry::PreparedRay;

/// Half an ulp of 1, 2^-53.
pub(super) const U: f64 = 1.0 / 9_007_199_254_740_992.0;

/// A value and a bound on its error.
#[derive(Clone, Copy)]
pub(super) struct Bounded {
    pub value: f64,
    pub error: f64,
}

impl Bounded {
    fn sign(self) -> Option<Sign> {
        if self.value > self.error {
            Some(Sign::Positive)
        } else if self.value < -self.error {
            Some(Sign::Negative)
        } else {
            None
        }
    }
}

fn between(from: Vec3, to: Vec3) -> [f64; 3] {
    let difference = |to: f32, from: f32| f64::from(to) - f64::from(from);
    [difference(to.x, from.x), difference(to.y, from.y), difference(to.z, from.z)]
}

fn determinant(x: &[f64; 3], y: &[f64; 3], z: &[f64; 3]) -> Bounded {
    let (p0, q0) = (y[1] * z[2], y[2] * z[1]);
    let (p1, q1) = (y[2] * z[0], y[0] * z[2]);
    let (p2, q2) = (y[0] * z[1], y[1] * z[0]);
    let value = x[0] * (p0 - q0) + x[1] * (p1 - q1) + x[2] * (p2 - q2);
    let scale =
        x[0].abs() * (p0.abs() + q0.abs()) + x[1].abs() * (p1.abs() + q1.abs()) + x[2].abs() * (p2.abs() + q2.abs());
    Bounded { value, error: scale * (16.0 * U) }
}

/// By how much the area has to exceed its error: what is divided by the area's least value is then hardly more than by its own.
pub(super) const SURE: f64 = 16.0;

/// 1 / (1 - 1 / [`SURE`]), and what is rounded.
pub(super) const WIDER: f64 = 1.08;

/// The least and the greatest parameter at which the ray may cross the plane, of its edge functions and the volume before the
/// triangle; none if next to nothing is known.
///
/// With the errors `e` of the volume `V` and `f` of the area `A`, the quotient is off by `(e + f |V / A|) / (|A| - f)` at most. Roundings
/// keep order, so the parameter is the number that both are where they have the same bits.
#[inline(always)]
pub(super) fn range([u, v, w]: [Bounded; 3], volume: Bounded) -> Option<[f32; 2]> {
    let area = u.value + v.value + w.value;
    let area_error = (u.error + v.error + w.error) * 1.01;
    let inverse = 1.0 / area;
    let quotient = volume.value * inverse;
    let error = (volume.error + quotient.abs() * area_error) * (inverse.abs() * WIDER) + quotient.abs() * (8.0 * U);
    let range = [(quotient - error) as f32, (quotient + error) as f32];
    (area.abs() > SURE * area_error).then_some(range)
}

pub(super) fn test(triangle: &Triangle, ray: &PreparedRay, front: Option<bool>) -> Option<Crossing> {
    let origin = ray.ray().origin;
    let d = ray.ray().direction.to_array().map(f64::from);
    let (a, b, c) = (between(origin, triangle.a), between(origin, triangle.b), between(origin, triangle.c));
    let (u, v, w) = (determinant(&d, &b, &c), determinant(&d, &c, &a), determinant(&d, &a, &b));
    let front = match front {
        Some(front) => front,
        None => facing(triangle, ray, [u, v, w])?,
    };

    let t = match range([u, v, w], determinant(&a, &b, &c)) {
        Some([low, high]) if low.to_bits() == high.to_bits() => low,
        _ => exact::parameter(triangle, ray),
    };
    t.is_finite().then_some(Crossing { t, front })
}

/// From which side the ray hits, if it does.
fn facing(triangle: &Triangle, ray: &PreparedRay, edges: [Bounded; 3]) -> Option<bool> {
    let proven = edges.map(Bounded::sign);
    if proven.contains(&Some(Sign::Positive)) && proven.contains(&Some(Sign::Negative)) {
        return None;
    }
    agreement(exact::signs(triangle, ray, proven)).map(|sign| sign == Sign::Negative)
}
