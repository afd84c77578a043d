//! Building stays near linear, whatever the primitives are: counted by what the builder asks of them.

use std::cell::Cell;

use crate::common::{
    Random, adversarial_ray,
    meshes::{Triangles, crossing, fan, hair, identical, shrinking},
    plans::presets,
};
use hitscan::{
    Hit, Mesh, PreparedRay, Primitives, Scene, Span,
    accel::{Hierarchy, Inside, Plan, Structure},
    bake, dualsplit,
    geometry::Aabb,
    kdtree,
    query::Progress,
};

/// Triangles that count how often a builder asks for their bounds, whole or clipped.
struct Watched<'a> {
    mesh: Mesh<'a>,
    asked: Cell<u64>,
}

impl Primitives for Watched<'_> {
    fn len(&self) -> u32 {
        self.mesh.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.asked.set(self.asked.get() + 1);
        self.mesh.bounds(index)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.mesh.intersect(index, ray, span)
    }

    fn is_certified(&self, index: u32) -> bool {
        self.mesh.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.asked.set(self.asked.get() + 1);
        self.mesh.clip(index, cell)
    }
}

/// How often each of `count` triangles is asked for its bounds, and the bytes that it takes.
fn effort(adversary: fn(usize) -> Triangles, count: usize, plan: &Plan) -> (f64, f64) {
    let (vertices, triangles) = adversary(count);
    let watched = Watched { mesh: Mesh::new(&vertices, &triangles[..]).unwrap(), asked: Cell::new(0) };
    let words = bake::build(&watched, plan).unwrap();
    (watched.asked.get() as f64 / count as f64, words.len() as f64 * 4.0 / count as f64)
}

/// A name, and triangles of a number.
type Adversary = (&'static str, fn(usize) -> Triangles);

const ADVERSARIES: [Adversary; 5] =
    [("identical", identical), ("crossing", crossing), ("fan", fan), ("hair", hair), ("shrinking", shrinking)];

/// Whether a plan weighs what it divides; the others stop where the bytes end.
fn weighs(plan: &Plan) -> bool {
    match plan {
        Plan::KdTree(options) | Plan::CompactKdTree(options) => options.split == kdtree::Split::Sah,
        Plan::Grid(_) => false,
        _ => true,
    }
}

#[test]
fn twice_as_many_primitives_take_hardly_more_than_twice_the_work() {
    for (adversary, triangles) in ADVERSARIES {
        for (label, plan) in presets().iter().filter(|(_, plan)| weighs(plan)) {
            let [few, many] = [10_000, 20_000].map(|count| effort(triangles, count, plan));
            println!("{adversary}, {label}: {few:.1?} and {many:.1?} asked and bytes per triangle");
            assert!(many.0 * 2.0 < few.0 * 2.6, "{adversary}, {label}: {few:?} {many:?}");
            // A quick builder keeps no boxes: it asks once on each of its 28 levels, and where all are in one place twice.
            let is_quick = matches!(plan, Plan::DualSplit(options) if options.method == dualsplit::Method::Quick);
            let most = if is_quick { 57.0 } else { 14.0 };
            assert!(many.0 <= most, "{adversary}, {label}: {many:?}");
        }
    }
}

#[test]
fn work_and_bytes_per_primitive_are_bounded() {
    const COUNT: usize = 2048;
    for (adversary, triangles) in ADVERSARIES {
        for (label, plan) in presets() {
            let (asked, bytes) = effort(triangles, COUNT, &plan);
            // Slabs, rows and cells of a grid each ask; what they hold is bounded by its bytes.
            let most = if matches!(plan, Plan::Grid(_)) { 128.0 } else { 20.0 };
            assert!(asked <= most * (COUNT as f64).log2(), "{adversary}, {label}: asked {asked} times");
            assert!(bytes <= 205.0, "{adversary}, {label}: {bytes} bytes");
        }
    }
}

/// How many nodes a structure has: cells of a grid, pairs or nodes with their leaves of a tree.
fn nodes(structure: &Structure) -> u32 {
    match structure {
        Structure::Grid(grid) => return grid.resolution().into_iter().product(),
        // Carves are nodes that the hierarchy does not tell; each node takes a word at least.
        Structure::DualSplit(tree) => return tree.ordered_words().count() as u32,
        _ => {}
    }
    let mut cells: Vec<_> = structure.root().into_iter().collect();
    let mut nodes = 0;
    while let Some(cell) = cells.pop() {
        nodes += 1;
        if let Inside::Cells(inside) = Hierarchy::open(structure, &cell) {
            cells.extend(inside.into_iter().flatten());
        }
    }
    nodes
}

#[test]
fn no_ray_visits_more_nodes_than_there_are() {
    let mut random = Random::new(15);
    for (adversary, triangles) in ADVERSARIES {
        let (vertices, triangles) = triangles(300);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for (label, plan) in presets() {
            let words = bake::build(&mesh, &plan).unwrap();
            let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &mesh).unwrap();
            let most = nodes(scene.accelerator());
            for _ in 0..200 {
                let family = random.pick(&[0, 2, 6]);
                let ray = adversarial_ray(&mut random, family, &vertices);
                let ended = matches!(scene.begin(&ray).advance(most), Progress::Done(_));
                assert!(ended, "{adversary}, {label}: more than {most} nodes: {ray:?}");
            }
        }
    }
}
