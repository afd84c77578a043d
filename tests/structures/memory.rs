//! What every structure owes its memory, whatever the plan.

use hitscan::{
    Arena, List, Mesh, Primitives, Ray, Scene,
    accel::{Hierarchy, Plan, Structure},
    arena::Full,
    error::BuildError,
    from_fn,
    geometry::Aabb,
    glam::Vec3,
    grid, kdtree, octree,
    primitives::Spheres,
};

use crate::common::{
    Random, adversarial_ray, bits,
    meshes::{Triangles, crossing, identical, random, separate},
    plans,
};

/// The presets, and all ways to divide cells in each.
fn all_plans() -> impl Iterator<Item = Plan> {
    use kdtree::Split;
    let clips = [true, false];
    let kd = [kdtree::Options::small(), kdtree::Options::balanced(), kdtree::Options::fast()];
    let kd = kd.into_iter().flat_map(move |base| {
        [Split::Midpoint, Split::Median, Split::Sah]
            .into_iter()
            .flat_map(move |split| clips.map(|clip| Plan::KdTree(kdtree::Options { split, clip, ..base })))
    });
    let octrees = [octree::Options::small(), octree::Options::balanced(), octree::Options::fast()];
    let octrees = octrees.into_iter().flat_map(move |base| {
        [octree::Split::Middle, octree::Split::Sah]
            .into_iter()
            .flat_map(move |split| clips.map(|clip| Plan::Octree(octree::Options { split, clip, ..base })))
    });
    let grids = [grid::Options::small(), grid::Options::fast(), grid::Options::quick(), grid::Options::fast().fit(400)];
    let crowded = grid::Options { density: 90.0, bytes_per_primitive: 200, ..grid::Options::fast() };
    let grids = grids.into_iter().chain([crowded]).flat_map(move |base| {
        grid::Form::ALL
            .into_iter()
            .flat_map(move |form| clips.map(|clip| Plan::Grid(grid::Options { form, clip, ..base })))
    });
    let budgets = [Plan::KdTree(kdtree::Options::fast().fit(400)), Plan::Octree(octree::Options::fast().fit(400))];
    plans::presets().into_iter().map(|(_, plan)| plan).chain(kd).chain(octrees).chain(grids).chain(budgets)
}

fn build<'m, P: Primitives>(primitives: &P, memory: &'m mut [u32], plan: &Plan) -> Result<Structure<'m>, BuildError> {
    Structure::build(primitives, &mut Arena::new(memory), plan)
}

