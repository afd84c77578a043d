//! Displays (feature `graphics`): pictures for any `embedded_graphics` target, without a framebuffer.
//!
//! [`draw`] hands a picture to a display tile by tile. For text and shapes over it without overdraw, fill a buffer with a
//! tile, draw on it as a [`Strip`] and send it.

mod strip;

use embedded_graphics_core::{
    draw_target::DrawTarget,
    geometry::{Point, Size},
    pixelcolor::{
        Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, Rgb555, Rgb565, Rgb666, Rgb888, RgbColor,
    },
    primitives::Rectangle,
};
use glam::Vec3;

pub use self::strip::{Packed, Strip};

use crate::render::{Caster, Channels, Color, Dither, Levels, Renderer, encode, luminance};

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
/// Each tile is one `fill_contiguous`, whose colours are computed while the display takes them and chosen by `dither`:
/// [`Nearest`](crate::render::Nearest) for displays of many colours, [`Ordered`](crate::render::Ordered) for few colours
/// and tiles of any shape, [`Diffusion`](crate::render::Diffusion), with a memory of one line, for tiles of whole rows.
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
