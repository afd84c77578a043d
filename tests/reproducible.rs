//! The same bits everywhere: `.ci/run` has this test run on 32 and on 64 bits and at several levels of optimisation.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{Random, adversarial_mesh, adversarial_ray, coordinate, plans};
use hitscan::{
    Hit, List, Mesh, Scene,
    accel::Structure,
    bake,
    geometry::Transform,
    glam::{Mat3, Vec3},
    render::{Camera, Light, Renderer, Tile},
};

/// FNV-1a of words.
struct Sum(u32);

impl Sum {
    fn add(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }

    fn hit(&mut self, hit: Option<Hit>) {
        self.add(hit.map_or(u32::MAX, |hit| hit.primitive));
        self.float(hit.map_or(0.0, |hit| hit.t));
    }

    fn float(&mut self, x: f32) {
        // The bits of a NaN are not promised.
        self.add(if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() });
    }

    fn vector(&mut self, v: Vec3) {
        v.to_array().into_iter().for_each(|x| self.float(x));
    }
}

/// Sums of: words of structures, hits, surfaces and secondary rays, nearest points, transforms, pictures.
fn sums() -> [u32; 6] {
    let mut sums = [(); 6].map(|()| Sum(0x811c_9dc5));
    let [words, hits, surfaces, nearest, transforms, pictures] = &mut sums;
    let mut random = Random::new(77);
    for round in 0..66 {
        // Without family 7, whose coordinates are powers of ten.
        let family = [0, 1, 2, 3, 4, 5, 6, 8, 9, 10][round % 10];
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let presets = plans::presets();
        let (_, plan) = &presets[round % presets.len()];
        let built = bake::build(&mesh, plan).unwrap();
        built.iter().for_each(|&word| words.add(word));
        let scene = Scene::new(Structure::open(plan.kind().unwrap(), &built).unwrap(), &mesh).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        for _ in 0..100 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let hit = scene.closest_hit(&ray);
            hits.hit(hit);
            list.hits(&ray).for_each(|hit| hits.hit(Some(hit)));
            if let Some(hit) = hit {
                let surface = scene.surface(&ray, &hit);
                surfaces.vector(surface.geometric_normal);
                surfaces.vector(surface.start_towards(surface.normal_towards_ray()));
                surfaces.add(u32::from(surface.front));
            }
            if let Some(found) = scene.nearest_point(ray.origin, f32::MAX) {
                nearest.vector(found.point);
                nearest.float(found.distance);
            }
        }
        let numbers = [(); 9].map(|()| coordinate(&mut random, 2));
        if let Ok(transform) = Transform::new(Mat3::from_cols_array(&numbers), vertices[0]) {
            vertices.iter().for_each(|&v| transforms.vector(transform.inverse().point(v)));
        }
        let lights = [Light::point(Vec3::new(3.0, 4.0, 5.0), Vec3::ONE)];
        let camera = Camera::framing(&scene.bounds(), Vec3::new(1.0, 2.0, 3.0), Vec3::Y);
        let renderer = Renderer::new(&scene, camera, 16, 12).with_lights(&lights).with_bounces(1);
        let mut pixels = [[0_u8; 3]; 16 * 12];
        renderer.fill(Tile { x: 0, y: 0, width: 16, height: 12 }, &mut pixels).unwrap();
        pixels.iter().for_each(|&[r, g, b]| pictures.add(u32::from_le_bytes([r, g, b, 0])));
    }
    sums.map(|sum| sum.0)
}

#[test]
fn every_bit_is_the_one_it_always_was() {
    assert_eq!(sums(), SUMS);
}

/// They change when a preset, a format or the scenes of the tests do; never with a target or an option of the compiler.
const SUMS: [u32; 6] = [4_056_374_089, 650_369_513, 784_017_893, 4_130_982_804, 2_361_513_966, 566_133_907];
