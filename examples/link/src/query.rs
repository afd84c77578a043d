//! Every query of every scene.

use core::hint::black_box;

use hitscan::{
    Accelerator, Arena, Hit, KdTree, List, Mesh, Primitives, Scene, accel::Bounded, kdtree::Options,
    primitives::Spheres,
};

use crate::input::{ray, some, sphere, vector, word};

/// Casts rays at meshes, spheres and both together, with and without a tree.
pub fn all() {
    let corners = || [word() as u16, word() as u16, word() as u16];
    let (mut vertices, mut triangles, mut masks, mut balls) = (None, None, None, None);
    let mesh = Mesh::new(some(vector, &mut vertices), some(corners, &mut triangles));
    let Ok(mesh) = mesh.and_then(|mesh| mesh.with_masks(some(word, &mut masks))) else { return };
    let Ok(spheres) = Spheres::new(some(sphere, &mut balls)) else { return };
    with(&mesh);
    with(&spheres);
    with(&(mesh, spheres));
}

fn with<P: Primitives>(primitives: &P) {
    if let Ok(list) = List::new(primitives) {
        cast(Scene::new(list, primitives));
        cast(Scene::new(Bounded::new((sphere(), list.bounds()), list), primitives));
    }
    let mut memory = [0; 1024];
    if let Ok(tree) = KdTree::build(primitives, &mut Arena::new(black_box(memory.as_mut_slice())), &Options::default())
    {
        cast(Scene::new(tree, primitives));
    }
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
