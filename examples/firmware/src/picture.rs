//! Pictures for small displays, strip by strip: the scene by hitscan, the label by embedded-graphics.

use core::convert::Infallible;

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    pixelcolor::{BinaryColor, Rgb565},
    prelude::*,
    primitives::Rectangle,
    text::Text,
};
use hitscan::{
    glam::Vec3,
    render::{Camera, Caster, Color, Light, Renderer},
};

/// The colour picture, as large as an SSD1331 display.
pub const COLOR: Size = Size::new(96, 64);

/// The picture in black and white.
pub const BINARY: Size = Size::new(64, 32);

/// Rows of a strip: all the picture that is ever in memory.
const ROWS: u32 = 8;

/// Lets `show` have the strips of the colour picture, from the top.
///
/// # Errors
///
/// Those of `show`.
pub fn color<S: Caster, E>(scene: &S, show: impl FnMut(&[Rgb565]) -> Result<(), E>) -> Result<(), E> {
    let sky = [Vec3::splat(0.8), Vec3::new(0.25, 0.4, 0.7)];
    draw(scene, COLOR, sky, Rgb565::CSS_ORANGE, |_, light| Rgb565::from_linear(light), show)
}

/// Lets `show` have the strips of the picture in black and white, dithered.
///
/// Bayer, *An optimum method for two-level rendition of continuous-tone pictures*, 1973.
///
/// # Errors
///
/// Those of `show`.
pub fn binary<S: Caster, E>(scene: &S, show: impl FnMut(&[BinaryColor]) -> Result<(), E>) -> Result<(), E> {
    const THRESHOLDS: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    let dithered = |(x, y): (u32, u32), light: Vec3| {
        let threshold = THRESHOLDS[y as usize % 4][x as usize % 4];
        // Green is most of what is seen.
        BinaryColor::from(light.y * 16.0 > f32::from(threshold) + 0.5)
    };
    draw(scene, BINARY, [Vec3::ZERO; 2], BinaryColor::On, dithered, show)
}

/// Draws a picture of `size` before a `sky`, of what `color` makes of the light at a pixel, with a label in `ink`.
fn draw<S: Caster, C: PixelColor, E>(
    scene: &S,
    size: Size,
    sky: [Vec3; 2],
    ink: C,
    color: impl Fn((u32, u32), Vec3) -> C,
    mut show: impl FnMut(&[C]) -> Result<(), E>,
) -> Result<(), E> {
    let lights = [Light::directional(Vec3::new(0.4, -1.0, 0.8), Vec3::ONE)];
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.2, 0.3, -1.0), Vec3::Y);
    let renderer = Renderer::new(scene, camera, size.width, size.height).with_lights(&lights);
    let renderer = renderer.with_background(sky[0], sky[1]);
    let mut pixels = [ink; (COLOR.width * ROWS) as usize];
    for tile in renderer.tiles(size.width, ROWS) {
        let area = Rectangle::new(Point::new(0, tile.y as i32), Size::new(tile.width, tile.height));
        let mut strip = Strip { area, pixels: &mut pixels[..tile.area()] };
        let light = renderer.colors(tile).zip(tile.pixels()).map(|(light, pixel)| color(pixel, light));
        // Nothing can fail that is Infallible.
        let Ok(()) = strip.fill_contiguous(&area, light);
        let Ok(_) = Text::new("hitscan", Point::new(2, 8), MonoTextStyle::new(&FONT_6X10, ink)).draw(&mut strip);
        show(strip.pixels)?;
    }
    Ok(())
}

/// Some rows of a picture.
struct Strip<'a, C> {
    area: Rectangle,
    pixels: &'a mut [C],
}

impl<C> Dimensions for Strip<'_, C> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<C: PixelColor> DrawTarget for Strip<'_, C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels.into_iter().filter(|pixel| self.area.contains(pixel.0)) {
            let place = point - self.area.top_left;
            self.pixels[(place.y as u32 * self.area.size.width + place.x as u32) as usize] = color;
        }
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(&mut self, area: &Rectangle, colors: I) -> Result<(), Infallible> {
        if *area == self.area {
            self.pixels.iter_mut().zip(colors).for_each(|(place, color)| *place = color);
            return Ok(());
        }
        self.draw_iter(area.points().zip(colors).map(|(point, color)| Pixel(point, color)))
    }
}
