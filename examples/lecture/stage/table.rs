//! Work of structures on the rays of a camera, counted by decorators.

use std::cell::Cell;

use hitscan::{
    Mesh, Scene,
    accel::{Counted, Plan, Structure},
    bake, primitives,
};

/// Prints the heads of the columns.
pub fn head() {
    println!("{:34} {:>9} {:>9} {:>9} {:>9} {:>9}", "", "build", "B/tri", "nodes", "tests", "µs/ray");
}

/// Builds what `plan` says and prints what it costs, per triangle and per ray.
pub fn row(name: &str, mesh: &Mesh<'_>, plan: &Plan) -> super::Fallible {
    let (build, words) = super::timed(|| bake::build(mesh, plan));
    let words = words?;
    let structure = Structure::open(plan.kind().ok_or("a list has no words")?, &words)?;
    let rays = super::rays(&Scene::new(structure, mesh)?, 160);
    let (nodes, tests) = (Cell::new(0), Cell::new(0));
    let counted = Scene::new(Counted::new(structure, &nodes), primitives::Counted::new(mesh, &tests))?;
    let hits = rays.iter().filter(|ray| counted.closest_hit(ray).is_some()).count();
    let scene = Scene::new(structure, mesh)?;
    let (seconds, again) = super::timed(|| rays.iter().filter(|ray| scene.closest_hit(ray).is_some()).count());
    assert_eq!(hits, again);
    let (triangles, rays) = (mesh.indices().len() as f64, rays.len() as f64);
    let (bytes, nodes, tests) =
        (words.len() as f64 * 4.0 / triangles, nodes.get() as f64 / rays, tests.get() as f64 / rays);
    println!("{name:34} {:7.1}ms {bytes:9.1} {nodes:9.1} {tests:9.1} {:9.2}", build * 1.0e3, seconds / rays * 1.0e6);
    Ok(())
}
