use core::convert::Infallible;

use embedded_graphics_core::{
    Pixel,
    draw_target::DrawTarget,
    geometry::{Dimensions, Point, Size},
    pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, GrayColor, PixelColor, Rgb565, Rgb888, raw::ToBytes},
    prelude::IntoStorage,
    primitives::Rectangle,
};

use crate::render::Tile;

/// A pixel in memory, of a display whose colours are `Color`.
pub trait Packed: Copy {
    /// The display's colour.
    type Color: PixelColor;

    /// That colour in memory.
    fn packed(color: Self::Color) -> Self;
}

/// `Packed` for pixels in memory of displays' colours.
macro_rules! packed {
    ($($pixel:ty: $color:ident by $packed:expr;)*) => {$(
        impl Packed for $pixel {
            type Color = $color;

            fn packed(color: $color) -> Self {
                $packed(color)
            }
        }
    )*};
}

packed! {
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

impl<'a, P: Packed> Strip<'a, P> {
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

impl<P: Packed> Dimensions for Strip<'_, P> {
    fn bounding_box(&self) -> Rectangle {
        let clamped = |coordinate: u32| i32::try_from(coordinate).unwrap_or(i32::MAX);
        let corner = Point::new(clamped(self.tile.x), clamped(self.tile.y));
        Rectangle::new(corner, Size::new(self.tile.width, self.tile.height))
    }
}

impl<P: Packed> DrawTarget for Strip<'_, P> {
    type Color = P::Color;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<P::Color>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            if let Some(place) = self.place(point) {
                *place = P::packed(color);
            }
        }
        Ok(())
    }
}
