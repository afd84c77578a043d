//! Displays (feature `graphics`): pictures for any `embedded_graphics` target, without a framebuffer.

use embedded_graphics_core::{
    draw_target::DrawTarget,
    geometry::{Point, Size},
    pixelcolor::{Gray8, Rgb565, Rgb888, raw::RawU16},
    primitives::Rectangle,
};
use glam::Vec3;

use crate::render::{Caster, Color, Renderer};

/// sRGB in 16 bits.
impl Color for Rgb565 {
    fn from_linear(rgb: Vec3) -> Self {
        Self::from(RawU16::new(u16::from_linear(rgb)))
    }
}

/// sRGB in 24 bits.
impl Color for Rgb888 {
    fn from_linear(rgb: Vec3) -> Self {
        let [r, g, b] = <[u8; 3]>::from_linear(rgb);
        Self::new(r, g, b)
    }
}

/// sRGB luminance in 8 bits.
impl Color for Gray8 {
    fn from_linear(rgb: Vec3) -> Self {
        Self::new(u8::from_linear(rgb))
    }
}

/// Draws the picture with its upper left corner at `at`, in tiles of at most `tile` pixels.
///
/// Each tile is one `fill_contiguous`, whose colours are computed while the display takes them.
///
/// ```
/// use embedded_graphics_core::{draw_target::DrawTarget, geometry::Point, pixelcolor::Rgb565};
/// use hitscan::{display, render::{Caster, Renderer}};
///
/// fn show<S: Caster, D: DrawTarget<Color = Rgb565>>(picture: &Renderer<'_, S>, screen: &mut D) -> Result<(), D::Error> {
///     display::draw(picture, screen, Point::zero(), (32, 16))
/// }
/// ```
///
/// # Errors
///
/// Those of the display.
pub fn draw<S, D>(renderer: &Renderer<'_, S>, target: &mut D, at: Point, tile: (u32, u32)) -> Result<(), D::Error>
where
    S: Caster + ?Sized,
    D: DrawTarget,
    D::Color: Color,
{
    for tile in renderer.tiles(tile.0, tile.1) {
        let corner = Point::new(at.x.saturating_add_unsigned(tile.x), at.y.saturating_add_unsigned(tile.y));
        let area = Rectangle::new(corner, Size::new(tile.width, tile.height));
        target.fill_contiguous(&area, renderer.colors(tile))?;
    }
    Ok(())
}
