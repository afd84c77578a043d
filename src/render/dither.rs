use glam::Vec3;

use super::{
    Channels,
    levels::{Levels, ONE},
};

/// How light becomes the colours of a display that has too few of them.
///
/// [`Nearest`] takes each pixel for itself. [`Ordered`] and [`Diffusion`] count in linear light, so that from afar a picture
/// is as bright as it was: in the mean over an area, not in every pixel. They count in integers, without a power function:
/// on a chip they are quicker than the nearest colour.
pub trait Dither {
    /// The colour for the light at a pixel, column and row.
    fn color<C: Channels>(&mut self, pixel: (u32, u32), light: Vec3) -> C;
}

impl<D: Dither> Dither for &mut D {
    fn color<C: Channels>(&mut self, pixel: (u32, u32), light: Vec3) -> C {
        (**self).color(pixel, light)
    }
}

/// No dithering: the nearest colour.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

impl Dither for Nearest {
    fn color<C: Channels>(&mut self, _: (u32, u32), light: Vec3) -> C {
        C::from_linear(light)
    }
}

/// Ordered dithering: a pixel is compared with its place in a pattern of 8 x 8 thresholds.
///
/// Without state: the same colours whatever the tiles and their order. Bayer, *An optimum method for two-level
/// rendition of continuous-tone pictures*, 1973.
///
/// ```
/// use hitscan::{glam::Vec3, render::{Dither, Ordered}};
/// let lit = (0..64).filter(|i| Ordered.color::<u8>((i % 8, i / 8), Vec3::splat(0.21723)) == 129).count();
/// assert_eq!(lit, 24); // the others are 128
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Ordered;

impl Dither for Ordered {
    fn color<C: Channels>(&mut self, (x, y): (u32, u32), light: Vec3) -> C {
        let threshold = 2 * bayer(x, y) + 1;
        C::from_channels(light, |_, light, levels| {
            let light = units(light);
            let [(level, below), (next, above)] = levels.around(light);
            if (light - below) * 128 > threshold * (above - below) { next } else { level }
        })
    }
}

/// Error diffusion: what a pixel is too bright, its neighbours to the right and below are darker.
///
/// Holds the errors of one line, 2 bytes a channel and column; what columns beyond the line owe goes to the right only.
/// The colours are the same for tiles of whole rows from the top, however many rows each. Tiles of other shapes give
/// other colours, and light that comes to columns already done is lost, as it is at the lower edge. Start each
/// picture with a new one or [`restart`](Self::restart).
///
/// Floyd and Steinberg, *An adaptive algorithm for spatial greyscale*, 1976, with the weights of Fan, *A simple
/// modification of error diffusion weights*, 1992: 7/16 go to the right, 5/16 below, 3/16 and 1/16 to the left of that.
/// These need no row from right to left, which a display would not take, to be free of worms.
///
/// ```
/// use hitscan::{glam::Vec3, render::{Diffusion, Dither}};
/// let mut errors = [0; 256];
/// let mut diffusion = Diffusion::new(&mut errors);
/// let mut sum = 0;
/// for y in 0..64 {
///     sum += (0..256).map(|x| u32::from(diffusion.color::<u8>((x, y), Vec3::splat(0.2172)))).sum::<u32>();
/// }
/// let mean = sum as f32 / (64.0 * 256.0);
/// assert!((mean - 128.375).abs() < 0.01); // the levels 128 and 129
/// ```
#[derive(Debug)]
pub struct Diffusion<'a> {
    /// What the row above left to each column, channel by channel; before the last pixel, what its own row did.
    line: &'a mut [i16],
    /// What the last pixel leaves to the next one, for each channel.
    right: [i32; 3],
    /// The last pixel and its channels.
    last: Option<(u32, u32, usize)>,
}

impl<'a> Diffusion<'a> {
    /// Starts a picture; `line` has a number for each column and [channel](Channels::CHANNELS), and is made zero.
    #[must_use]
    pub fn new(line: &'a mut [i16]) -> Self {
        line.fill(0);
        Self { line, right: [0; 3], last: None }
    }

    /// Forgets all errors, to start another picture.
    pub fn restart(&mut self) {
        self.line.fill(0);
        (self.right, self.last) = ([0; 3], None);
    }

