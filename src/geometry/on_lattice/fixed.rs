//! Floats as integers, by their bits: where there is no floating point, a tenth of its instructions.

/// `mantissa` · 2^`exponent`: 0, or a mantissa of 2^30 … 2^31 in magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scaled {
    pub(super) mantissa: i32,
    pub(super) exponent: i32,
}

impl Scaled {
    /// The exponent of 0, below all others.
    const NONE: i32 = i32::MIN / 4;

    /// A finite float; what is denormal is 0.
    #[inline]
    pub(super) const fn new(x: f32) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 23 & 0xff) as i32;
        if exponent == 0 {
            return Self { mantissa: 0, exponent: Self::NONE };
        }
        let magnitude = ((bits & 0x7f_ffff | 0x80_0000) << 7) as i32;
        Self { mantissa: if bits >> 31 != 0 { -magnitude } else { magnitude }, exponent: exponent - 157 }
    }

    /// The product, of 28 bits or more in magnitude: for sums.
    #[inline]
    pub(super) const fn roughly_times(self, factor: Self) -> Self {
        // The exponent of 0 stays below all others.
        Self { mantissa: high(self.mantissa, factor.mantissa), exponent: self.exponent + factor.exponent + 32 }
    }

    /// The product with what is positive, cut to 30 bits.
    #[inline]
    pub(super) const fn times(self, factor: Self) -> Self {
        let product = high(self.mantissa, factor.mantissa);
        let exponent = self.exponent + factor.exponent + 32;
        let small = product.unsigned_abs() < 1 << 29;
        if small {
            Self { mantissa: product << 2, exponent: exponent - 2 }
        } else {
            Self { mantissa: product << 1, exponent: exponent - 1 }
        }
    }

    /// The number in units of 2^`unit`, rounded down; what does not fit becomes the nearest that does.
    #[inline]
    pub(super) const fn in_units(self, unit: i32) -> i32 {
        shifted(self.mantissa, self.exponent - unit)
    }
}

/// `x` · 2^-`by`, rounded down, for `by` ≥ 0: a fraction of [`shifted`].
#[inline(always)]
pub(super) const fn cut(x: i32, by: i32) -> i32 {
    x >> if by > 31 { 31 } else { by }
}

/// `x` · 2^`by`, rounded down; what does not fit becomes the nearest that does.
#[inline]
pub(super) const fn shifted(x: i32, by: i32) -> i32 {
    if by <= 0 {
        return cut(x, -by);
    }
    if by < 32 {
        let moved = x << by;
        if moved >> by == x {
            return moved;
        }
    } else if x == 0 {
        return 0;
    }
    if x < 0 { -i32::MAX } else { i32::MAX }
}

/// The upper half of a product.
#[inline]
pub(super) const fn high(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

/// 2^61 / `x` to 28 bits, for 2^30 ≤ `x` < 2^31.
///
/// One step of Newton's method, from a quotient of 16 bits.
#[inline]
pub(super) const fn reciprocal(x: i32) -> i32 {
    let x = x as u32;
    // In 2^16 … 2^17, 2^-15 off at most. The divisor is 2^15 … 2^16.
    let guess = u32::MAX / if x < 1 << 30 { 1 << 15 } else { x >> 15 };
    // x · guess is 2^47 or almost.
    let product = (x as u64 * guess as u64) >> 16;
    let refined = (guess as u64 * (0x1_0000_0000 - product)) >> 17;
    if refined > i32::MAX as u64 { i32::MAX } else { refined as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::every;

    /// 2 to the power of `exponent`, exactly.
    fn power(exponent: i32) -> f64 {
        f64::from_bits(u64::from((exponent.max(-1000) + 1023) as u32) << 52)
    }

    fn value(x: Scaled) -> f64 {
        f64::from(x.mantissa) * power(x.exponent)
    }

    #[test]
    fn floats_are_taken_apart_and_multiplied() {
        for bits in (0..0x7f80_0000).step_by(every(99_991)) {
            let x = f32::from_bits(bits);
            for x in [x, -x] {
                let scaled = Scaled::new(x);
                assert_eq!(value(scaled), if x.is_normal() { f64::from(x) } else { 0.0 });
                for factor in [1.0, 1.999, 3.0e-9, 65_535.0] {
                    let product = scaled.times(Scaled::new(factor));
                    let exact = value(scaled) * f64::from(factor);
                    assert!((value(product) - exact).abs() <= exact.abs() * power(-28), "{x} {factor}");
                    assert!(product.mantissa == 0 || product.mantissa.unsigned_abs() >= 1 << 30, "{product:?}");
                }
                let floor = (f64::from(x) * 256.0).floor().clamp(-f64::from(i32::MAX), f64::from(i32::MAX));
                if x.is_normal() {
                    assert_eq!(f64::from(scaled.in_units(-8)), floor, "{x}");
                }
            }
        }
    }

    #[test]
    fn reciprocals_have_28_bits() {
        for x in (1 << 30..=i32::MAX as u32).step_by(every(3331)) {
            let exact = power(61) / f64::from(x);
            assert!((f64::from(reciprocal(x as i32)) - exact).abs() < exact * power(-28), "{x}");
        }
    }
}
