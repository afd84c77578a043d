use glam::Vec3;

use super::{Color, color::luminance};

/// Full light of a channel, in the units that dithering counts in.
pub(super) const ONE: i32 = 1 << 15;

/// What the levels of a channel of a display shine like: linear light, of which one is 2^15.
///
/// The levels are evenly spaced in sRGB (IEC 61966-2-1); the tables are made by the compiler, 2 bytes a level.
#[derive(Clone, Copy, Debug)]
pub struct Levels(&'static [u16]);

impl Levels {
    /// Black and white.
    pub const BITS_1: Self = Self(BITS_1);
    /// Four levels.
    pub const BITS_2: Self = Self(BITS_2);
    /// Sixteen levels.
    pub const BITS_4: Self = Self(BITS_4);
    /// 32 levels.
    pub const BITS_5: Self = Self(BITS_5);
    /// 64 levels.
    pub const BITS_6: Self = Self(BITS_6);
    /// 256 levels.
    pub const BITS_8: Self = Self(BITS_8);

    /// The brightest level not above `light` and the next, each with its light; twice the same for the last.
    pub(super) fn around(self, light: i32) -> [(u8, i32); 2] {
        let above = self.0.partition_point(|&level| i32::from(level) <= light);
        let last = self.0.len().saturating_sub(1);
        let both = [above.saturating_sub(1), above.min(last)];
        both.map(|level| (level as u8, self.0.get(level).map_or(ONE, |&light| i32::from(light))))
    }
}

const BITS_1: &[u16] = &linear::<2>();
const BITS_2: &[u16] = &linear::<4>();
const BITS_4: &[u16] = &linear::<16>();
const BITS_5: &[u16] = &linear::<32>();
const BITS_6: &[u16] = &linear::<64>();
const BITS_8: &[u16] = &linear::<256>();

/// The linear light of `N` levels.
const fn linear<const N: usize>() -> [u16; N] {
    let mut levels = [0; N];
    let mut level = 0;
    while level < N {
        levels[level] = (decoded(level as f64 / (N - 1) as f64) * ONE as f64 + 0.5) as u16;
        level += 1;
    }
    levels
}

/// sRGB as linear light.
const fn decoded(x: f64) -> f64 {
    if x <= 0.040_45 {
        return x / 12.92;
    }
    // x^2.4 is x^2 by the fifth root of x^2, which Newton's method finds from above.
    let base = (x + 0.055) / 1.055;
    let square = base * base;
    let mut root = 1.0;
    let mut step = 0;
    while step < 64 {
        let fourth = root * root * root * root;
        root -= (root * fourth - square) / (5.0 * fourth);
        step += 1;
    }
    square * root
}

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

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::render::color::encode;

    #[test]
    fn levels_are_those_that_the_nearest_colour_has() {
        for levels in [BITS_1, BITS_2, BITS_4, BITS_5, BITS_6, BITS_8] {
            let most = (levels.len() - 1) as f32;
            let encoded: Vec<f32> = levels.iter().map(|&light| encode(f32::from(light) / ONE as f32, most)).collect();
            assert!(encoded.iter().enumerate().all(|(level, &encoded)| encoded == level as f32), "{encoded:?}");
        }
    }

    #[test]
    fn light_is_between_the_levels_around_it() {
        for levels in [Levels::BITS_1, Levels::BITS_5, Levels::BITS_8] {
            for light in 0..ONE {
                let [(level, below), (next, above)] = levels.around(light);
                assert!(below <= light && light < above && next == level + 1);
                assert_eq!(levels.around(below)[0].0, level);
            }
            let last = ((levels.0.len() - 1) as u8, ONE);
            assert_eq!(levels.around(ONE), [last; 2]);
        }
    }
}