    /// Adds an error to a column, if the line has it.
    fn owe(&mut self, place: usize, error: i32) -> bool {
        let place = self.line.get_mut(place);
        let found = place.is_some();
        if let Some(place) = place {
            *place = (i32::from(*place) + error).clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        }
        found
    }

    /// At the end of a row: what would go to the right goes below.
    fn end_row(&mut self) {
        if let Some((x, _, channels)) = self.last.take() {
            for channel in 0..channels.min(3) {
                let error = take(&mut self.right, channel);
                self.owe(place(x, channels, channel), error);
            }
        }
    }

    /// The level of a channel of a pixel, whose error goes on.
    fn level(&mut self, (x, channels): (u32, usize), channel: usize, light: f32, levels: Levels) -> u8 {
        let here = place(x, channels, channel);
        let above = self.line.get_mut(here).map_or(0, |place| core::mem::take(place).into());
        let wanted = units(light) + above + take(&mut self.right, channel);
        let [low, high] = levels.around(wanted.clamp(0, ONE));
        let (level, got) = if 2 * wanted > low.1 + high.1 { high } else { low };
        let error = wanted - got;
        // Each place below has its part, or leaves it to the next, the last to the right: nothing is lost by rounding.
        let (right, far, left) = ((error * 7) >> 4, error >> 4, (error * 3) >> 4);
        let mut rest = error - right - far - left;
        for (back, part) in [(2, far), (1, left)] {
            let owed = here.checked_sub(back * channels).is_some_and(|place| self.owe(place, part));
            rest += if owed { 0 } else { part };
        }
        rest = if self.owe(here, rest) { 0 } else { rest };
        if let Some(place) = self.right.get_mut(channel) {
            *place = right + rest;
        }
        level
    }
}

impl Dither for Diffusion<'_> {
    fn color<C: Channels>(&mut self, (x, y): (u32, u32), light: Vec3) -> C {
        let follows = |(before, row, _): (u32, u32, usize)| (before.checked_add(1), row) == (Some(x), y);
        if !self.last.is_some_and(follows) {
            self.end_row();
        }
        self.last = Some((x, y, C::CHANNELS));
        C::from_channels(light, |channel, light, levels| self.level((x, C::CHANNELS), channel, light, levels))
    }
}

/// Where a column's channel is in the line.
fn place(x: u32, channels: usize, channel: usize) -> usize {
    (x as usize).saturating_mul(channels).saturating_add(channel)
}

fn take(errors: &mut [i32; 3], channel: usize) -> i32 {
    errors.get_mut(channel).map_or(0, core::mem::take)
}

/// Light from 0 to 1 in integers; what is out of range is clamped, NaN is black.
fn units(light: f32) -> i32 {
    ((light * ONE as f32 + 0.5) as i32).clamp(0, ONE)
}

/// The place of a pixel in the 8 x 8 pattern in which any 4^n consecutive places are spread evenly: 0 to 63.
const fn bayer(x: u32, y: u32) -> i32 {
    let (mixed, mut place, mut bit) = (x ^ y, 0, 0);
    while bit < 3 {
        place = place << 2 | (mixed >> bit & 1) << 1 | y >> bit & 1;
        bit += 1;
    }
    place as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pattern_is_bayers() {
        let row = |y: u32| core::array::from_fn(|x| bayer(x as u32, y));
        assert_eq!(row(0), [0, 32, 8, 40, 2, 34, 10, 42]);
        assert_eq!(row(1), [48, 16, 56, 24, 50, 18, 58, 26]);
        assert_eq!(row(7), [63, 31, 55, 23, 61, 29, 53, 21]);
        assert_eq!(row(8), row(0));
    }

    #[test]
    fn any_number_has_its_units() {
        for (light, expected) in [
            (f32::NAN, 0),
            (f32::NEG_INFINITY, 0),
            (-1.0, 0),
            (0.5, ONE / 2),
            (1.0, ONE),
            (7.0, ONE),
            (f32::INFINITY, ONE),
        ] {
            assert_eq!(units(light), expected, "{light}");
        }
    }
}
