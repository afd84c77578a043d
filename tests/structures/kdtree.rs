//! Memory: every arena size is enough or refused, and the bounds and budgets hold.

use crate::common::meshes::{Triangles, crossing, hair, identical, random, separate};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits};
use hitscan::{
    Arena, KdTree, List, Mesh, Primitives, Scene,
    arena::Full,
    error::BuildError,
    geometry::Aabb,
    glam::Vec3,
    kdtree::{Options, Split},
    primitives::Spheres,
};

fn all_options() -> impl Iterator<Item = Options> {
    let base = [Options::small(), Options::balanced(), Options::fast()];
    let splits = [Split::Midpoint, Split::Median, Split::Sah];
    base.into_iter().flat_map(move |base| {
        splits.into_iter().flat_map(move |split| [true, false].map(|clip| Options { split, clip, ..base }))
    })
}

fn build<'m, P: Primitives>(
    primitives: &P,
    memory: &'m mut [u32],
    options: &Options,
) -> Result<KdTree<'m>, BuildError> {
    KdTree::build(primitives, &mut Arena::new(memory), options)
}

/// Builds in arenas of every size behind an earlier tenant until it goes.
fn refuses_until_it_goes((vertices, triangles): &Triangles, options: &Options) {
    let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
    let (others, corners) = random(3, 1.0);
    let other = Mesh::new(&others, &corners[..]).unwrap();
    let least = Options { bytes_per_primitive: 8, ..Options::small() };
    // What the tenant needs while it moves in, and what it then keeps.
    let mut memory = vec![0; KdTree::words(3, &least)];
    let needs = (0..).find(|&k| build(&other, &mut memory[..k], &least).is_ok()).unwrap();
    let keeps = build(&other, &mut memory, &least).unwrap().as_words().len();
    let list = Scene::new(List::new(&other).unwrap(), &other).unwrap();
    let mut random = Random::new(3);
    let rays: Vec<_> = (0..8).map(|_| adversarial_ray(&mut random, 2, &others)).collect();

    let enough = KdTree::words(triangles.len(), options);
    let (mut memory, mut large) = (vec![0; keeps + enough + 100], vec![0; enough]);
    let expected = build(&mesh, &mut large, options).expect("`words` suffice").as_words();
    let (mut promised, mut k) = (0, 0);
    let first = loop {
        let lodged = keeps + k >= needs;
        let mut arena = Arena::new(&mut memory[..if lodged { keeps + k } else { k }]);
        let tenant = lodged.then(|| KdTree::build(&other, &mut arena, &least).unwrap());
        assert_eq!(arena.available(), k);
        match KdTree::build(&mesh, &mut arena, options) {
            Ok(tree) => {
                assert_eq!(tree.as_words(), expected, "another tree in a smaller arena");
                assert_eq!(arena.available(), k - expected.len());
                break k;
            }
            Err(BuildError::Full(Full { at_least, available })) => {
                assert!(available == k && at_least > k, "{at_least} {available} {k}");
                assert_eq!(arena.available(), k);
                promised = promised.max(at_least);
            }
            Err(error) => panic!("{error}"),
        }
        if let Some(tenant) = tenant {
            let scene = Scene::new(KdTree::open(tenant.as_words()).unwrap(), &other).unwrap();
            rays.iter().for_each(|ray| assert_eq!(bits(scene.closest_hit(ray)), bits(list.closest_hit(ray))));
        }
        k += 1;
    };
    assert!(promised <= first && first <= enough, "{promised} {first} {enough}");
    for k in (first..enough).step_by(1 + (enough - first) / 20) {
        assert_eq!(build(&mesh, &mut memory[..k], options).unwrap().as_words(), expected, "{k}");
    }
}

#[test]
fn every_arena_is_large_enough_or_refused() {
    let meshes = [separate(vec![]), random(1, 1.0), random(2, 1.0), random(7, 1.0), random(40, 0.5), identical(20)];
    for mesh in &meshes {
        for options in all_options() {
            refuses_until_it_goes(mesh, &options);
        }
        refuses_until_it_goes(mesh, &Options::fast().fit(400));
    }
    refuses_until_it_goes(&crossing(30), &Options { intersection_cost: 20.0, ..Options::fast() });
}

#[test]
fn the_words_asked_for_always_suffice() {
    let meshes = [crossing(400), identical(1000), hair(300), random(500, 0.05), random(501, 3.0)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        for options in all_options() {
            for intersection_cost in [options.intersection_cost, 50.0] {
                let options = Options { intersection_cost, ..options };
                let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
                let tree = build(&mesh, &mut memory, &options).unwrap_or_else(|error| panic!("{error}: {options:?}"));
                let rate = triangles.len() * options.bytes_per_primitive as usize + 256;
                assert!(tree.as_words().len() * 4 <= rate, "{options:?}");
            }
        }
    }
    let mut random = Random::new(11);
    for _ in 0..3000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = Options {
            split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah]),
            leaf_size: random.below(4) as u32,
            intersection_cost: random.pick(&[0.3, 2.0, 1.0e9, f32::INFINITY, f32::NAN, -1.0]),
            byte_cost: random.pick(&[0.0, 0.2, 1.0e9, f32::INFINITY, f32::NAN, -1.0]),
            empty_bonus: random.pick(&[0.0, 0.2, 1.0, f32::NAN, -9.0]),
            max_depth: random.pick(&[None, Some(0), Some(2), Some(u32::MAX)]),
            bytes_per_primitive: random.below(400) as u32,
            clip: random.one_in(2),
            max_bytes: random.pick(&[None, None, Some(1000), Some(usize::MAX)]),
        };
        let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
        match build(&mesh, &mut memory, &options) {
            Ok(tree) => assert!(KdTree::open(tree.as_words()).is_ok(), "{options:?}"),
            Err(BuildError::Budget { at_least, allowed: 1000 }) => assert!(at_least > 1000),
            Err(error) => panic!("{error}: {options:?} {vertices:?}"),
        }
    }
}

