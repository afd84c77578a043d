//! A handheld's screen: the picture strip by strip, text and shapes over each strip before it is sent.

use std::error::Error;

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    prelude::*,
    primitives::{PrimitiveStyle, Rectangle, RoundedRectangle},
    text::{Alignment, Text},
};
use embedded_graphics_simulator::SimulatorDisplay;
use hitscan::{
    display::{Packed, Strip},
    render::{Channels, Dither},
};

use crate::model::Picture;

/// Rows that are in memory at once.
const ROWS: u32 = 8;

/// Shows the picture with `title` over it, in `ink` on `paper`.
pub fn show<C>(
    picture: &Picture<'_>,
    mut dither: impl Dither,
    title: &str,
    [ink, paper]: [C; 2],
) -> Result<SimulatorDisplay<C>, Box<dyn Error>>
where
    C: Channels + PixelColor + Packed<Color = C>,
{
    let size = Size::new(picture.width(), picture.height());
    let mut display = SimulatorDisplay::with_default_color(size, paper);
    let mut pixels = vec![paper; (size.width * ROWS) as usize];
    for tile in picture.tiles(size.width, ROWS) {
        picture.fill_dithered(tile, &mut pixels, &mut dither)?;
        let mut strip = Strip::new(tile, &mut pixels);
        let area = strip.bounding_box();
        let Ok(()) = draw_over(&mut strip, size, title, [ink, paper]);
        let Ok(()) = display.fill_contiguous(&area, pixels.iter().copied());
    }
    Ok(display)
}

/// A title and a battery: drawn whole over every strip, which takes of it what it holds.
fn draw_over<D: DrawTarget>(
    target: &mut D,
    size: Size,
    title: &str,
    [ink, paper]: [D::Color; 2],
) -> Result<(), D::Error> {
    let text = MonoTextStyle::new(&FONT_6X10, ink);
    let plate = Size::new(title.len() as u32 * 6 + 8, 13);
    let rounded = |corner, size| RoundedRectangle::with_equal_corners(Rectangle::new(corner, size), Size::new(3, 3));
    rounded(Point::new(3, 3), plate).into_styled(PrimitiveStyle::with_fill(paper)).draw(target)?;
    Text::with_alignment(title, Point::new(7, 12), text, Alignment::Left).draw(target)?;

    let corner = Point::new(size.width as i32 - 26, 3);
    rounded(corner, Size::new(23, 13)).into_styled(PrimitiveStyle::with_fill(paper)).draw(target)?;
    Rectangle::new(corner + Point::new(3, 3), Size::new(15, 7))
        .into_styled(PrimitiveStyle::with_stroke(ink, 1))
        .draw(target)?;
    for part in [(Point::new(5, 5), Size::new(8, 3)), (Point::new(18, 5), Size::new(2, 3))] {
        Rectangle::new(corner + part.0, part.1).into_styled(PrimitiveStyle::with_fill(ink)).draw(target)?;
    }
    Ok(())
}
