use glam::Vec3;

use crate::math;

/// What a picture can be made of: anything that linear red, green and blue from 0 to 1 turn into.
///
/// ```
/// use hitscan::{glam::Vec3, render::Color};
/// assert_eq!(<[u8; 3]>::from_linear(Vec3::new(1.0, 0.214, 0.0)), [255, 127, 0]);
/// assert_eq!(u16::from_linear(Vec3::ONE), 0xffff);
/// ```
pub trait Color: Copy {
    /// The nearest colour; what is out of range is clamped.
    fn from_linear(rgb: Vec3) -> Self;
}

/// As it is, for pictures that are worked on.
impl Color for Vec3 {
    fn from_linear(rgb: Vec3) -> Self {
        rgb
    }
}

/// sRGB, 8 bits each.
impl Color for [u8; 3] {
    fn from_linear(rgb: Vec3) -> Self {
        rgb.to_array().map(|x| encode(x, 255.0) as u8)
    }
}

/// sRGB in RGB565: red in the upper 5 bits.
impl Color for u16 {
    fn from_linear(rgb: Vec3) -> Self {
        let (r, g, b) = (encode(rgb.x, 31.0), encode(rgb.y, 63.0), encode(rgb.z, 31.0));
        (r as Self) << 11 | (g as Self) << 5 | b as Self
    }
}

/// sRGB in RGB565, the upper byte first, as displays take it: `as_flattened` makes one slice of bytes of many.
impl Color for [u8; 2] {
    fn from_linear(rgb: Vec3) -> Self {
        u16::from_linear(rgb).to_be_bytes()
    }
}

/// sRGB luminance.
impl Color for u8 {
    fn from_linear(rgb: Vec3) -> Self {
        encode(luminance(rgb), 255.0) as Self
    }
}

/// The luminance of linear light, by ITU-R BT.709.
pub(crate) fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// Linear light as sRGB (IEC 61966-2-1), 0 to `most`, rounded.
pub(crate) fn encode(x: f32, most: f32) -> f32 {
    let encoded = if x > 0.003_130_8 { 1.055 * math::pow(x, 1.0 / 2.4) - 0.055 } else { 12.92 * x };
    // Written so that NaN becomes black.
    let clamped = if encoded > 0.0 { encoded.min(1.0) } else { 0.0 };
    math::floor(clamped * most + 0.5)
}
