//! Pictures, tile by tile, and what sensors see of the same scene.

use core::hint::black_box;

use embedded_graphics_core::{
    Pixel,
    draw_target::DrawTarget,
    geometry::{Dimensions, Point},
    pixelcolor::{BinaryColor, Gray4, Rgb565},
};
use hitscan::{
    List, Scene,
    display::{self, Packed, Strip},
    primitives::Spheres,
    render::{
        Camera, Caster, Channels, Diffusion, Dither, Filter, Interlaced, Light, Material, Materials, Nearest, Numbers,
        Ordered, Renderer, Terms, Texels, Texture, Textured, Textures, Tile, Wrap,
    },
};

use crate::{
    input::{aabb, float, some, sphere, vector, word},
    sensor,
};

/// Renders with every kind of camera, light and material.
pub fn all() {
    let mut balls = None;
    let Ok(spheres) = Spheres::new(some(sphere, &mut balls)) else { return };
    let Ok(scene) = List::new(&spheres).map(|list| Scene::new(list, spheres)) else { return };
    let Ok(scene) = scene else { return };
    let (mut lights, mut palette, mut narrow, mut wide) = (None, None, None, None);
    let lights = some(light, &mut lights);
    let numbers = match word() {
        0 => Numbers::First,
        1 => Numbers::Narrow(some(|| word() as u8, &mut narrow)),
        _ => Numbers::Wide(some(|| word() as u16, &mut wide)),
    };
    let materials = Materials::new(some(material, &mut palette), numbers);
    let renderer = Renderer::new(&scene, camera(), word(), word()).with_lights(lights).with_materials(materials);
    let renderer = renderer.with_bounces(word()).with_samples(word()).with_ambient(vector());
    let terms = Terms { shadows: word() == 0, specular: word() == 0, ..Terms::ALL };
    let renderer = renderer.with_terms(terms).with_background(vector(), vector());
    textured(&scene, materials);
    for tile in renderer.tiles(word(), word()).chain(renderer.scanlines()) {
        let mut pixels = [0_u16; 64];
        black_box(renderer.fill(tile, &mut pixels).is_ok());
        black_box(pixels);
        black_box(renderer.colors::<u16>(tile).last());
        black_box(renderer.fill_dithered(tile, &mut pixels, Ordered).is_ok());
        black_box((renderer.may_show(&tile, &aabb()), tile.area(), tile.parts(word(), word()).last()));
        black_box(renderer.patch(tile).pixel(word(), word()));
        black_box(renderer.refined(tile, &pixels, |a, b| a.abs_diff(*b) > 3).last());
    }
    let mut rough = renderer.progressive();
    black_box(rough.step(word(), |tile, color| _ = black_box((tile, color))));
    black_box(rough.next());
    let mut pixels = Interlaced::new(word(), word());
    black_box((pixels.next(), pixels.tile(), pixels.pass(), renderer.samples()));
    let tile = Tile { x: word(), y: word(), width: word(), height: word() };
    let camera = camera();
    black_box((camera.eye(), camera.forward(), camera.up(), camera.bundle(&tile, word(), word())));
    let light = light();
    black_box((light.color(), light.direction_from(vector()), light.shadow_ray(vector())));
    black_box(renderer.pixel(word(), word()));
    dithered(&renderer, Nearest);
    dithered(&renderer, Ordered);
    let mut errors = [0; 64];
    let mut diffusion = Diffusion::new(black_box(errors.as_mut_slice()));
    diffusion.restart();
    dithered(&renderer, diffusion);
    sensor::sees(&scene);
    #[cfg(feature = "objects")]
    sensor::sees(&scene as &dyn Caster);
}

/// A pixel of any scene, in a patch.
pub fn pixel<S: Caster>(scene: &S) {
    let renderer = Renderer::new(scene, camera(), word(), word()).with_bounces(word());
    let tile = Tile { x: word(), y: word(), width: word(), height: word() };
    black_box(renderer.patch(tile).pixel(word(), word()));
}

/// A texture of every kind, and a picture with it.
fn textured<S: Caster>(scene: &S, materials: Materials<'_>) {
    let (mut colors, mut bytes) = (None, None);
    let palette = some(|| word() as u16, &mut colors);
    let texels = match word() {
        0 => Texels::Rgb565(palette),
        1 => Texels::Palette8 { palette, texels: some(|| word() as u8, &mut bytes) },
        _ => Texels::Palette4 { palette, texels: some(|| word() as u8, &mut bytes) },
    };
    let Ok(texture) = Texture::new(word() as u16, word() as u16, texels) else { return };
    let wrap = if word() == 0 { Wrap::Repeat } else { Wrap::Clamp };
    let texture = texture.with_filter(if word() == 0 { Filter::Nearest } else { Filter::Bilinear }).with_wrap(wrap);
    black_box((texture.width(), texture.height(), texture.filter(), texture.wrap(), texture.texels()));
    let textures = [Some(texture)];
    let textures = black_box(Textures::new(&textures));
    black_box((textures.get(word()), materials.number(word())));
    black_box(
        Renderer::new(&Textured::new(scene, materials, textures), camera(), word(), word()).pixel(word(), word()),
    );
}

/// Pictures for displays of few colours, in memory and drawn.
fn dithered<S: Caster>(renderer: &Renderer<'_, S>, mut dither: impl Dither) {
    let pixels = [[0_u8; 2]; 64];
    let swap = |tile, pixels| if word() == 0 { Ok(pixels) } else { Err(tile) };
    black_box(renderer.stream((word(), word()), &mut dither, pixels, swap).is_ok());
    drawn::<u16, _>(renderer, &mut dither, 0);
    drawn::<Rgb565, _>(renderer, &mut dither, Rgb565::new(0, 0, 0));
    drawn::<Gray4, _>(renderer, &mut dither, Gray4::new(0));
    drawn::<BinaryColor, _>(renderer, &mut dither, BinaryColor::Off);
}

fn drawn<P: Packed<Color: Channels>, S: Caster>(renderer: &Renderer<'_, S>, dither: impl Dither, pixel: P) {
    let mut pixels = [pixel; 64];
    let tile = Tile { x: word(), y: word(), width: word(), height: word() };
    let mut strip = Strip::new(tile, black_box(pixels.as_mut_slice()));
    black_box(strip.bounding_box());
    black_box(strip.draw_iter(black_box(None::<Pixel<P::Color>>)).is_ok());
    let at = Point::new(word() as i32, word() as i32);
    black_box(display::draw(renderer, &mut strip, at, (word(), word()), dither).is_ok());
}

fn camera() -> Camera {
    match word() {
        0 => Camera::pinhole(vector(), vector(), vector(), float()),
        1 => Camera::orthographic(vector(), vector(), vector(), float()),
        _ => Camera::framing(&aabb(), vector(), vector()),
    }
}

fn light() -> Light {
    if word() == 0 { Light::point(vector(), vector()) } else { Light::directional(vector(), vector()) }
}

fn material() -> Material {
    Material::matte(vector()).with_highlights(float(), float()).with_reflectivity(float())
}
