//! Floats to integers by their bits: a tenth of the instructions of a conversion where there is no floating point.

/// `x` in units of 2^-`fraction`, rounded towards 0; what does not fit becomes the nearest that does.
#[inline]
pub(super) const fn fixed(x: f32, fraction: i32) -> i32 {
    let bits = x.to_bits();
    let mantissa = (bits & 0x7f_ffff | 0x80_0000) as i32;
    let shift = (bits >> 23 & 0xff) as i32 - 150 + fraction;
    let magnitude = if shift > 7 {
        i32::MAX
    } else if shift >= 0 {
        mantissa << shift
    } else if shift > -25 {
        mantissa >> -shift
    } else {
        0
    };
    if bits >> 31 != 0 { -magnitude } else { magnitude }
}

/// The bits of the magnitude, which are ordered as the magnitudes are.
#[inline(always)]
pub(super) const fn magnitude(x: f32) -> u32 {
    x.to_bits() & 0x7fff_ffff
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_magnitudes_are_cut_or_saturate() {
        for bits in (0..=u32::MAX).step_by(9973) {
            let x = f32::from_bits(bits);
            for fraction in [0, 8, 15] {
                let exact = (f64::from(x) * f64::from(1 << fraction)).trunc();
                let most = f64::from(i32::MAX);
                if !x.is_nan() {
                    assert_eq!(f64::from(fixed(x, fraction)), exact.clamp(-most, most), "{x} {fraction}");
                }
            }
        }
    }
}
