//! What a ray costs by structure: instructions for its set-up, per node visited and per primitive tested, fitted by least
//! squares to every ray at every knot. Prints the rows of `hitscan`'s table of chips.

#![no_std]
#![no_main]

use core::{cell::Cell, hint::black_box};

use firmware::{
    Counter,
    baked::{CONTEST, Contestant, GRIDS, LATTICES},
    camera, entry, finish, stack_of,
};
use hitscan::{
    Bvh, CompactKdTree, DualSplit, Grid, KdTree, LatticeMesh, Mesh, Octree, Primitives, Ray, Scene,
    accel::{self, Accelerator, LatticeAccelerator},
    asset::Stored,
    geometry::Triangle,
    glam::Vec3,
    primitives::{self, QuadMesh},
};
use semihosting::{print, println};

/// Sums over rays, enough for the normal equations of `instructions = set-up + node * nodes + test * tests`.
#[derive(Default)]
struct Fit {
    /// Products of (1, nodes, tests) with (1, nodes, tests, instructions).
    sums: [[f64; 4]; 3],
    stack: usize,
}

impl Fit {
    fn add(&mut self, nodes: u64, tests: u64, instructions: u64) {
        let row = [1.0, nodes as f64, tests as f64, instructions as f64];
        for (sums, by) in self.sums.iter_mut().zip(row) {
            sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += by * value);
        }
    }

    /// Set-up, node and test, by elimination.
    fn solve(&self) -> [f64; 3] {
        let mut rows = self.sums;
        for pivot in 0..3 {
            let by = rows[pivot];
            for row in (0..3).filter(|&row| row != pivot) {
                let factor = rows[row][pivot] / by[pivot];
                rows[row].iter_mut().zip(by).for_each(|(value, by)| *value -= factor * by);
            }
        }
        [0, 1, 2].map(|k| rows[k][3] / rows[k][k])
    }
}

impl Fit {
    /// The same where it is known what a node takes: set-up and test.
    fn solve_with(&self, node: f64) -> [f64; 3] {
        let [[one, nodes, tests, all], _, [_, both, squares, products]] = self.sums;
        let (all, products) = (all - node * nodes, products - node * both);
        let test = (one * products - tests * all) / (one * squares - tests * tests);
        [(all - test * tests) / one, node, test]
    }
}

/// What adds the rays at a contestant.
type Measure = fn(&Counter, &Contestant, &mut Fit);

/// Floating point.
#[inline(never)]
fn floats<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant, fit: &mut Fit) {
    let scene: Scene<A, Mesh> = contestant.baked.scene_under();
    measure::<A, Mesh>(
        counter,
        contestant,
        fit,
        |ray| scene.closest_hit(ray).is_some(),
        |ray| scene.any_hit(ray),
        Mesh::triangle,
    );
}

/// The same over pairs of triangles.
#[inline(never)]
fn pairs<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant, fit: &mut Fit) {
    let scene: Scene<A, QuadMesh<Mesh>> = contestant.baked.scene_of();
    measure::<A, QuadMesh<Mesh>>(
        counter,
        contestant,
        fit,
        |ray| scene.closest_hit(ray).is_some(),
        |ray| scene.any_hit(ray),
        |pairs, index| pairs.mesh().triangle(2 * index),
    );
}

/// Whole numbers.
#[inline(never)]
fn integers<A>(counter: &Counter, contestant: &Contestant, fit: &mut Fit)
where
    A: LatticeAccelerator + Accelerator + Stored<'static>,
{
    let scene = contestant.baked.lattice_scene::<A, LatticeMesh>();
    measure::<A, LatticeMesh>(
        counter,
        contestant,
        fit,
        |ray| scene.closest_hit(ray).is_some(),
        |ray| scene.any_hit(ray),
        LatticeMesh::triangle,
    );
}

/// Adds the rays at a contestant: what the queries take, against what a counting scene visits.
#[inline(always)]
fn measure<A: Accelerator + Stored<'static>, P: Primitives + Stored<'static>>(
    counter: &Counter,
    contestant: &Contestant,
    fit: &mut Fit,
    closest_hit: impl Fn(&Ray) -> bool,
    any_hit: impl Fn(&Ray) -> bool,
    triangle: impl Fn(&P, u32) -> Triangle,
) {
    let (nodes, tests) = (Cell::new(0), Cell::new(0));
    let counted = Scene::new(
        accel::Counted::new(contestant.baked.read::<A>(), &nodes),
        primitives::Counted::new(contestant.baked.read::<P>(), &tests),
    );
    let counted = counted.expect("the same scene");
    for ray in (0..camera::HEIGHT).step_by(4).flat_map(camera::row) {
        let (before, tested) = (nodes.get(), tests.get());
        black_box(counted.closest_hit(&ray));
        let instructions = counter.instructions(|| _ = black_box(closest_hit(black_box(&ray))));
        fit.add(nodes.get() - before, tests.get() - tested, instructions);
    }
    // At corners the slow tiers of the triangle test decide: they take the most stack.
    let primitives = contestant.baked.read::<P>();
    let corners = (0..primitives.len()).step_by(29).map(|index| triangle(&primitives, index).a);
    let at_corners = corners.map(|corner| Ray::between(corner * 3.0 + Vec3::ONE, corner).up_to(2.0));
    for ray in camera::row(camera::HEIGHT / 2).step_by(8).chain(at_corners) {
        let closest = stack_of(&mut || _ = black_box(closest_hit(&ray)));
        let any = stack_of(&mut || _ = black_box(any_hit(&ray)));
        fit.stack = fit.stack.max(closest).max(any);
    }
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    let measures: [(&str, Measure); 10] = [
        ("grid", floats::<Grid>),
        ("grid-quads", pairs::<Grid>),
        ("octree", floats::<Octree>),
        ("kdtree", floats::<KdTree>),
        ("kdtree-quads", pairs::<KdTree>),
        ("kdtree-compact", floats::<CompactKdTree>),
        ("bvh", floats::<Bvh>),
        ("dual-split", floats::<DualSplit>),
        ("lattice-kdtree-compact", integers::<CompactKdTree>),
        ("lattice-dual-split", integers::<DualSplit>),
    ];
    let (mut plausible, mut node) = (true, 0.0);
    for (name, measure) in measures {
        let mut fit = Fit::default();
        let in_pairs = name.ends_with("-quads");
        // Finest grids are there for their bytes, except over pairs.
        let contestants = CONTEST.iter().chain(GRIDS.iter().filter(|_| in_pairs)).chain(LATTICES);
        let family = contestants.filter(|contestant| contestant.name.split(' ').next() == Some(name));
        family.for_each(|contestant| measure(&counter, contestant, &mut fit));
        // Over pairs a structure's walk is that over triangles, the line before, but nodes and tests are too much alike to be
        // told apart.
        let costs = if in_pairs { fit.solve_with(node) } else { fit.solve() };
        node = costs[1];
        print!("{name}");
        for cost in costs {
            plausible &= cost > 1.0;
            print!(",{cost:.0}");
        }
        println!(",{}", fit.stack);
    }
    finish(plausible)
}
