//! How far back a ray may reach is no matter of work: what lies before the scene is skipped, however much it is.

use std::cell::Cell;

use crate::common::{Random, meshes, plans::presets};
use hitscan::{
    Mesh, Ray, Scene,
    accel::{Counted, Structure},
    bake,
    glam::Vec3,
    primitives,
};

/// Nodes and triangles looked at for rays through a scene that begin so far before it.
fn work(label: &str, structure: Structure<'_>, mesh: Mesh<'_>, t_min: f32) -> u64 {
    let (nodes, tests) = (Cell::new(0), Cell::new(0));
    let scene = Scene::new(Counted::new(structure, &nodes), primitives::Counted::new(mesh, &tests)).unwrap();
    let mut random = Random::new(91);
    let mut hits = 0;
    for _ in 0..400 {
        let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
        let (origin, target) = (point(6.0), point(2.0));
        let ray = Ray::new(origin, (target - origin).normalize()).starting_at(t_min);
        // From before and from behind.
        hits += usize::from(scene.closest_hit(&ray).is_some());
        hits += usize::from(scene.closest_hit(&ray.up_to(0.0)).is_some());
    }
    assert!(hits > 300, "{label}: {hits}");
    nodes.get() + tests.get()
}

#[test]
fn rays_that_reach_back_without_end_take_no_more_work() {
    let (vertices, triangles) = meshes::random(3000, 0.3);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for (label, plan) in presets() {
        let words = bake::build(&mesh, &plan).unwrap();
        let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
        let near = work(label, structure, mesh, -8.0);
        for t_min in [-1.0e3, -1.0e38, f32::NEG_INFINITY] {
            let far = work(label, structure, mesh, t_min);
            println!("{label} {t_min}: {far} {near}");
            assert!(far * 100 <= near * 102, "{label}: {far} in place of {near} for a ray from {t_min}");
        }
    }
}
