//! Tiles: rays that begin where those of their tile may find what they find from the beginning.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use std::{cell::Cell, collections::BTreeMap};

use common::{Random, adversarial_mesh, bits, coordinate, plans, point};
use hitscan::{
    DualSplit, Hit, LatticeScene, List, Mesh, Ray, Scene,
    accel::{Accelerator, Plan, Structure},
    asset::Kind,
    bake,
    geometry::{Aabb, Bundle, Pencil},
    glam::Vec3,
    primitives::{Primitives, Surface, from_fn},
    query::ItemBuffer,
    render::{Camera, Caster, Light, Renderer, Tile},
};

/// Cameras inside, near and far, along axes and not, with and without perspective, and some that see nothing.
fn camera(random: &mut Random, family: usize, vertices: &[Vec3]) -> Camera {
    let eye = match random.below(4) {
        0 => random.pick(vertices),
        1 => point(random, family),
        2 => point(random, family) * random.pick(&[1.0, 3.0, 100.0, 1.0e6]),
        _ => {
            let mut eye = random.pick(vertices);
            eye[random.below(3)] = coordinate(random, family);
            eye
        }
    };
    let mut target = random.pick(vertices);
    if random.one_in(3) {
        // Along an axis.
        let axis = random.below(3);
        target = eye;
        target[axis] += random.pick(&[1.0, -1.0]);
    }
    let up = random.pick(&[Vec3::Y, Vec3::X, Vec3::Z, Vec3::new(0.3, 1.0, -0.2), Vec3::new(1.0e-30, 1.0, 0.0)]);
    if random.one_in(3) {
        Camera::orthographic(eye, target, up, random.pick(&[1.0, 4.0, 0.0, 1.0e6, 1.0e-6]))
    } else {
        Camera::pinhole(eye, target, up, random.pick(&[0.8, 0.05, 2.5, 1.0e-4, 3.1]))
    }
}

fn same<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, camera: &Camera, tile: &Tile, side: u32, what: &str) {
    let Some(bundle) = camera.bundle(tile, side, side) else { return };
    let entries = scene.enter(&bundle);
    for (x, y) in tile.pixels() {
        for (dx, dy) in [(0.5, 0.5), (0.0, 0.0), (1.0, 0.3), (0.125, 1.0)] {
            let ray = camera.ray(x as f32 + dx, y as f32 + dy, side, side);
            let (from, plain) = (scene.closest_hit_from(&entries, &ray), scene.closest_hit(&ray));
            assert_eq!(bits(from), bits(plain), "{what}: {ray:?} of {tile:?}, {entries:?}");
        }
    }
}

/// All rays of a tile at once hit what each hits by itself; whether they were asked for at once.
fn same_at_once<A: Accelerator, P: Primitives>(
    scene: &Scene<A, P>,
    camera: &Camera,
    tile: &Tile,
    side: u32,
    what: &str,
) -> bool {
    let Some(pencil) = camera.pencil(tile, side, side) else { return false };
    let mut hits = ItemBuffer::new();
    if !scene.closest_hits(&pencil, &mut hits) {
        return false;
    }
    for (x, y) in tile.pixels() {
        let (column, row) = (x - tile.x, y - tile.y);
        let ray = camera.ray(x as f32 + 0.5, y as f32 + 0.5, side, side);
        assert_eq!(pencil.ray(column, row), ray);
        let (at_once, plain) = (hits.get(column, row), scene.closest_hit(&ray));
        assert_eq!(bits(at_once), bits(plain), "{what}: {ray:?} of {pencil:?}");
    }
    true
}

/// A scene that compares all hits of rays at once with each by itself.
struct Compared<'a, S> {
    scene: &'a S,
    what: &'a str,
    rays: Cell<u32>,
}

