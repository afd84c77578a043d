use glam::Vec3;

use super::{Color, Levels, color::luminance};

/// A colour made of channels of few levels: all that dithering has to know about a display.
///
/// A display of 2 bits a channel:
///
/// ```
/// use hitscan::{glam::Vec3, render::{Channels, Color, Dither, Levels, Ordered}};
///
/// #[derive(Clone, Copy)]
/// struct Rgb222(u8);
///
/// impl Color for Rgb222 {
///     fn from_linear(rgb: Vec3) -> Self {
///         let [r, g, b] = <[u8; 3]>::from_linear(rgb);
///         Self(r >> 6 << 4 | g >> 6 << 2 | b >> 6)
///     }
/// }
///
/// impl Channels for Rgb222 {
///     const CHANNELS: usize = 3;
///
///     fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
///         let mut level = |channel, light| choose(channel, light, Levels::BITS_2);
///         Self(level(0, rgb.x) << 4 | level(1, rgb.y) << 2 | level(2, rgb.z))
///     }
/// }
///
/// assert_eq!(Ordered.color::<Rgb222>((0, 0), Vec3::new(0.0, 0.5, 1.0)).0, 0b00_11_11);
/// assert_eq!(Ordered.color::<Rgb222>((1, 0), Vec3::new(0.0, 0.5, 1.0)).0, 0b00_10_11);
/// ```
pub trait Channels: Color {
    /// How many they are, at most 3.
    const CHANNELS: usize;

    /// The colour of the levels that `choose` gives for each channel's number from 0, its light and its levels.
    fn from_channels(rgb: Vec3, choose: impl FnMut(usize, f32, Levels) -> u8) -> Self;
}

/// sRGB, 8 bits each.
impl Channels for [u8; 3] {
    const CHANNELS: usize = 3;

    fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
        let mut level = |channel, light| choose(channel, light, Levels::BITS_8);
        [level(0, rgb.x), level(1, rgb.y), level(2, rgb.z)]
    }
}

/// sRGB in RGB565: red in the upper 5 bits.
impl Channels for u16 {
    const CHANNELS: usize = 3;

    fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
        let (red, green) = (choose(0, rgb.x, Levels::BITS_5), choose(1, rgb.y, Levels::BITS_6));
        Self::from(red) << 11 | Self::from(green) << 5 | Self::from(choose(2, rgb.z, Levels::BITS_5))
    }
}

/// sRGB in RGB565, the upper byte first.
impl Channels for [u8; 2] {
    const CHANNELS: usize = 3;

    fn from_channels(rgb: Vec3, choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
        u16::from_channels(rgb, choose).to_be_bytes()
    }
}

/// sRGB luminance.
impl Channels for u8 {
    const CHANNELS: usize = 1;

    fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
        choose(0, luminance(rgb), Levels::BITS_8)
    }
}
