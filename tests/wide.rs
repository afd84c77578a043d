//! The wide BVH returns bit for bit what the list returns, with any instructions and in batches of any size.
#![cfg(feature = "std")]
#![allow(missing_docs)]

mod common;

use std::{
    ops::ControlFlow,
    sync::{
        Mutex,
        atomic::{AtomicU32, Ordering},
    },
};

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits};
use hitscan::{
    Hit, LatticeMesh, List, Mesh, Ray, Scene,
    geometry::Aabb,
    glam::Vec3,
    parallel,
    primitives::{Sides, Triangles},
    render::{Camera, Light, Renderer},
    wide::{Coherence, Options, Simd, WideBvh},
};

fn build<P: Triangles + Sync>(triangles: P) -> WideBvh<P> {
    WideBvh::new(triangles, &Options::default()).unwrap()
}

/// The mesh, now and then hit from the front only, now and then with these masks.
fn some_hidden<'a>(random: &mut Random, mesh: Mesh<'a>, masks: &'a [u32]) -> Mesh<'a> {
    let mesh = if random.one_in(4) { mesh.with_sides(Sides::Front) } else { mesh };
    if random.one_in(4) { mesh.with_masks(masks).unwrap() } else { mesh }
}

/// Casts rays with instructions of one kind.
fn compare(simd: Simd, seed: u64, rays: usize) {
    let mut random = Random::new(seed);
    let (mut cast, mut hits) = (0, 0);
    while cast < rays {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[1, 2, 3, u32::MAX])).collect();
        let mesh = some_hidden(&mut random, Mesh::new(&vertices, &triangles[..]).unwrap(), &masks);
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let options = random.pick(&[Options::fast(), Options::balanced(), Options::best()]);
        let coherence = random.pick(&[Coherence::Measured, Coherence::Coherent, Coherence::Incoherent]);
        let wide = WideBvh::new(&mesh, &options).unwrap().with_simd(simd).with_coherence(coherence);
        // The most are enough for a sample to be taken.
        let rays: Vec<Ray> = (0..random.pick(&[1, 3, 8, 64, 1100]))
            .map(|_| {
                let mask = random.pick(&[0, 1, 2, u32::MAX, u32::MAX, u32::MAX]);
                adversarial_ray(&mut random, family, &vertices).seeing(mask)
            })
            .collect();
        // What is asked for before must not be left in the answers.
        let mut closest = vec![Some(Hit { t: 7.0, primitive: 7 }); rays.len()];
        let mut any = vec![true; rays.len()];
        wide.closest_hits(&rays, &mut closest);
        wide.any_hits(&rays, &mut any);
        for ((ray, closest), any) in rays.iter().zip(closest).zip(any) {
            let expected = list.closest_hit(ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(wide.closest_hit(ray)), bits(expected), "{simd:?} {ray:?} {vertices:?}");
            assert_eq!(bits(closest), bits(expected), "{simd:?} {ray:?} {vertices:?}");
            assert_eq!(wide.any_hit(ray), expected.is_some(), "{simd:?} {ray:?} {vertices:?}");
            assert_eq!(any, expected.is_some(), "{simd:?} {ray:?} {vertices:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
}

#[test]
fn the_wide_tree_answers_as_the_list() {
    let kinds: Vec<Simd> = Simd::available().collect();
    std::thread::scope(|scope| {
        for (seed, &simd) in kinds.iter().enumerate() {
            let share = common::rays(1_000_000) / kinds.len();
            scope.spawn(move || compare(simd, seed as u64 + 100 * common::seed(), share));
        }
    });
}

/// Rays beside each other, as a camera, a light or a sensor casts them.
fn tile(random: &mut Random, vertices: &[Vec3], family: usize) -> Vec<Ray> {
    let ray = adversarial_ray(random, family, vertices);
    let end = ray.at(random.pick(&[0.5, 1.0, 2.0]));
    // None, little and much beside the way that the ray goes.
    let size = ray.direction.abs().max_element() * random.pick(&[0.0, 1.0e-6, 1.0e-3, 0.05, 0.05, 0.5]);
    let step = |random: &mut Random| Vec3::from_array([0; 3].map(|_| random.pick(&[0.0, -0.0, 1.0, -0.5]))) * size;
    let (x, y) = (step(random), step(random));
    let (kind, width) = (random.below(3), random.pick(&[4, 8, 16]));
    let count = 1 + random.below(100);
    let mut rays: Vec<Ray> = (0..count)
        .map(|i| {
            let moved = x * (i % width) as f32 * 0.1 + y * (i / width) as f32 * 0.1;
            let [origin, direction] = match kind {
                0 => [ray.origin, ray.direction + moved],
                1 => [ray.origin + moved, end - (ray.origin + moved)],
                _ => [ray.origin + moved, ray.direction],
            };
            Ray { origin, direction, ..ray }
        })
        .collect();
    // Some are others.
    while random.one_in(2) {
        let at = random.below(count);
        rays[at] = match random.below(5) {
            0 => Ray { origin: Vec3::NAN, ..rays[at] },
            1 => Ray { direction: Vec3::new(f32::NAN, 1.0, 0.0), ..rays[at] },
            2 => rays[at]
                .starting_at(random.pick(&[0.25, -1.0, f32::NAN, f32::INFINITY]))
                .up_to(random.pick(&[0.5, f32::NAN])),
            3 => rays[at].seeing(random.pick(&[0, 1, 2])),
            _ => adversarial_ray(random, family, vertices),
        };
    }
    rays
}

#[test]
fn packets_answer_as_the_list() {
    let mut random = Random::new(77 + 100 * common::seed());
    let kinds: Vec<Simd> = Simd::available().collect();
    let (mut cast, mut hits) = (0, 0);
    while cast < common::rays(1_000_000) {
        let family = random.below(FAMILIES);
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        // Where areas leave the range in which one scale suffices, the list tries another before it asks slower tiers.
        let scale = random.pick(&[1.0, 1.0, 2.0_f32.powi(-13), 2.0_f32.powi(-17), 2.0_f32.powi(34)]);
        vertices.iter_mut().for_each(|vertex| *vertex *= scale);
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[1, 2, 3, u32::MAX])).collect();
        let mesh = some_hidden(&mut random, Mesh::new(&vertices, &triangles[..]).unwrap(), &masks);
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let mut wide = WideBvh::new(&mesh, &Options::fast()).unwrap().with_coherence(Coherence::Coherent);
        for _ in 0..8 {
            wide = wide.with_simd(random.pick(&kinds));
            let rays = tile(&mut random, &vertices, family);
            let mut closest = vec![Some(Hit { t: 7.0, primitive: 7 }); rays.len()];
            let mut any = vec![true; rays.len()];
            wide.closest_hits(&rays, &mut closest);
            wide.any_hits(&rays, &mut any);
            for ((ray, closest), any) in rays.iter().zip(closest).zip(any) {
                let expected = list.closest_hit(ray);
                cast += 1;
                hits += usize::from(expected.is_some());
                assert_eq!(bits(closest), bits(expected), "{ray:?} {vertices:?}");
                assert_eq!(any, expected.is_some(), "{ray:?} {vertices:?}");
            }
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
}

/// Hills of `side` x `side` x 2 triangles.
fn hills(side: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |i: u32| i as f32 / side as f32;
    let points = (0..=side).flat_map(|j| (0..=side).map(move |i| (place(i), place(j))));
    let vertices = points.map(|(x, z)| Vec3::new(x, (x * 9.0).sin() * (z * 7.0).cos() * 0.1, z)).collect();
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| j * (side + 1) + i));
    (vertices, cells.flat_map(|a| [[a, a + 1, a + side + 1], [a + 1, a + side + 2, a + side + 1]]).collect())
}