impl<S: Caster> Caster for Compared<'_, S> {
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit> {
        self.scene.closest_hit(ray, depth)
    }

    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        let is_done = self.scene.closest_hits(pencil, hits);
        for (row, column) in (0..pencil.rows()).flat_map(|row| (0..pencil.columns()).map(move |column| (row, column))) {
            let (at_once, ray) = (hits.get(column, row), pencil.ray(column, row));
            if is_done {
                assert_eq!(
                    bits(at_once),
                    bits(self.scene.closest_hit(&ray, 0)),
                    "{}: {ray:?} of {pencil:?}",
                    self.what
                );
                self.rays.set(self.rays.get() + 1);
            }
        }
        is_done
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.scene.any_hit(ray, depth)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.scene.surface(ray, hit)
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }
}

/// A tile of a picture of 31 x 31 pixels is the pixels, bit for bit; how many rays were answered at once.
fn tile_of_pixels<S: Caster>(scene: &S, camera: Camera, samples: u32) -> u32 {
    let lights = [Light::directional(Vec3::new(0.3, -1.0, 0.2), Vec3::ONE)];
    let compared = Compared { scene, what: "samples", rays: Cell::new(0) };
    let renderer = Renderer::new(&compared, camera, 31, 31).with_samples(samples).with_lights(&lights);
    let tile = Tile { x: 9, y: 11, width: 5, height: 3 };
    let mut filled = [Vec3::ZERO; 15];
    renderer.fill(tile, &mut filled).unwrap();
    for ((x, y), light) in tile.pixels().zip(filled) {
        let pixel = renderer.pixel(x, y);
        assert_eq!(light.to_array().map(f32::to_bits), pixel.to_array().map(f32::to_bits), "{samples}: {x} {y}");
    }
    compared.rays.get()
}

/// Samples are asked for at once, too.
#[test]
fn samples_of_a_tile_are_those_of_its_pixels() {
    let mut random = Random::new(44);
    let (mut rays, mut on_lattice) = (0, 0);
    for round in 0..24 {
        let family = round % common::FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 80);
        let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
        let words = bake::build(&mesh, &Plan::KdTree(Default::default())).unwrap();
        let scene = Scene::new(Structure::open(Kind::KdTree, &words).unwrap(), &mesh).unwrap();
        let snapped = bake::lattice(&mesh);
        let lattice = snapped.mesh(&mesh).unwrap();
        let words = bake::build(&lattice, &Plan::DualSplit(Default::default())).unwrap();
        let whole = LatticeScene::new(DualSplit::<32>::open(&words).unwrap(), &lattice).unwrap();
        for samples in [1, 2, 3, 8, 9] {
            let camera = camera(&mut random, family, &vertices);
            let at_once = [tile_of_pixels(&scene, camera, samples), tile_of_pixels(&whole, camera, samples)];
            assert!(samples <= 8 || at_once == [0; 2]);
            rays += at_once[0];
            on_lattice += at_once[1];
        }
    }
    assert!(rays > 5_000 && on_lattice > 3_000, "{rays} {on_lattice}");
}

#[test]
fn entries_hold_all_that_a_tile_can_meet() {
    let mut random = Random::new(41);
    let mut hits = 0;
    let mut tiles = BTreeMap::new();
    for round in 0..150 {
        let family = round % common::FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 80);
        let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
        for (name, plan) in plans::presets() {
            let words = bake::build(&mesh, &plan).unwrap();
            let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &mesh).unwrap();
            for _ in 0..4 {
                let camera = camera(&mut random, family, &vertices);
                let side = random.pick(&[1, 7, 64, 240]);
                let at = |random: &mut Random| random.below(side as usize) as u32;
                let (x, y) = if random.one_in(2) { (side / 2, side / 2) } else { (at(&mut random), at(&mut random)) };
                let tile = Tile { x, y, width: 4.min(side - x), height: 4.min(side - y) };
                same(&scene, &camera, &tile, side, name);
                let mut at_once = same_at_once(&scene, &camera, &tile, side, name);
                let tile = Tile { x: x & !7, y: y & !7, width: 8, height: 8 };
                at_once |= same_at_once(&scene, &camera, &tile, side, name);
                *tiles.entry(name).or_insert(0) += u32::from(at_once);
                let ray = camera.ray(x as f32, y as f32, side, side);
                hits += u32::from(scene.any_hit(&ray));
            }
        }
    }
    assert!(hits > 1_000, "{hits}");
    for (name, at_once) in tiles {
        assert_eq!(at_once > 100, !name.starts_with("grid"), "{name}: {at_once} of 600");
    }
}

