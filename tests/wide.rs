//! The wide BVH returns bit for bit what the list returns, with any instructions and in batches of any size.
#![cfg(feature = "std")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits};
use hitscan::{
    List, Mesh, Ray, Scene,
    glam::Vec3,
    primitives::Sides,
    wide::{Options, Simd, WideBvh},
};

fn rays() -> usize {
    std::env::var("HITSCAN_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}

/// Casts rays with instructions of one kind.
fn compare(simd: Simd, seed: u64, rays: usize) {
    let mut random = Random::new(seed);
    let (mut cast, mut hits) = (0, 0);
    while cast < rays {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[1, 2, 3, u32::MAX])).collect();
        let mut mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        if random.one_in(4) {
            mesh = mesh.with_sides(Sides::Front);
        }
        if random.one_in(4) {
            mesh = mesh.with_masks(&masks).unwrap();
        }
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let wide = WideBvh::new(&mesh, &Options::default()).unwrap().with_simd(simd);
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &vertices).seeing(random.pick(&[1, 2, u32::MAX, u32::MAX]));
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(wide.closest_hit(&ray)), bits(expected), "{simd:?} {ray:?} {vertices:?}");
            assert_eq!(wide.any_hit(&ray), expected.is_some(), "{simd:?} {ray:?} {vertices:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
}

#[test]
fn the_wide_tree_answers_as_the_list() {
    let kinds: Vec<Simd> = Simd::available().collect();
    std::thread::scope(|scope| {
        for (seed, &simd) in kinds.iter().enumerate() {
            let share = rays() / kinds.len();
            scope.spawn(move || compare(simd, seed as u64, share));
        }
    });
}

#[test]
fn nothing_is_hit_in_an_empty_tree() {
    let mesh = Mesh::new(&[], &[] as &[[u16; 3]; 0]).unwrap();
    let wide = WideBvh::new(&mesh, &Options::default()).unwrap();
    assert_eq!(wide.closest_hit(&Ray::new(Vec3::ZERO, Vec3::Z)), None);
}
