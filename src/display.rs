//! Displays (feature `graphics`): pictures for any `embedded_graphics` target, without a framebuffer.
//!
//! [`draw`] hands a picture to a display tile by tile. For text and shapes over it without overdraw, fill a buffer with a
//! tile, draw on it as a [`Strip`] and send it.

use core::convert::Infallible;

use embedded_graphics_core::{
    Pixel,
    draw_target::DrawTarget,
    geometry::{Dimensions, Point, Size},
    pixelcolor::{
        Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, GrayColor, PixelColor, Rgb555, Rgb565,
        Rgb666, Rgb888, RgbColor, raw::ToBytes,
    },
    prelude::IntoStorage,
    primitives::Rectangle,
};
use glam::Vec3;

use crate::render::{Caster, Channels, Color, Dither, Levels, Renderer, Tile, encode, luminance};

/// `Color` and `Channels` for colours of red, green and blue, of which each has its levels.
macro_rules! rgb {
    ($($color:ident $red:ident $green:ident $blue:ident;)*) => {$(
        /// sRGB.
        impl Color for $color {
            fn from_linear(rgb: Vec3) -> Self {
                let level = |light, most: u8| encode(light, most.into()) as u8;
                Self::new(level(rgb.x, Self::MAX_R), level(rgb.y, Self::MAX_G), level(rgb.z, Self::MAX_B))
            }
        }

        /// sRGB.
        impl Channels for $color {
            const CHANNELS: usize = 3;

            fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
                let (red, green) = (choose(0, rgb.x, Levels::$red), choose(1, rgb.y, Levels::$green));
                Self::new(red, green, choose(2, rgb.z, Levels::$blue))
            }
        }
    )*};
}

rgb! {
    Rgb555 BITS_5 BITS_5 BITS_5;
    Rgb565 BITS_5 BITS_6 BITS_5;
    Rgb666 BITS_6 BITS_6 BITS_6;
    Rgb888 BITS_8 BITS_8 BITS_8;
    Bgr555 BITS_5 BITS_5 BITS_5;
    Bgr565 BITS_5 BITS_6 BITS_5;
    Bgr666 BITS_6 BITS_6 BITS_6;
    Bgr888 BITS_8 BITS_8 BITS_8;
}

/// `Color` and `Channels` for colours of luminance.
macro_rules! gray {
    ($($color:ident $levels:ident $most:literal $make:expr;)*) => {$(
        /// sRGB luminance.
        impl Color for $color {
            fn from_linear(rgb: Vec3) -> Self {
                $make(encode(luminance(rgb), $most) as u8)
            }
        }

        /// sRGB luminance.
        impl Channels for $color {
            const CHANNELS: usize = 1;

            fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
                $make(choose(0, luminance(rgb), Levels::$levels))
            }
        }
    )*};
}

gray! {
    Gray8 BITS_8 255.0 Self::new;
    Gray4 BITS_4 15.0 Self::new;
    Gray2 BITS_2 3.0 Self::new;
    BinaryColor BITS_1 1.0 |level| Self::from(level > 0);
}

/// Draws the picture with its upper left corner at `at`, in tiles of at most `tile` pixels.
///
/// Each tile is one `fill_contiguous`, whose colours are computed while the display takes them.
///
/// ```
/// use embedded_graphics_core::{draw_target::DrawTarget, geometry::Point, pixelcolor::BinaryColor};
/// use hitscan::{display, render::{Caster, Diffusion, Renderer}};
///
/// /// Shows a picture of at most 128 columns in black and white.
/// fn show<S: Caster, D: DrawTarget<Color = BinaryColor>>(picture: &Renderer<'_, S>, screen: &mut D) -> Result<(), D::Error> {
///     display::draw(picture, screen, Point::zero(), (128, 8), Diffusion::new(&mut [0; 128]))
/// }
/// ```
///
/// # Errors
///
/// Those of the display.
pub fn draw<S, D>(
    renderer: &Renderer<'_, S>,
    target: &mut D,
    at: Point,
    tile: (u32, u32),
    mut dither: impl Dither,
) -> Result<(), D::Error>
where
    S: Caster + ?Sized,
    D: DrawTarget,
    D::Color: Channels,
{
    for tile in renderer.tiles(tile.0, tile.1) {
        let corner = Point::new(at.x.saturating_add_unsigned(tile.x), at.y.saturating_add_unsigned(tile.y));
        let area = Rectangle::new(corner, Size::new(tile.width, tile.height));
        target.fill_contiguous(&area, renderer.dithered(tile, &mut dither))?;
    }
    Ok(())
}