#[test]
fn shapes_that_are_not_certified_keep_their_hits() {
    let mut random = Random::new(42);
    for round in 0..60 {
        let family = round % common::FAMILIES;
        let boxes: Vec<Aabb> = (0..40).map(|_| common::boxed(&mut random, family)).collect();
        let shapes = from_fn(
            boxes.len() as u32,
            |i| boxes[i as usize],
            |i, ray: &Ray| {
                let t = common::noise(i, ray);
                t.is_finite().then_some(t)
            },
        );
        let vertices: Vec<Vec3> = boxes.iter().flat_map(|bounds| [bounds.min, bounds.max]).collect();
        for (name, plan) in plans::presets() {
            let words = bake::build(&shapes, &plan).unwrap();
            let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &shapes).unwrap();
            let camera = camera(&mut random, family, &vertices);
            for tile in [Tile { x: 14, y: 14, width: 4, height: 4 }, Tile { x: 3, y: 20, width: 8, height: 2 }] {
                same(&scene, &camera, &tile, 32, name);
                same_at_once(&scene, &camera, &tile, 32, name);
            }
        }
    }
}

/// Any rays, not only a camera's: between those given, coordinate by coordinate.
#[test]
fn bundles_bound_all_rays_between() {
    let mut random = Random::new(43);
    let (mut met, mut missed) = (0, 0);
    for round in 0..200_000 {
        let family = round % common::FAMILIES;
        let corner = |random: &mut Random| {
            let direction = match random.below(3) {
                0 => point(random, 4),
                1 => point(random, 2),
                _ => Vec3::from_array([0; 3].map(|_| random.below(3) as f32 - 1.0)),
            };
            Ray::new(point(random, family), direction).starting_at(random.pick(&[0.0, 0.0, 1.0]))
        };
        let (a, b) = (corner(&mut random), corner(&mut random));
        let b = if random.one_in(2) { Ray { origin: a.origin, ..b } } else { b };
        let b = if random.one_in(2) { Ray { direction: a.direction * (1.0 + random.unit()), ..b } } else { b };
        let bundle = Bundle::around([a, b]).unwrap();
        let bounds = common::boxed(&mut random, family);
        let entry = bundle.entry(&bounds);
        for _ in 0..4 {
            let mix = |random: &mut Random, a: Vec3, b: Vec3| {
                let pick = |random: &mut Random, a: f32, b: f32| {
                    let between = a + (b - a) * random.unit();
                    random.pick(&[a, b, between.clamp(a.min(b), a.max(b))])
                };
                Vec3::new(pick(random, a.x, b.x), pick(random, a.y, b.y), pick(random, a.z, b.z))
            };
            let ray = Ray::new(mix(&mut random, a.origin, b.origin), mix(&mut random, a.direction, b.direction));
            let Some(prepared) = ray.starting_at(a.t_min.min(b.t_min)).prepare() else { continue };
            let Some((enter, exit)) = bounds.interval(&prepared) else { continue };
            if enter.max(prepared.ray().t_min) > exit {
                missed += 1;
                continue;
            }
            met += 1;
            let earliest = entry.unwrap_or_else(|| panic!("{ray:?} meets {bounds:?}, {bundle:?} does not"));
            assert!(earliest <= enter.max(prepared.ray().t_min), "{ray:?} enters {bounds:?} before {earliest}");
        }
    }
    assert!(met > 20_000 && missed > 1_000, "{met} {missed}");
}

