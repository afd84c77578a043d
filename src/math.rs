//! The one door to `libm`: the same bits on every target.
//!
//! `core` has no square root and `std`'s transcendental functions differ between platforms, so every
//! function that is not one of `+ - * /` is called through here.

/// Square root, correctly rounded.
#[inline]
pub(crate) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Square root of a double, correctly rounded.
#[inline]
pub(crate) fn sqrt64(x: f64) -> f64 {
    libm::sqrt(x)
}

/// `x` to the power of `y`.
#[inline]
pub(crate) fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// Tangent of an angle in radians.
#[inline]
pub(crate) fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// Sine and cosine of an angle in radians.
#[inline]
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Largest integer not above `x`.
#[inline]
pub(crate) fn floor(x: f32) -> f32 {
    libm::floorf(x)
}

/// Logarithm to base 2.
#[inline]
pub(crate) fn log2(x: f32) -> f32 {
    libm::log2f(x)
}

/// The lesser of two numbers; the second where they do not compare.
///
/// `f32::min` calls `fminf` on Cortex-M4F (14 instructions against 4) because it treats NaN otherwise.
#[inline(always)]
pub(crate) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater of two numbers; the second where they do not compare.
#[inline(always)]
pub(crate) fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