#[test]
fn absurd_numbers_need_absurd_memory() {
    for options in all_options().chain([Options::fast().fit(usize::MAX)]) {
        assert!(KdTree::words(usize::MAX, &options) > usize::MAX / 2);
    }
}

#[test]
fn trees_fit_into_their_bytes() {
    let meshes = [separate(vec![]), random(1, 1.0), random(3, 1.0), random(40, 0.3), identical(15), crossing(60)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        let one_leaf = Options { max_depth: Some(0), ..Options::balanced() };
        let mut memory = vec![0; KdTree::words(triangles.len(), &Options::fast())];
        let least = build(&mesh, &mut memory, &one_leaf).unwrap().as_words().len() * 4;
        for base in [Options::fast(), Options { split: Split::Median, ..Options::fast() }] {
            let mut best = f32::INFINITY;
            let most = build(&mesh, &mut memory, &base).unwrap().as_words().len() * 4;
            for bytes in 0..most + 50 {
                let options = base.fit(bytes);
                let words = KdTree::words(triangles.len(), &options);
                match build(&mesh, &mut memory[..words], &options) {
                    Ok(tree) => {
                        let size = tree.as_words().len() * 4;
                        assert!(size <= bytes, "{size} bytes instead of {bytes} for {}", triangles.len());
                        assert!(bytes >= least);
                        if base.split == Split::Sah {
                            let (nodes, tests) = tree.expected_work();
                            let work = nodes + tests * base.intersection_cost;
                            assert!(work <= best * 1.25, "{bytes}: {nodes} nodes, {tests} tests against {best}");
                            best = best.min(work);
                        }
                    }
                    Err(BuildError::Budget { at_least, allowed }) => {
                        assert!(bytes < least && allowed == bytes && at_least > bytes && at_least <= least, "{bytes}");
                    }
                    Err(error) => panic!("{error}: {options:?}"),
                }
            }
        }
    }
}

#[test]
fn primitives_without_valid_bounds_are_named_and_leave_the_arena_alone() {
    let bad = [Aabb::EMPTY, Aabb::new(Vec3::NAN, Vec3::ONE), Aabb::new(Vec3::ZERO, Vec3::splat(1.0e38))];
    for bad in bad {
        let good = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let shapes = hitscan::from_fn(9, |i| if i == 5 || i == 7 { bad } else { good }, |_, _| Some(1.0));
        let mut memory = vec![7; KdTree::words(9, &Options::small())];
        let mut arena = Arena::new(&mut memory);
        let before = arena.available();
        let refused = KdTree::build(&shapes, &mut arena, &Options::small()).map(|tree| tree.depth());
        assert_eq!(refused, Err(BuildError::Bounds { primitive: 5 }));
        assert_eq!(arena.available(), before);
        assert_eq!(List::new(&shapes).map(|_| ()), Err(BuildError::Bounds { primitive: 5 }));
    }
}

#[test]
fn numbers_of_references_grow_to_32_bits() {
    // 65,536 is the last count with narrow references.
    for count in [65_535, 65_536, 65_537] {
        let boxes = |i: u32| Aabb::new(Vec3::splat((i / 3) as f32), Vec3::splat((i / 3 + 1) as f32));
        let shapes = hitscan::from_fn(count, boxes, |i, _| Some(i as f32));
        let mut memory = vec![0; KdTree::words(count as usize, &Options::small())];
        let tree = build(&shapes, &mut memory, &Options::small()).unwrap();
        let scene = Scene::new(KdTree::open(tree.as_words()).unwrap(), &shapes).unwrap();
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        let along = hitscan::Ray::new(Vec3::splat(((count - 20) / 3) as f32 + 0.5), Vec3::ONE);
        assert_eq!(scene.closest_hit(&along), list.closest_hit(&along));
        assert_eq!(list.hits(&along).last().map(|hit| hit.primitive), Some(count - 1));
        assert_eq!(scene.hits(&along).last(), list.hits(&along).last());
    }
}

#[test]
fn nothing_can_be_built_and_hit() {
    let nothing = (Mesh::new(&[], &[[0_u16; 3]; 0]).unwrap(), Spheres::new(&[]).unwrap());
    let mut memory = vec![0; KdTree::words(0, &Options::fast())];
    let scene = Scene::new(build(&nothing, &mut memory, &Options::fast()).unwrap(), &nothing).unwrap();
    let mut random = Random::new(5);
    for _ in 0..1000 {
        let ray = adversarial_ray(&mut random, 2, &[Vec3::ZERO, Vec3::X, Vec3::Y]);
        assert!(scene.closest_hit(&ray).is_none() && !scene.any_hit(&ray) && scene.hits(&ray).count() == 0);
    }
}
