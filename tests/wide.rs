//! The wide BVH returns bit for bit what the list returns, with any instructions and in batches of any size.
#![cfg(feature = "std")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits};
use hitscan::{
    Hit, List, Mesh, Ray, Scene,
    glam::Vec3,
    primitives::Sides,
    wide::{Options, Simd, WideBvh},
};

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
        let rays: Vec<Ray> = (0..random.pick(&[1, 3, 8, 64, 1000]))
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

#[test]
fn nothing_is_hit_in_an_empty_tree() {
    let mesh = Mesh::new(&[], &[] as &[[u16; 3]; 0]).unwrap();
    let wide = WideBvh::new(&mesh, &Options::default()).unwrap();
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
