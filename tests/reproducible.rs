//! The same bits everywhere: `.ci/run` has this test run on 32 and on 64 bits and at several levels of optimisation.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use std::cell::Cell;

use common::{Random, adversarial_mesh, adversarial_ray, coordinate, meshes, plans};
use hitscan::{
    CompactKdTree, DualSplit, Hit, LatticeMesh, LatticeScene, List, Mesh, Ray, Scene,
    accel::{self, LatticeAccelerator, Plan, Structure},
    bake, dualsplit,
    geometry::{Aabb, Bounding, BoundingVolume, Transform, Volume},
    glam::{Mat3, Vec3},
    kdtree, primitives,
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

/// Sums of the words of structures over larger scenes; and of hits, and the nodes and primitives that were looked at for them.
fn work() -> [u32; 2] {
    let [mut words, mut counts] = [(); 2].map(|()| Sum(0x811c_9dc5));
    let (nodes, tests) = (Cell::new(0), Cell::new(0));
    let mut random = Random::new(78);
    for (vertices, triangles) in [
        meshes::sheet(20),
        meshes::random(1000, 0.2),
        meshes::fan(150),
        meshes::hair(100),
        meshes::crossing(80),
        meshes::identical(50),
    ] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for (_, plan) in plans::presets() {
            let built = bake::build(&mesh, &plan).unwrap();
            built.iter().for_each(|&word| words.add(word));
            let structure = Structure::open(plan.kind().unwrap(), &built).unwrap();
            let scene =
                Scene::new(accel::Counted::new(structure, &nodes), primitives::Counted::new(mesh, &tests)).unwrap();
            let near = Scene::new(accel::Counted::new(structure, &nodes), mesh).unwrap();
            for _ in 0..40 {
                let ray = adversarial_ray(&mut random, 2, &vertices);
                counts.hit(scene.closest_hit(&ray));
                counts.add(u32::from(scene.any_hit(&ray)));
                counts.add(u32::from(near.nearest_point(ray.origin, 1.0).is_some()));
                counts.add(nodes.take() as u32);
                counts.add(tests.take() as u32);
            }
        }
    }
    [words, counts].map(|sum| sum.0)
}

/// A sum of hits in whole numbers.
fn whole() -> u32 {
    fn cast<A: LatticeAccelerator>(sum: &mut Sum, random: &mut Random, accelerator: A, mesh: &LatticeMesh<'_>) {
        let scene = LatticeScene::new(accelerator, mesh).unwrap();
        let corners: Vec<Vec3> = mesh.positions().collect();
        for _ in 0..200 {
            let from = Vec3::from_array([0; 3].map(|_| random.unit() * 6.0 - 2.0));
            let to = random.pick(&corners).lerp(random.pick(&corners), random.pick(&[0.0, 0.3, 0.5]));
            let ray = Ray::new(from, to - from).starting_at(random.pick(&[0.0, 0.25, -3.0]));
            sum.hit(scene.closest_hit(&ray));
            sum.add(u32::from(scene.any_hit(&ray)));
        }
        for ray in scene.space().rays(Vec3::splat(-1.0), Vec3::new(1.0, 1.5, 0.5), Vec3::new(0.002, -0.01, 0.01), 100) {
            sum.hit(ray.and_then(|ray| scene.closest_hit_along(&ray)));
        }
    }
    let mut sum = Sum(0x811c_9dc5);
    let mut random = Random::new(79);
    let frame = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 2.0, 1.5));
    for most in [3, 40, 1000, 65_535] {
        let triangles: Vec<[u32; 3]> = (0..60).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let vertices: Vec<[u16; 3]> = (0..180).map(|_| [0; 3].map(|_| random.below(most) as u16)).collect();
        let mesh = LatticeMesh::new(&frame, &vertices, &triangles[..]).unwrap();
        cast(&mut sum, &mut random, List::new(&mesh).unwrap(), &mesh);
        let words = bake::build(&mesh, &Plan::CompactKdTree(kdtree::Options::balanced())).unwrap();
        cast(&mut sum, &mut random, CompactKdTree::open(&words).unwrap(), &mesh);
        let words = bake::build(&mesh, &Plan::DualSplit(dualsplit::Options::balanced())).unwrap();
        cast(&mut sum, &mut random, DualSplit::open(&words).unwrap(), &mesh);
    }
    sum.0
}

/// A sum of bounding volumes, and of which rays they let through.
fn volumes() -> u32 {
    let mut sum = Sum(0x811c_9dc5);
    let mut random = Random::new(80);
    for round in 0..200 {
        let family = [0, 1, 2, 3, 5, 6, 10][round % 7];
        let (vertices, _) = adversarial_mesh(&mut random, family, 10);
        for kind in Bounding::ALL {
            let Some(volume) = kind.around(vertices.iter().copied()) else { continue };
            match volume {
                BoundingVolume::Aabb(Aabb { min, max }) => [min, max].into_iter().for_each(|v| sum.vector(v)),
                BoundingVolume::Sphere(sphere) => sum.vector(sphere.center + sphere.radius),
                BoundingVolume::Obb(obb) => {
                    obb.axes.to_cols_array().into_iter().for_each(|x| sum.float(x));
                    [obb.center, obb.half_size].into_iter().for_each(|v| sum.vector(v));
                    sum.float(obb.half_area());
                    sum.add(u32::from(obb.contains(vertices[0].lerp(obb.center, 0.5))));
                }
            }
            sum.float(volume.volume() as f32);
            for _ in 0..10 {
                let Some(ray) = adversarial_ray(&mut random, family, &vertices).prepare() else { continue };
                sum.add(u32::from(volume.may_meet(&ray, ray.ray().t_max)));
            }
        }
    }
    sum.0
}

#[test]
fn every_bit_is_the_one_it_always_was() {
    assert_eq!(sums(), SUMS);
}

#[test]
fn whole_numbers_are_the_ones_they_always_were() {
    assert_eq!(whole(), WHOLE);
}

#[test]
fn volumes_are_the_ones_they_always_were() {
    assert_eq!(volumes(), VOLUMES);
}

#[test]
fn no_ray_looks_at_more_or_less_than_it_always_did() {
    assert_eq!(work(), WORK);
}

/// They change when a preset, a format or the scenes of the tests do; never with a target or an option of the compiler.
const SUMS: [u32; 6] = [2_917_528_811, 650_369_513, 784_017_893, 4_130_982_804, 2_361_513_966, 566_133_907];
const WORK: [u32; 2] = [1_716_336_971, 3_340_775_257];
const WHOLE: u32 = 796_013_519;
const VOLUMES: u32 = 3_621_350_008;