#[test]
fn pictures_are_those_of_a_list() {
    let (vertices, triangles) = hills(12);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let (list, wide) = (Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap(), build(&mesh));
    let camera = Camera::framing(&wide.bounds(), Vec3::new(0.4, 1.0, 0.5), Vec3::Y);
    let lights = [Light::directional(Vec3::new(-1.0, -2.0, -1.0), Vec3::ONE)];
    let [mut one, mut other] = [const { [[0_u8; 3]; 48 * 32] }; 2];
    parallel::render(&Renderer::new(&list, camera, 48, 32).with_lights(&lights), &mut one).unwrap();
    parallel::render(&Renderer::new(&wide, camera, 48, 32).with_lights(&lights), &mut other).unwrap();
    assert!(one == other);
}

#[test]
fn lattices_are_answered_as_by_a_list() {
    let mut random = Random::new(5);
    let vertices: Vec<[u16; 3]> = (0..90).map(|_| [0; 3].map(|_| random.below(9) as u16 * 8191)).collect();
    let triangles: Vec<[u16; 3]> = (0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let frame = Aabb::new(Vec3::splat(-1.0), Vec3::splat(2.0));
    let mesh = LatticeMesh::new(&frame, &vertices, &triangles[..]).unwrap();
    let (list, wide) = (Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap(), build(&mesh));
    let corners: Vec<Vec3> = mesh.positions().collect();
    for _ in 0..20_000 {
        let ray = adversarial_ray(&mut random, 1, &corners);
        assert_eq!(bits(wide.closest_hit(&ray)), bits(list.closest_hit(&ray)), "{ray:?}");
    }
}

#[test]
fn triangles_that_cannot_be_told_apart_are_divided() {
    let count = 65_537;
    let mesh_of = vec![[0_u16, 1, 2]; count];
    let mesh = Mesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &mesh_of[..]).unwrap();
    let wide = build(&mesh);
    assert!(wide.bytes() < count * 65, "{}", wide.bytes());
    let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
    assert_eq!(wide.closest_hit(&ray), Some(Hit { t: 1.0, primitive: 0 }));
    let flat = Mesh::new(&[Vec3::ZERO; 3], &mesh_of[..]).unwrap();
    assert_eq!(build(&flat).closest_hit(&ray), None);
}

