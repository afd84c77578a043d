//! Pictures for small displays, strip by strip: the scene by hitscan, the label by embedded-graphics.

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    pixelcolor::{BinaryColor, Rgb565},
    prelude::*,
    text::Text,
};
use hitscan::{
    display::{Packed, Strip},
    glam::Vec3,
    render::{Camera, Caster, Channels, Light, Ordered, Renderer},
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
    draw(scene, COLOR, sky, Rgb565::CSS_ORANGE, show)
}

/// Lets `show` have the strips of the picture in black and white.
///
/// # Errors
///
/// Those of `show`.
pub fn binary<S: Caster, E>(scene: &S, show: impl FnMut(&[BinaryColor]) -> Result<(), E>) -> Result<(), E> {
    draw(scene, BINARY, [Vec3::ZERO; 2], BinaryColor::On, show)
}

/// Draws a picture of `size` before a `sky`, dithered, with a label in `ink`.
fn draw<S: Caster, C: Channels + PixelColor + Packed<Color = C>, E>(
    scene: &S,
    size: Size,
    sky: [Vec3; 2],
    ink: C,
    mut show: impl FnMut(&[C]) -> Result<(), E>,
) -> Result<(), E> {
    let lights = [Light::directional(Vec3::new(0.4, -1.0, 0.8), Vec3::ONE)];
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.2, 0.3, -1.0), Vec3::Y);
    let renderer = Renderer::new(scene, camera, size.width, size.height).with_lights(&lights);
    let renderer = renderer.with_background(sky[0], sky[1]);
    let mut pixels = [ink; (COLOR.width * ROWS) as usize];
    for tile in renderer.tiles(size.width, ROWS) {
        let strip = &mut pixels[..tile.area()];
        strip.iter_mut().zip(renderer.dithered(tile, Ordered)).for_each(|(pixel, color)| *pixel = color);
        let label = Text::new("hitscan", Point::new(2, 8), MonoTextStyle::new(&FONT_6X10, ink));
        // Nothing can fail that is Infallible.
        let Ok(_) = label.draw(&mut Strip::new(tile, strip));
        show(strip)?;
    }
    Ok(())
}