/// A pixel in memory, of a display whose colours are `Shown`.
pub trait Stored: Copy {
    /// The display's colour.
    type Shown: PixelColor;

    /// That colour in memory.
    fn stored(color: Self::Shown) -> Self;
}

/// `Stored` for pixels in memory of displays' colours.
macro_rules! stored {
    ($($pixel:ty: $color:ident by $stored:expr;)*) => {$(
        impl Stored for $pixel {
            type Shown = $color;

            fn stored(color: $color) -> Self {
                $stored(color)
            }
        }
    )*};
}

stored! {
    u16: Rgb565 by IntoStorage::into_storage;
    [u8; 2]: Rgb565 by ToBytes::to_be_bytes;
    [u8; 3]: Rgb888 by ToBytes::to_be_bytes;
    u8: Gray8 by |color: Gray8| color.luma();
    Rgb565: Rgb565 by |color| color;
    Rgb888: Rgb888 by |color| color;
    Gray8: Gray8 by |color| color;
    Gray4: Gray4 by |color| color;
    Gray2: Gray2 by |color| color;
    BinaryColor: BinaryColor by |color| color;
}

/// The pixels of a tile, to draw on in the picture's coordinates before they are sent; what is outside is not drawn.
///
/// ```
/// use embedded_graphics_core::{draw_target::DrawTarget, geometry::{Point, Size}, pixelcolor::{Rgb565, RgbColor}, primitives::Rectangle};
/// use hitscan::{display::Strip, render::Tile};
///
/// let mut pixels = [[0_u8; 2]; 240 * 8]; // the rows from 16 to 23, big-endian
/// let mut strip = Strip::new(Tile { x: 0, y: 16, width: 240, height: 8 }, &mut pixels);
/// strip.fill_solid(&Rectangle::new(Point::new(1, 15), Size::new(2, 2)), Rgb565::RED)?;
/// assert_eq!(pixels[..4], [[0, 0], [0xf8, 0], [0xf8, 0], [0, 0]]);
/// assert_eq!(pixels[240..], [[0, 0]; 240 * 7]);
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Debug)]
pub struct Strip<'a, P> {
    tile: Tile,
    pixels: &'a mut [P],
}

impl<'a, P: Stored> Strip<'a, P> {
    /// The tile whose pixels are the first of `pixels`, row by row; what does not fit is not drawn.
    #[must_use]
    pub const fn new(tile: Tile, pixels: &'a mut [P]) -> Self {
        Self { tile, pixels }
    }

    /// Where the pixel at a point is.
    fn place(&mut self, point: Point) -> Option<&mut P> {
        let x = u32::try_from(point.x).ok()?.checked_sub(self.tile.x)?;
        let y = u32::try_from(point.y).ok()?.checked_sub(self.tile.y)?;
        let inside = x < self.tile.width && y < self.tile.height;
        let place = (y as usize).checked_mul(self.tile.width as usize)?.checked_add(x as usize)?;
        self.pixels.get_mut(place).filter(|_| inside)
    }
}

impl<P: Stored> Dimensions for Strip<'_, P> {
    fn bounding_box(&self) -> Rectangle {
        let clamped = |coordinate: u32| i32::try_from(coordinate).unwrap_or(i32::MAX);
        let corner = Point::new(clamped(self.tile.x), clamped(self.tile.y));
        Rectangle::new(corner, Size::new(self.tile.width, self.tile.height))
    }
}

impl<P: Stored> DrawTarget for Strip<'_, P> {
    type Color = P::Shown;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<P::Shown>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            if let Some(place) = self.place(point) {
                *place = P::stored(color);
            }
        }
        Ok(())
    }
}
