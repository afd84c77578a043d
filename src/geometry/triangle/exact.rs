//! The last tier: determinants of `f32` numbers without rounding, after Kulisch's long accumulator.
//!
//! `d . ((p - o) x (q - o)) = det(d, p, q) - det(d, p, o) + det(d, q, o)` is a sum of 18 products of three floats. Each is
//! a 72-bit integer times a power of two and is added into 864 bits, the least of which weighs 2^-447: nothing
//! overflows, nothing underflows, and no wider floats are needed.

use glam::Vec3;

use super::{Sign, Triangle};
use crate::geometry::PreparedRay;

/// 864 bits: from 2^-447 (three denormals) to beyond the sum of products of three numbers below 2^128.
const WORDS: usize = 27;

/// The weight of the lowest bit is 2^-LOWEST.
const LOWEST: i32 = 447;

/// A sum of products, in two's complement, least word first.
#[derive(Clone, Copy)]
struct Accumulator([u32; WORDS]);

/// Significand and biased exponent: `x = ± m * 2^(e - 149)`.
fn decode(x: f32) -> (u32, u32) {
    let bits = x.to_bits();
    let (exponent, fraction) = (bits >> 23 & 255, bits & 0x7f_ffff);
    if exponent == 0 { (fraction, 0) } else { (fraction | 0x80_0000, exponent - 1) }
}

impl Accumulator {
    const ZERO: Self = Self([0; WORDS]);

    /// Adds `x * y * z`.
    #[inline(never)]
    fn add(&mut self, x: f32, y: f32, z: f32) {
        let ((m1, e1), (m2, e2), (m3, e3)) = (decode(x), decode(y), decode(z));
        let m12 = u64::from(m1) * u64::from(m2);
        if m12 == 0 || m3 == 0 {
            return;
        }
        // The 72-bit significand in three words of 32 bits, shifted into four.
        let low = (m12 & 0xffff_ffff) * u64::from(m3);
        let high = (m12 >> 32) * u64::from(m3) + (low >> 32);
        let exponent = e1 + e2 + e3;
        let (first, shift) = ((exponent >> 5) as usize, exponent & 31);
        let p0 = (low & 0xffff_ffff) << shift;
        let p1 = (high & 0xffff_ffff) << shift;
        let p2 = (high >> 32) << shift;
        let words = [p0 as u32, p1 as u32 | (p0 >> 32) as u32, p2 as u32 | (p1 >> 32) as u32, (p2 >> 32) as u32];

        let negative = (x.to_bits() ^ y.to_bits() ^ z.to_bits()) >> 31 != 0;
        let mut carry = 0_i64;
        for (i, word) in self.0.iter_mut().skip(first).enumerate() {
            let term = i64::from(words.get(i).copied().unwrap_or(0));
            carry += i64::from(*word) + if negative { -term } else { term };
            *word = carry as u32;
            carry >>= 32;
            if i >= 3 && carry == 0 {
                break;
            }
        }
    }

    /// Adds `det(x, y, z)`.
    #[inline(never)]
    fn add_determinant(&mut self, x: Vec3, y: Vec3, z: Vec3) {
        for (p, q, r) in [(y.y, z.z, x.x), (y.z, z.x, x.y), (y.x, z.y, x.z)] {
            self.add(p, q, r);
        }
        for (p, q, r) in [(y.z, z.y, x.x), (y.x, z.z, x.y), (y.y, z.x, x.z)] {
            self.add(-p, q, r);
        }
    }

