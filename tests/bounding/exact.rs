//! Sums and products of `f32` as whole numbers, without rounding.

use std::ops::{Add, Mul, Sub};

/// Bits of a digit.
const BITS: u32 = 24;

/// A sum of digits times powers of 2^24, the least first; the unit depends on how many factors it is made of.
#[derive(Clone, Debug)]
pub struct Exact(Vec<i64>);

impl From<f32> for Exact {
    /// In units of 2^-149.
    fn from(x: f32) -> Self {
        let exponent = (x.to_bits() >> 23 & 0xff).max(1);
        let hidden = if x.abs() >= f32::MIN_POSITIVE { 1 << 23 } else { 0 };
        let mantissa = i64::from(x.to_bits() & 0x7f_ffff | hidden);
        let place = exponent - 1;
        let shifted = if x < 0.0 { -mantissa } else { mantissa } * (1_i64 << (place % BITS));
        let mut digits = vec![0; 12];
        digits[(place / BITS) as usize] = shifted % (1 << BITS);
        digits[(place / BITS) as usize + 1] = shifted / (1 << BITS);
        Self(digits)
    }
}

impl Exact {
    fn zip(self, other: Self, f: fn(i64, i64) -> i64) -> Self {
        assert_eq!(self.0.len(), other.0.len(), "of other units");
        Self(self.0.into_iter().zip(other.0).map(|(a, b)| f(a, b)).collect())
    }

    /// Whether it is below zero.
    pub fn is_negative(&self) -> bool {
        // Carried upward, so that all digits but the last are positive: the last one decides.
        self.0.iter().fold(0, |carry, digit| (carry + digit).div_euclid(1 << BITS)) < 0
    }
}

impl Add for Exact {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Exact {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Exact {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut digits = vec![0; self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                digits[i + j] += a * b;
            }
        }
        Self(digits)
    }
}

#[test]
fn exact_numbers_are() {
    let cases = [0.0, 1.0, -1.0, 0.1, 1.0e-45, -3.0e-39, f32::MAX, 1.5e20, f32::MIN_POSITIVE];
    for a in cases {
        for b in cases {
            assert_eq!((Exact::from(a) - Exact::from(b)).is_negative(), a < b, "{a} {b}");
            for c in cases.map(f64::from) {
                let product = Exact::from(a) * Exact::from(b) - Exact::from(c as f32) * Exact::from(1.0);
                assert_eq!(product.is_negative(), f64::from(a) * f64::from(b) < c, "{a} {b} {c}");
            }
        }
    }
}
