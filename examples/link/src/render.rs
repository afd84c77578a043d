//! Pictures, tile by tile, and what sensors see of the same scene.

use core::hint::black_box;

use hitscan::{
    List, Scene,
    primitives::Spheres,
    render::{Camera, Light, Material, Materials, Numbers, Renderer, Terms},
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
    for tile in renderer.tiles(word(), word()).chain(renderer.scanlines()) {
        let mut pixels = [0_u16; 64];
        black_box(renderer.fill(tile, &mut pixels).is_ok());
        black_box(pixels);
    }
    black_box(renderer.pixel(word(), word()));
    sensor::sees(&scene);
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