    fn sign(&self) -> Sign {
        if self.0[WORDS - 1] >> 31 != 0 {
            Sign::Negative
        } else if self.0.iter().all(|&word| word == 0) {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    /// What a quotient of two sums needs of one; `None` of zero.
    fn leading(mut self) -> Option<Leading> {
        let negative = self.sign() == Sign::Negative;
        if negative {
            let mut carry = 1_u64;
            for word in &mut self.0 {
                carry += u64::from(!*word);
                *word = carry as u32;
                carry >>= 32;
            }
        }
        let top = self.0.iter().rposition(|&word| word != 0)?;
        let word = |below: usize| top.checked_sub(below).and_then(|i| self.0.get(i)).copied().unwrap_or(0);
        let (high, middle, low) = (word(0), word(1), word(2));
        let zeros = high.leading_zeros();
        let mut bits = u64::from(high) << 32 | u64::from(middle);
        if zeros > 0 {
            bits = bits << zeros | u64::from(low >> (32 - zeros));
        }
        Some(Leading { negative, bits, weight: (top as i32 - 1) * 32 - zeros as i32 - LOWEST })
    }
}

/// A number's sign, its magnitude's 64 highest bits, cut off, and the weight of the lowest of them.
struct Leading {
    negative: bool,
    bits: u64,
    weight: i32,
}

/// The leading bits of what `add` adds up. Out of line, so that one accumulator at a time is on the stack.
#[inline(never)]
fn leading(add: impl FnOnce(&mut Accumulator)) -> Option<Leading> {
    let mut sum = Accumulator::ZERO;
    add(&mut sum);
    sum.leading()
}

/// The sign of `d . ((p - o) x (q - o))`.
#[inline(never)]
pub(super) fn edge(ray: &PreparedRay, p: Vec3, q: Vec3) -> Sign {
    let (o, d) = (ray.ray().origin, ray.ray().direction);
    let mut sum = Accumulator::ZERO;
    sum.add_determinant(d, p, q);
    sum.add_determinant(d, o, p);
    sum.add_determinant(d, q, o);
    sum.sign()
}

/// The signs of the edge functions opposite `a`, `b` and `c`; those proven already are taken as they are.
pub(super) fn signs(triangle: &Triangle, ray: &PreparedRay, proven: [Option<Sign>; 3]) -> [Sign; 3] {
    let Triangle { a, b, c } = *triangle;
    let [u, v, w] = proven;
    [(u, b, c), (v, c, a), (w, a, b)].map(|(sign, p, q)| sign.unwrap_or_else(|| edge(ray, p, q)))
}

/// The parameter of the plane, rounded to nearest even; infinite where it exceeds `f32`.
#[inline(never)]
pub(super) fn parameter(triangle: &Triangle, ray: &PreparedRay) -> f32 {
    let volume = leading(|sum| {
        let (&Triangle { a, b, c }, o) = (triangle, -ray.ray().origin);
        sum.add_determinant(a, b, c);
        sum.add_determinant(o, b, c);
        sum.add_determinant(a, o, c);
        sum.add_determinant(a, b, o);
    });
    let Some(volume) = volume else { return 0.0 };
    let area = leading(|sum| {
        let (&Triangle { a, b, c }, d) = (triangle, ray.ray().direction);
        sum.add_determinant(d, a, b);
        sum.add_determinant(d, b, c);
        sum.add_determinant(d, c, a);
    });
    let Some(area) = area else { return f32::INFINITY };

    // Long division: 33 bits of quotient are more than a float and its guard; the rest is sticky.
    let (mut quotient, mut rest) = (0_u64, volume.bits);
    if rest >= area.bits {
        (quotient, rest) = (1, rest - area.bits);
    }
    for _ in 0..32 {
        let carry = rest >> 63 != 0;
        rest <<= 1;
        quotient <<= 1;
        if carry || rest >= area.bits {
            rest = rest.wrapping_sub(area.bits);
            quotient |= 1;
        }
    }
    let sticky = u64::from(rest != 0);
    round(volume.negative != area.negative, quotient << 1 | sticky, volume.weight - area.weight - 33)
}

/// `± m * 2^e` rounded to nearest even, `m` not 0 and its lowest bit sticky.
fn round(negative: bool, m: u64, e: i32) -> f32 {
    let sign = u32::from(negative) << 31;
    let exponent = 63 - m.leading_zeros() as i32 + e;
    if exponent > 127 {
        return f32::from_bits(sign | 0x7f80_0000);
    }
    let last = if exponent < -126 { -149 } else { exponent - 23 };
    let shift = last - e;
    let significand = if shift <= 0 {
        m << (-shift).min(63)
    } else if shift > 60 {
        0
    } else {
        let (kept, rest, half) = (m >> shift, m & ((1 << shift) - 1), 1 << (shift - 1));
        kept + u64::from(rest > half || (rest == half && kept & 1 == 1))
    };
    // A carry out of the significand moves into the exponent, as it should.
    let bits = if exponent < -126 {
        significand as u32
    } else {
        (((exponent + 127) as u32) << 23).wrapping_add(significand as u32).wrapping_sub(0x80_0000)
    };
    f32::from_bits(sign | bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(products: &[[f32; 3]]) -> Accumulator {
        let mut total = Accumulator::ZERO;
        products.iter().for_each(|p| total.add(p[0], p[1], p[2]));
        total
    }

    #[test]
    fn sums_cancel_without_rest() {
        let (big, least) = (f32::MAX, f32::from_bits(1));
        let total = sum(&[[big, big, big], [least, least, least], [-big, big, big]]);
        assert!(total.sign() == Sign::Positive);
        assert!(sum(&[[least, least, least], [-least, least, least]]).sign() == Sign::Zero);
        assert!(sum(&[[big; 3], [-big, big, big], [least, -least, least]]).sign() == Sign::Negative);
    }

    #[test]
    fn leading_bits_have_their_weight() {
        for [x, y, z] in [[3.0, 5.0, 7.0], [-1.5, 1.0e20, 1.0e-30], [1.0e-40, 2.0, 3.0_f32]] {
            let Leading { bits, weight, .. } = sum(&[[x, y, z]]).leading().unwrap();
            let exact = (f64::from(x) * f64::from(y) * f64::from(z)).abs();
            let got = bits as f64 * 2.0_f64.powi(weight);
            assert!((got / exact - 1.0).abs() < 1.0e-15, "{got} {exact}");
        }
    }

    #[test]
    fn rounding_is_to_nearest_even() {
        assert_eq!(round(false, 1, 0), 1.0);
        assert_eq!(round(true, 3, -1), -1.5);
        assert_eq!(round(false, (1 << 25) + 2, 0), (1 << 25) as f32);
        assert_eq!(round(false, (1 << 25) + 3, 0), ((1 << 25) + 4) as f32);
        assert_eq!(round(false, (1 << 25) + 6, 0), ((1 << 25) + 8) as f32);
        assert_eq!(round(false, 1, 128), f32::INFINITY);
        assert_eq!(round(false, 1, -149), f32::from_bits(1));
        assert_eq!(round(false, 1, -151), 0.0);
        assert_eq!(round(false, (1 << 24) - 1, 105), f32::INFINITY);
    }
}