#[test]
fn what_is_not_clipped_lies_in_more_cells() {
    let (vertices, triangles) = random(200, 1.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for base in [Plan::KdTree(kdtree::Options::fast()), Plan::CompactKdTree(kdtree::Options::fast())]
        .into_iter()
        .chain([Plan::Octree(octree::Options::fast()), Plan::Grid(grid::Options::fast())])
    {
        let [clipped, whole] = [true, false].map(|clip| {
            let plan = match base {
                Plan::KdTree(options) => Plan::KdTree(kdtree::Options { clip, ..options }),
                Plan::CompactKdTree(options) => Plan::CompactKdTree(kdtree::Options { clip, ..options }),
                Plan::Octree(options) => Plan::Octree(octree::Options { clip, ..options }),
                Plan::Grid(options) => Plan::Grid(grid::Options { clip, ..options }),
                other => other,
            };
            let mut memory = vec![0; plan.words(triangles.len())];
            build(&mesh, &mut memory, &plan).unwrap().as_words().to_vec()
        });
        assert_ne!(clipped, whole, "{base:?}");
    }
}

/// Builds in arenas of every size behind an earlier tenant until it goes.
fn refuses_until_it_goes((vertices, triangles): &Triangles, plan: &Plan) {
    let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
    let (others, corners) = random(3, 1.0);
    let other = Mesh::new(&others, &corners[..]).unwrap();
    let least = Plan::KdTree(kdtree::Options { bytes_per_primitive: 8, ..kdtree::Options::small() });
    // What the tenant needs while it moves in, and what it then keeps.
    let mut memory = vec![0; least.words(3)];
    let needs = (0..).find(|&k| build(&other, &mut memory[..k], &least).is_ok()).unwrap();
    let keeps = build(&other, &mut memory, &least).unwrap().as_words().len();
    let list = Scene::new(List::new(&other).unwrap(), &other).unwrap();
    let mut random = Random::new(3);
    let rays: Vec<_> = (0..8).map(|_| adversarial_ray(&mut random, 2, &others)).collect();

    let enough = plan.words(triangles.len());
    let (mut memory, mut large) = (vec![0; keeps + enough + 100], vec![0; enough]);
    let expected = build(&mesh, &mut large, plan).expect("`words` suffice").as_words();
    let (mut promised, mut k) = (0, 0);
    let first = loop {
        let lodged = keeps + k >= needs;
        let mut arena = Arena::new(&mut memory[..if lodged { keeps + k } else { k }]);
        let tenant = lodged.then(|| Structure::build(&other, &mut arena, &least).unwrap());
        assert_eq!(arena.available(), k);
        match Structure::build(&mesh, &mut arena, plan) {
            Ok(structure) => {
                assert_eq!(structure.as_words(), expected, "another structure in a smaller arena: {plan:?}");
                assert_eq!(arena.available(), k - expected.len());
                break k;
            }
            Err(BuildError::Full(Full { at_least, available })) => {
                assert!(available == k && at_least > k, "{at_least} {available} {k} {plan:?}");
                assert_eq!(arena.available(), k);
                promised = promised.max(at_least);
            }
            Err(error) => panic!("{error}: {plan:?}"),
        }
        if let Some(tenant) = tenant {
            let opened = Structure::open(least.kind().unwrap(), tenant.as_words()).unwrap();
            let scene = Scene::new(opened, &other).unwrap();
            rays.iter().for_each(|ray| assert_eq!(bits(scene.closest_hit(ray)), bits(list.closest_hit(ray))));
        }
        k += 1;
    };
    assert!(promised <= first && first <= enough, "{promised} {first} {enough} {plan:?}");
    for k in (first..enough).step_by(1 + (enough - first) / 20) {
        assert_eq!(build(&mesh, &mut memory[..k], plan).unwrap().as_words(), expected, "{k} {plan:?}");
    }
}

#[test]
fn every_arena_is_large_enough_or_refused() {
    let meshes = [separate(vec![]), random(1, 1.0), random(2, 1.0), random(7, 1.0), random(40, 0.5), identical(20)];
    for mesh in &meshes {
        all_plans().for_each(|plan| refuses_until_it_goes(mesh, &plan));
    }
    let kd = kdtree::Options { intersection_cost: 20.0, ..kdtree::Options::fast() };
    let octree = octree::Options { intersection_cost: 20.0, ..octree::Options::fast() };
    for plan in [Plan::KdTree(kd), Plan::CompactKdTree(kd), Plan::Octree(octree)] {
        refuses_until_it_goes(&crossing(30), &plan);
    }
}

#[test]
fn absurd_numbers_need_absurd_memory() {
    let largest = [
        Plan::KdTree(kdtree::Options::fast().fit(usize::MAX)),
        Plan::CompactKdTree(kdtree::Options::fast().fit(usize::MAX)),
        Plan::Octree(octree::Options::fast().fit(usize::MAX)),
    ];
    for plan in plans::presets().into_iter().map(|(_, plan)| plan).chain(largest) {
        assert!(plan.words(usize::MAX) > usize::MAX / 2, "{plan:?}");
    }
}

#[test]
fn primitives_without_valid_bounds_are_named_and_leave_the_arena_alone() {
    let bad = [Aabb::EMPTY, Aabb::new(Vec3::NAN, Vec3::ONE), Aabb::new(Vec3::ZERO, Vec3::splat(1.0e38))];
    for (bad, (name, plan)) in bad.into_iter().flat_map(|bad| plans::presets().into_iter().map(move |p| (bad, p))) {
        let good = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let shapes = from_fn(9, |i| if i == 5 || i == 7 { bad } else { good }, |_, _| Some(1.0));
        let mut memory = vec![7; plan.words(9)];
        let mut arena = Arena::new(&mut memory);
        let before = arena.available();
        let refused = Structure::build(&shapes, &mut arena, &plan).map(|structure| structure.as_words().len());
        assert_eq!(refused, Err(BuildError::Bounds { primitive: 5 }), "{name}");
        assert_eq!(arena.available(), before);
        assert_eq!(List::new(&shapes).map(|_| ()), Err(BuildError::Bounds { primitive: 5 }));
    }
}

#[test]
fn numbers_of_references_grow_to_32_bits() {
    // 65,536 is the last count with narrow references.
    for count in [65_535, 65_536, 65_537] {
        let boxes = |i: u32| Aabb::new(Vec3::splat((i / 3) as f32), Vec3::splat((i / 3 + 1) as f32));
        let shapes = from_fn(count, boxes, |i, _| Some(i as f32));
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        let along = Ray::new(Vec3::splat(((count - 20) / 3) as f32 + 0.5), Vec3::ONE);
        assert_eq!(list.hits(&along).last().map(|hit| hit.primitive), Some(count - 1));
        let once = |name: &str| name.ends_with("small") || name.ends_with("quick");
        for (name, plan) in plans::presets().into_iter().filter(|(name, _)| once(name)) {
            let mut memory = vec![0; plan.words(count as usize)];
            let built = build(&shapes, &mut memory, &plan).unwrap();
            let scene = Scene::new(Structure::open(plan.kind().unwrap(), built.as_words()).unwrap(), &shapes).unwrap();
            assert_eq!(scene.closest_hit(&along), list.closest_hit(&along), "{name}");
            assert_eq!(scene.hits(&along).last(), list.hits(&along).last(), "{name}");
        }
    }
}

#[test]
fn nothing_can_be_built_and_hit() {
    let nothing = (Mesh::new(&[], &[[0_u16; 3]; 0]).unwrap(), Spheres::new(&[]).unwrap());
    for (name, plan) in plans::presets() {
        let mut memory = vec![0; plan.words(0)];
        let scene = Scene::new(build(&nothing, &mut memory, &plan).unwrap(), &nothing).unwrap();
        assert!(scene.accelerator().root().is_none(), "{name}");
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let ray = adversarial_ray(&mut random, 2, &[Vec3::ZERO, Vec3::X, Vec3::Y]);
            assert!(scene.closest_hit(&ray).is_none() && !scene.any_hit(&ray) && scene.hits(&ray).count() == 0);
        }
    }
}