#[test]
fn rays_without_numbers_are_no_bundle() {
    let good = Ray::new(Vec3::ZERO, Vec3::Z);
    assert!(Bundle::around([]).is_none());
    assert!(Bundle::around([good]).is_some());
    assert!(Bundle::around([good, good.starting_at(-1.0)]).is_none());
    for bad in [f32::NAN, f32::INFINITY] {
        assert!(Bundle::around([good, Ray::new(Vec3::new(0.0, bad, 0.0), Vec3::Z)]).is_none());
        assert!(Bundle::around([Ray::new(Vec3::ZERO, Vec3::splat(bad)), good]).is_none());
        assert!(Bundle::around([good.starting_at(bad)]).is_none());
    }
}

/// Empty tiles are told, and tiles before a surface begin with less than everything.
#[test]
fn entries_are_few_and_small() {
    let (vertices, triangles) = common::meshes::sheet(40);
    let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
    for plan in [
        Plan::KdTree(Default::default()),
        Plan::CompactKdTree(Default::default()),
        Plan::Bvh(Default::default()),
        Plan::DualSplit(Default::default()),
    ] {
        let words = bake::build(&mesh, &plan).unwrap();
        let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &mesh).unwrap();
        let renderer = Renderer::new(&scene, Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y), 128, 128);
        let (mut empty, mut part, mut tiles) = (0, 0.0_f32, 0);
        for tile in renderer.tiles(8, 8) {
            let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
            let entries = scene.enter(&camera.bundle(&tile, 128, 128).unwrap());
            empty += u32::from(entries.is_empty());
            tiles += u32::from(!entries.is_empty());
            part += entries.iter().map(|entry| entry.bounds.half_area()).sum::<f32>() / scene.bounds().half_area();
        }
        assert!(empty > 100, "{plan:?}: {empty} tiles are empty");
        let part = part / tiles as f32;
        assert!(part < 0.8, "{plan:?}: walks begin with {part}");
    }
}

/// Tiles beside and between the strands of a coil are told to be empty, wherever planes lie.
#[test]
fn tiles_that_see_nothing_are_empty() {
    let point = |along: usize, around: usize| {
        let (along, around) = (along as f32 * 0.08, around as f32 * std::f32::consts::TAU / 6.0);
        let distance = 1.0 + 0.1 * around.cos();
        Vec3::new(distance * along.cos(), 0.12 * along + 0.1 * around.sin(), distance * along.sin())
    };
    let vertices: Vec<Vec3> = (0..200 * 6).map(|i| point(i / 6, i % 6)).collect();
    let triangles: Vec<[u16; 3]> = (0..199 * 6)
        .flat_map(|i| {
            let (a, b) = (i, i / 6 * 6 + (i + 1) % 6);
            [[a, b, a + 6], [b, b + 6, a + 6]]
        })
        .collect();
    let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
    let words = bake::build(&mesh, &Plan::KdTree(Default::default())).unwrap();
    let scene = Scene::new(Structure::open(hitscan::asset::Kind::KdTree, &words).unwrap(), &mesh).unwrap();
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.1, 0.2, 1.0), Vec3::Y);
    let (mut empty, mut told) = (0, 0);
    for tile in Renderer::new(&scene, camera, 128, 128).tiles(4, 4) {
        let sees_something = tile.pixels().any(|(x, y)| {
            let mut points = (0..16).map(|i| (x as f32 + (i % 4) as f32 / 3.0, y as f32 + (i / 4) as f32 / 3.0));
            points.any(|(x, y)| scene.any_hit(&camera.ray(x, y, 128, 128)))
        });
        let entries = scene.enter(&camera.bundle(&tile, 128, 128).unwrap());
        assert!(!(sees_something && entries.is_empty()), "{tile:?}");
        empty += u32::from(!sees_something);
        told += u32::from(entries.is_empty());
    }
    assert!(empty > 300 && told * 10 > empty * 9, "of {empty} empty tiles {told} are told");
}

