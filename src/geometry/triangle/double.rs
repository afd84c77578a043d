//! The second tier where doubles are slow: pairs of `f32`, after Dekker 1971 and Knuth, without FMA.

use glam::Vec3;

use super::{Crossing, Sign, Triangle, agreement, exact};
use crate::geometry::PreparedRay;

/// The unevaluated sum of two floats: about 48 bits.
#[derive(Clone, Copy)]
struct Double {
    high: f32,
    low: f32,
}

#[inline(always)]
fn two_sum(a: f32, b: f32) -> Double {
    let high = a + b;
    let t = high - a;
    Double { high, low: (a - (high - t)) + (b - t) }
}

#[inline(always)]
fn fast_two_sum(a: f32, b: f32) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// Halves of 12 bits each, whose products are exact.
#[inline(always)]
fn halves(a: f32) -> (f32, f32) {
    let c = 4097.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

#[inline(always)]
fn two_product(a: f32, b: f32) -> Double {
    let high = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    Double { high, low: ((ah * bh - high) + ah * bl + al * bh) + al * bl }
}

// Out of line: these are called dozens of times on a cold path, and flash is dear.
#[inline(never)]
fn product(a: Double, b: Double) -> Double {
    let p = two_product(a.high, b.high);
    fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high))
}

#[inline(never)]
fn sum(a: Double, b: Double) -> Double {
    let (s, t) = (two_sum(a.high, b.high), two_sum(a.low, b.low));
    let s = fast_two_sum(s.high, s.low + t.high);
    fast_two_sum(s.high, s.low + t.low)
}

#[inline(always)]
fn difference(a: Double, b: Double) -> Double {
    sum(a, Double { high: -b.high, low: -b.low })
}

fn between(from: Vec3, to: Vec3) -> [Double; 3] {
    [two_sum(to.x, -from.x), two_sum(to.y, -from.y), two_sum(to.z, -from.z)]
}

/// `x . (y x z)` and a bound on its error, 2^-41 of the magnitudes added.
fn determinant(x: &[Double; 3], y: &[Double; 3], z: &[Double; 3]) -> (Double, f32) {
    let mut total = Double { high: 0.0, low: 0.0 };
    let mut scale = 0.0;
    let (&[x0, x1, x2], &[y0, y1, y2], &[z0, z1, z2]) = (x, y, z);
    for (x, y, z) in [(x0, [y1, y2], [z1, z2]), (x1, [y2, y0], [z2, z0]), (x2, [y0, y1], [z0, z1])] {
        let (p, q) = (product(y[0], z[1]), product(y[1], z[0]));
        total = sum(total, product(x, difference(p, q)));
        scale += x.high.abs() * (p.high.abs() + q.high.abs());
    }
    (total, scale * (1.0 / 2_199_023_255_552.0))
}

// In steps that each give their stack back before the next: the exact ones need it.
pub(super) fn test(triangle: &Triangle, ray: &PreparedRay, front: Option<bool>) -> Option<Crossing> {
    let front = match front {
        Some(front) => front,
        None => facing(triangle, ray)?,
    };
    let t = quotient(triangle, ray).unwrap_or_else(|| exact::parameter(triangle, ray));
    t.is_finite().then_some(Crossing { t, front })
}

/// From which side the ray hits, if it does.
fn facing(triangle: &Triangle, ray: &PreparedRay) -> Option<bool> {
    let proven = signs(triangle, ray);
    if proven.contains(&Some(Sign::Positive)) && proven.contains(&Some(Sign::Negative)) {
        return None;
    }
    agreement(exact::signs(triangle, ray, proven)).map(|sign| sign == Sign::Negative)
}

fn direction(ray: &PreparedRay) -> [Double; 3] {
    ray.ray().direction.to_array().map(|x| Double { high: x, low: 0.0 })
}

/// The signs of the edge functions that 48 bits decide.
#[inline(never)]
fn signs(triangle: &Triangle, ray: &PreparedRay) -> [Option<Sign>; 3] {
    let (origin, d) = (ray.ray().origin, direction(ray));
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|corner| between(origin, corner));
    [(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| {
        let (value, error) = determinant(&d, p, q);
        let error = error + 1.0e-34;
        if !(error < 1.0e30) {
            None
        } else if value.high > error {
            Some(Sign::Positive)
        } else if value.high < -error {
            Some(Sign::Negative)
        } else {
            None
        }
    })
}

/// The correctly rounded parameter `a . N / d . N`, if 48 bits decide it.
#[inline(never)]
fn quotient(triangle: &Triangle, ray: &PreparedRay) -> Option<f32> {
    let (a, d) = (between(ray.ray().origin, triangle.a), direction(ray));
    let (e1, e2) = (between(triangle.a, triangle.b), between(triangle.a, triangle.c));
    let (n, n_error) = determinant(&a, &e1, &e2);
    let (m, m_error) = determinant(&d, &e1, &e2);
    let (numerator, denominator) = (n.high.abs(), m.high.abs());
    let t = n.high / m.high;
    let rest = difference(n, product(Double { high: t, low: 0.0 }, m));
    let correction = rest.high / m.high;
    let error = (n_error / denominator + t.abs() * (m_error / denominator)) * 1.01 + correction.abs() * 1.0e-6;
    let (low, high) = (t + (correction - error), t + (correction + error));
    let in_range = |x: f32| x > 1.0e-28 && x < 1.0e30;
    (low == high && in_range(numerator) && in_range(denominator) && m_error * 64.0 < denominator).then_some(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Ray, testing::Random};

    #[test]
    fn most_rays_are_decided() {
        let mut random = Random::new(5);
        let (mut rays, mut sides, mut parameters) = (0, 0, 0);
        for round in 0..1000 {
            let length = [1.0e-8, 1.0e-3, 1.0, 1.0e3, 1.0e8][round % 5];
            let mut point = || Vec3::from_array([0; 3].map(|_| (random.unit() * 2.0 - 1.0) * length));
            let (triangle, origin) = (Triangle::new(point(), point(), point()), point());
            let inside = (triangle.a + triangle.b + triangle.c) / 3.0;
            let Some(ray) = Ray::new(origin, (inside - origin) / length).prepare() else { continue };
            rays += 1;
            sides += u32::from(signs(&triangle, &ray).iter().all(Option::is_some));
            parameters += u32::from(quotient(&triangle, &ray).is_some());
        }
        assert!(rays > 900 && sides > rays * 99 / 100 && parameters > rays * 9 / 10, "{rays} {sides} {parameters}");
    }

    #[test]
    fn products_and_sums_are_exact_to_48_bits() {
        let (a, b) = (1.0 + f32::EPSILON, 3.0 - f32::EPSILON);
        let p = two_product(a, b);
        assert_eq!(f64::from(p.high) + f64::from(p.low), f64::from(a) * f64::from(b));
        let s = two_sum(1.0e8, 1.0e-3);
        assert_eq!(f64::from(s.high) + f64::from(s.low), 1.0e8 + f64::from(1.0e-3_f32));
    }
}
