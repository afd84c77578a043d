//! Every query of every scene.

use core::hint::black_box;

use hitscan::{
    Accelerator, Arena, Hit, Instance, Instances, LatticeMesh, LatticeScene, List, Mesh, Primitives, Scene,
    accel::{Bounded, Hierarchy, LatticeAccelerator, Structure},
    error::BuildError,
    geometry::Transform,
    primitives::{Indices, LatticeTriangles, Order, Proximity, Renumbering, Reordered, Spheres},
};

use crate::{
    input::{aabb, float, matrix, ray, some, sphere, vector, word},
    plan,
};

/// Casts rays at meshes, spheres and both together, with and without a tree.
pub fn all() {
    let corners = || [word() as u16, word() as u16, word() as u16];
    let (mut vertices, mut triangles, mut masks, mut balls) = (None, None, None, None);
    let mesh = Mesh::new(some(vector, &mut vertices), some(corners, &mut triangles));
    let Ok(mesh) = mesh.and_then(|mesh| mesh.with_masks(some(word, &mut masks))) else { return };
    let Ok(spheres) = Spheres::new(some(sphere, &mut balls)) else { return };
    with(&mesh);
    lattice(mesh.indices());
    with(&spheres);
    with(&(mesh, spheres));
    let (mut numbers, mut places) = (None, None);
    let orders = (Order::Wide(some(word, &mut numbers)), Order::Wide(some(word, &mut places)));
    if let Ok(numbers) = Renumbering::new(orders.0, orders.1)
        && let Ok(reordered) = Reordered::new(mesh, numbers)
    {
        with(&reordered);
    }
}

fn lattice(indices: Indices<'_>) {
    let mut numbers = None;
    let numbers = some(|| [word() as u16, word() as u16, word() as u16], &mut numbers);
    if let Ok(mesh) = LatticeMesh::new(&aabb(), numbers, indices) {
        black_box(mesh.positions().last());
        with(&mesh);
        whole(List::new(&mesh), mesh);
        let mut memory = [0; 1024];
        let mut arena = Arena::new(black_box(memory.as_mut_slice()));
        match Structure::build(&mesh, &mut arena, &plan::any()) {
            Ok(Structure::DualSplit(tree)) => whole(Ok(tree), mesh),
            Ok(Structure::CompactKdTree(tree)) => whole(Ok(tree), mesh),
            _ => {}
        }
    }
}

fn whole<A: LatticeAccelerator>(structure: Result<A, BuildError>, mesh: impl LatticeTriangles) {
    let Ok(structure) = structure else { return };
    let Ok(scene) = LatticeScene::new(structure, mesh) else { return };
    black_box((scene.closest_hit(&ray()), scene.any_hit(&ray())));
    for ray in scene.space().rays(vector(), vector(), vector(), word()).flatten() {
        black_box((scene.closest_hit_along(&ray), scene.any_hit_along(&ray)));
    }
}

fn with<P: Proximity>(primitives: &P) {
    if let Ok(list) = List::new(primitives) {
        cast(Scene::new(list, primitives));
        cast(Scene::new(Bounded::new((sphere(), list.bounds()), list), primitives));
        near(Scene::new(list, primitives));
        if let Ok(scene) = Scene::new(list, primitives) {
            placed(scene);
        }
    }
    let mut memory = [0; 1024];
    let mut arena = Arena::new(black_box(memory.as_mut_slice()));
    if let Ok(structure) = Structure::build(primitives, &mut arena, &plan::any()) {
        cast(Scene::new(structure, primitives));
        near(Scene::new(structure, primitives));
    }
}

fn placed<A: Hierarchy, P: Proximity>(scene: Scene<A, P>) {
    let Ok(transform) = Transform::new(matrix(), vector()) else { return };
    let (scenes, mut places) = ([scene], [Instance::new(word(), transform)]);
    let Ok(instances) = Instances::place(black_box(&scenes), black_box(&mut places)) else { return };
    if let Ok(similar) = instances.similar()
        && let Ok(list) = List::new(&similar)
    {
        cast(Scene::new(list, similar));
        near(Scene::new(list, similar));
    }
}

fn near<A: Hierarchy, P: Proximity, E>(scene: Result<Scene<A, P>, E>) {
    let Ok(scene) = scene else { return };
    black_box(scene.nearest_point(vector(), float()));
    black_box(scene.nearest_point_where(vector(), float(), |number| number != word()));
    black_box(scene.any_overlap(&sphere()));
    scene.overlaps(&sphere()).for_each(|nearest| _ = black_box(nearest));
}

fn cast<A: Accelerator, P: Primitives, E>(scene: Result<Scene<A, P>, E>) {
    let Ok(scene) = scene else { return };
    let keep = |hit: &Hit| hit.primitive != word();
    black_box(scene.closest_hit(&ray()));
    black_box(scene.closest_hit_where(&ray(), keep));
    black_box(scene.any_hit(&ray()));
    black_box(scene.any_hit_where(&ray(), keep));
    scene.hits(&ray()).for_each(|hit| _ = black_box(hit));
    let mut hits: heapless::Vec<Hit, 4> = heapless::Vec::new();
    scene.nearest_hits(&ray(), &mut hits);
    let mut query = scene.begin(&ray());
    black_box((query.advance(word()), query.advance(word())));
    let hit = black_box(Hit { t: 0.0, primitive: word() });
    let surface = scene.surface(&ray(), &hit);
    black_box((surface.start_towards(vector()), surface.normal_towards_ray(), scene.bounds(), hits));
}