#[test]
fn pictures_in_parts_are_the_picture() {
    let mut random = Random::new(44);
    let (vertices, triangles) = adversarial_mesh(&mut random, 2, 60);
    let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
    let words = bake::build(&mesh, &Plan::KdTree(Default::default())).unwrap();
    let scene = Scene::new(Structure::open(hitscan::asset::Kind::KdTree, &words).unwrap(), &mesh).unwrap();
    for (width, height) in [(1, 1), (9, 70), (130, 67), (64, 64), (0, 5), (5, 0)] {
        let camera = Camera::framing(&scene.bounds(), Vec3::new(0.3, 0.2, 1.0), Vec3::Y);
        // One light more than patches remember occluders of.
        let lights = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Z, Vec3::NEG_ONE]
            .map(|direction| Light::directional(direction + Vec3::splat(0.1), Vec3::ONE));
        let renderer =
            Renderer::new(&scene, camera, width, height).with_samples(2).with_bounces(1).with_lights(&lights);
        let plain: Vec<Vec3> = Tile { x: 0, y: 0, width, height }.pixels().map(|(x, y)| renderer.pixel(x, y)).collect();

        let mut filled = vec![Vec3::NAN; plain.len()];
        renderer.fill(Tile { x: 0, y: 0, width, height }, &mut filled).unwrap();
        assert_eq!(filled, plain);

        let (mut blocks, mut computed, mut drawn) = (vec![Vec3::NAN; plain.len()], vec![0; plain.len()], 0);
        let mut picture = renderer.progressive();
        loop {
            let budget = random.below(40) as u32;
            let mut taken = 0;
            let more = picture.step(budget, |block, light| {
                taken += 1;
                computed[(block.y * width + block.x) as usize] += 1;
                block.pixels().for_each(|(x, y)| blocks[(y * width + x) as usize] = light);
            });
            assert!(taken <= budget);
            drawn += taken as usize;
            // The first blocks cover the picture.
            if drawn >= (width.div_ceil(8) * height.div_ceil(8)) as usize {
                assert!(blocks.iter().all(|light| light.is_finite()));
            }
            if !more {
                break;
            }
        }
        assert_eq!(blocks, plain);
        assert!(computed.iter().all(|&times| times == 1));
    }
}

/// What moves changes only tiles that may show it.
#[test]
fn tiles_that_show_nothing_of_a_change_stay_as_they_are() {
    let vertices = |x: f32| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|v| v + Vec3::new(x, 0.0, 0.0));
    let still = [Vec3::new(-3.0, -3.0, -1.0), Vec3::new(3.0, -3.0, -1.0), Vec3::new(0.0, 4.0, -1.0)];
    let frames = [0.0, 0.4].map(|x| [vertices(x), still].concat());
    let meshes = [0, 1].map(|i| Mesh::new(&frames[i], &[[0_u16, 1, 2], [3, 4, 5]]).unwrap());
    let scenes = [0, 1].map(|i| Scene::new(List::new(&meshes[i]).unwrap(), meshes[i]).unwrap());
    let camera = Camera::pinhole(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO, Vec3::Y, 0.9);
    let renderers = [0, 1].map(|i| Renderer::new(&scenes[i], camera, 96, 96));
    let moved = meshes[0].bounds(0).union(&meshes[1].bounds(0));
    let (mut dirty, mut clean) = (0, 0);
    for tile in renderers[0].tiles(8, 8) {
        if renderers[0].may_show(&tile, &moved) {
            dirty += 1;
            continue;
        }
        clean += 1;
        let [before, after] = [0, 1].map(|i| renderers[i].colors::<[u8; 3]>(tile).collect::<Vec<_>>());
        assert_eq!(before, after, "{tile:?}");
    }
    assert!(dirty < 20 && clean > 100, "{dirty} {clean}");
}