#[test]
fn neighbours_share_corners() {
    let (vertices, triangles) = hills(100);
    let wide = build(Mesh::new(&vertices, &triangles[..]).unwrap());
    assert!(wide.bytes() < triangles.len() * 36, "{}", wide.bytes());
}

#[test]
fn soups_without_shared_corners_are_packed() {
    let mut random = Random::new(11);
    let vertices: Vec<Vec3> = (0..3000).map(|_| point_in(&mut random)).collect();
    let triangles: Vec<[u32; 3]> = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    for options in [Options::fast(), Options::balanced(), Options::best()] {
        let wide = WideBvh::new(&mesh, &options).unwrap();
        for _ in 0..300 {
            let ray = Ray::between(point_in(&mut random), point_in(&mut random));
            assert_eq!(bits(wide.closest_hit(&ray)), bits(list.closest_hit(&ray)));
        }
    }
}

/// A point in the unit cube.
fn point_in(random: &mut Random) -> Vec3 {
    Vec3::new(random.unit(), random.unit(), random.unit())
}

#[test]
fn a_builder_is_broken_off_at_any_word() {
    let (vertices, triangles) = hills(80);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for options in [Options::fast(), Options::balanced(), Options::best()] {
        let until = |last: u32| {
            let (words, seen) = (AtomicU32::new(0), Mutex::new(Vec::new()));
            let built = pool.install(|| {
                WideBvh::new_with(&mesh, &options, |progress| {
                    seen.lock().unwrap().push(progress);
                    let word = words.fetch_add(1, Ordering::Relaxed);
                    if word == last { ControlFlow::Break(word) } else { ControlFlow::Continue(()) }
                })
            });
            (built.unwrap().map_continue(|_| ()), seen.into_inner().unwrap())
        };
        let (built, seen) = until(u32::MAX);
        assert!(built.is_continue() && seen.len() > 5);
        assert!(seen.is_sorted_by_key(|progress| progress.done));
        assert!(seen.last().is_some_and(|progress| progress.done == progress.total), "{seen:?}");
        for last in 0..seen.len() as u32 {
            assert_eq!(until(last).0, ControlFlow::Break(last));
        }
    }
}

#[test]
fn nothing_is_hit_in_an_empty_tree() {
    let mesh = Mesh::new(&[], &[] as &[[u16; 3]; 0]).unwrap();
    let wide = build(&mesh);
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert_eq!((wide.closest_hit(&ray), wide.any_hit(&ray)), (None, false));
    let (mut closest, mut any) = ([Some(Hit { t: 1.0, primitive: 0 }); 3], [true; 3]);
    wide.closest_hits(&[ray; 3], &mut closest);
    wide.any_hits(&[ray; 3], &mut any);
    assert_eq!((closest, any), ([None; 3], [false; 3]));
    // As many as there is room for.
    wide.any_hits(&[ray; 3], &mut any[..0]);
    wide.any_hits(&[], &mut any);
}
