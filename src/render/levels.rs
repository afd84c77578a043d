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

    /// The linear light of a level, 0 to 1; none of one that is not there.
    ///
    /// ```
    /// use hitscan::{glam::Vec3, render::{Color, Levels}};
    /// assert_eq!(Levels::BITS_8.light(255), 1.0);
    /// assert_eq!(<[u8; 3]>::from_linear(Vec3::splat(Levels::BITS_8.light(188))), [188; 3]);
    /// ```
    #[must_use]
    pub fn light(self, level: u8) -> f32 {
        self.0.get(usize::from(level)).map_or(0.0, |&light| f32::from(light)) * (1.0 / ONE as f32)
    }

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

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::{render::color::encode, testing::every};

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
            for light in (0..ONE).step_by(every(1)) {
                let [(level, below), (next, above)] = levels.around(light);
                assert!(below <= light && light < above && next == level + 1);
                assert_eq!(levels.around(below)[0].0, level);
            }
            let last = ((levels.0.len() - 1) as u8, ONE);
            assert_eq!(levels.around(ONE), [last; 2]);
        }
    }
}