/// Tiles at the end of all numbers, larger than the picture, or without pixels: what is drawn is the picture's, and nothing
/// panics.
#[test]
fn tiles_of_any_numbers_are_filled() {
    let mesh = Mesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0_u16, 1, 2]]).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
    let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
    let renderer = Renderer::new(&scene, camera, 16, 8);
    for (x, width) in [(u32::MAX, 20), (u32::MAX - 5, 20), (0, 0), (3, 20), (1 << 31, 9)] {
        for (y, height) in [(u32::MAX, 9), (u32::MAX - 12, 20), (0, 0), (5, 9)] {
            let tile = Tile { x, y, width, height };
            let mut pixels = vec![Vec3::NAN; tile.area()];
            renderer.fill(tile, &mut pixels).unwrap();
            for (index, light) in pixels.iter().enumerate() {
                let at = (x.checked_add(index as u32 % width), y.checked_add(index as u32 / width));
                // What has no number has no colour, either.
                let expected = match at {
                    (Some(x), Some(y)) if x < u32::MAX && y < u32::MAX => renderer.pixel(x, y),
                    _ => Vec3::NAN,
                };
                assert_eq!(
                    light.to_array().map(f32::to_bits),
                    expected.to_array().map(f32::to_bits),
                    "{tile:?} {at:?}"
                );
            }
        }
    }
}

/// What is tried first, even if it is no primitive, changes no answer, and what stops a ray is remembered.
#[test]
fn shadows_are_the_same_whatever_is_tried_first() {
    let mut random = Random::new(46);
    let (mut stopped, mut again) = (0, 0);
    for round in 0..60 {
        let family = round % common::FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
        for (name, plan) in plans::presets() {
            let words = bake::build(&mesh, &plan).unwrap();
            let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &mesh).unwrap();
            for _ in 0..20 {
                let ray =
                    Ray::between(point(&mut random, family), random.pick(&vertices)).up_to(random.pick(&[0.5, 2.0]));
                let first = random.pick(&[None, Some(0), Some(31), Some(triangles.len() as u32), Some(u32::MAX)]);
                let mut last = first;
                let is_stopped = scene.any_hit(&ray);
                assert_eq!(scene.any_hit_near(&ray, &mut last), is_stopped, "{name}: {ray:?} {first:?}");
                assert!(is_stopped || last == first);
                if is_stopped {
                    stopped += 1;
                    let found = last;
                    assert!(scene.any_hit_near(&ray, &mut last));
                    again += u32::from(last == found);
                }
            }
        }
    }
    assert!(stopped > 1_000 && again == stopped, "{stopped} {again}");
}

/// What is refined is what differs from a neighbour in the rough picture, once, with the light of all samples.
#[test]
fn edges_alone_are_refined() {
    let (vertices, triangles) = common::meshes::random(12, 0.6);
    let mesh = Mesh::new(&vertices, triangles.as_slice()).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.3, 0.2, 1.0), Vec3::Y);
    let renderer = Renderer::new(&scene, camera, 50, 37);
    for tile in [Tile { x: 0, y: 0, width: 50, height: 37 }, Tile { x: 0, y: 9, width: 50, height: 11 }] {
        let mut rough = vec![[0_u8; 3]; tile.area()];
        renderer.fill(tile, &mut rough).unwrap();
        let at = |x: u32, y: u32| {
            let inside = x < tile.width && y >= tile.y && y < tile.y + tile.height;
            inside.then(|| rough[((y - tile.y) * tile.width + x) as usize])
        };
        let differ = |a: &[u8; 3], b: &[u8; 3]| a[0].abs_diff(b[0]) > 8;
        let fine = renderer.with_samples(3);
        let mut left: Vec<_> = tile
            .pixels()
            .filter(|&(x, y)| {
                let beside = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
                beside.into_iter().any(|(u, v)| at(u, v).is_some_and(|other| differ(&at(x, y).unwrap(), &other)))
            })
            .collect();
        assert!(left.len() > 50 && left.len() * 3 < tile.area(), "{} of {}", left.len(), tile.area());
        for ((x, y), light) in fine.refined(tile, &rough, differ) {
            let place = left.iter().position(|&pixel| pixel == (x, y)).expect("an edge, once");
            left.swap_remove(place);
            assert_eq!(light, fine.pixel(x, y));
        }
        assert!(left.is_empty());
        // Of a picture that is cut short, what is there.
        assert!(fine.refined(tile, &rough[..70], differ).all(|((x, y), _)| (y - tile.y) * tile.width + x < 70));
        assert_eq!(fine.refined(tile, &[0_u8; 0], |_, _| true).count(), 0);
    }
}
