//! hitscan beside parry3d: the same rays at the same torus knots, on the same board in the same run.
//!
//! hitscan reads structure and mesh from flash; parry builds its mesh on the heap. Its hits must be hitscan's, up to
//! rounding: it does not promise more.

#![no_std]
#![no_main]

extern crate alloc;

#[allow(unsafe_code)]
mod heap;

use core::hint::black_box;

use firmware::{
    Counter,
    baked::{CONTEST, Contestant},
    camera, entry, finish, stack_of,
};
use hitscan::{Accelerator, DualSplit, Grid, Hit, KdTree, Mesh, Primitives, Ray, Scene, asset::Stored, glam::Vec3};
use parry3d::{
    math::Vector,
    query::{self, RayCast},
    shape::{CompositeShapeRef, TriMesh},
};
use semihosting::println;

/// Whether two answers mean the same: the same triangle, or two in the same place, as at an edge.
fn agree(a: Option<Hit>, b: Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a.t - b.t).abs() < 1.0e-4,
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// Casts the camera's rays, prints a line of the table, and counts the answers that are not `expected`'s.
fn measure(
    counter: &Counter,
    name: &str,
    triangles: usize,
    (live, peak): (usize, usize),
    closest_hit: impl Fn(&Ray) -> Option<Hit>,
    any_hit: impl Fn(&Ray) -> bool,
    expected: impl Fn(&Ray) -> Option<Hit>,
) -> u32 {
    let (mut closest, mut any, mut stack, mut rays, mut wrong) = (0, 0, 0, 0, 0);
    for (index, ray) in (0..camera::HEIGHT).flat_map(camera::row).enumerate() {
        let ray = black_box(ray);
        let (mut hit, mut shadow) = (None, false);
        closest += counter.instructions(|| hit = closest_hit(&ray));
        any += counter.instructions(|| shadow = any_hit(&ray));
        let host = expected(&ray);
        wrong += u32::from(!agree(hit, host) || shadow != host.is_some());
        rays += 1;
        if index % 64 == 0 {
            stack = stack.max(stack_of(&mut || _ = black_box(closest_hit(&ray))));
        }
    }
    let (closest, any) = (closest / rays, any / rays);
    println!("{triangles:9} {name:28} {closest:7} {any:7} {live:8} {peak:8} {stack:6} {wrong:6}");
    wrong
}

/// A structure of hitscan, from flash.
fn hitscan<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> u32 {
    let scene: Scene<A, Mesh> = contestant.baked.scene_under();
    let cast = |ray: &Ray| scene.closest_hit(ray);
    measure(counter, contestant.name, contestant.triangles, (0, 0), cast, |ray| scene.any_hit(ray), cast)
}

/// parry's mesh, on the heap.
fn parry(counter: &Counter, contestant: &Contestant) -> u32 {
    let scene: Scene<KdTree, Mesh> = contestant.baked.scene_under();
    let mesh = scene.primitives();
    let vector = |v: Vec3| Vector::new(v.x, v.y, v.z);
    heap::peak();
    let before = heap::live();
    let vertices = mesh.vertices().iter().map(|&v| vector(v)).collect();
    let indices = (0..mesh.len()).filter_map(|triangle| mesh.indices().get(triangle)).collect();
    let mut built = None;
    let instructions = counter.instructions(|| built = TriMesh::new(vertices, indices).ok());
    let Some(trimesh) = built else { return 1 };
    let memory = (heap::live() - before, heap::peak() - before);
    let ray = |ray: &Ray| query::Ray::new(vector(ray.origin), vector(ray.direction));
    let wrong = measure(
        counter,
        "parry3d TriMesh",
        contestant.triangles,
        memory,
        |r| {
            let hit = CompositeShapeRef(&trimesh).cast_local_ray(&ray(r), f32::MAX, false);
            hit.map(|(primitive, t)| Hit { t, primitive })
        },
        |r| trimesh.intersects_local_ray(&ray(r), f32::MAX),
        |ray| scene.closest_hit(ray),
    );
    println!("          built in {instructions} instructions");
    wrong
}

#[entry]
fn main() -> ! {
    heap::start();
    let counter = Counter::new();
    println!("                                       instructions      bytes of RAM  stack  other");
    println!("triangles engine                       closest     any     live     peak  bytes   hits");
    let mut wrong = 0;
    for contestant in black_box(CONTEST) {
        wrong += match contestant.name {
            "grid fast" => hitscan::<Grid>(&counter, contestant),
            "kdtree balanced" => hitscan::<KdTree>(&counter, contestant) + parry(&counter, contestant),
            "kdtree fast" => hitscan::<KdTree>(&counter, contestant),
            "dual-split balanced" => hitscan::<DualSplit>(&counter, contestant),
            _ => 0,
        };
    }
    finish(wrong == 0)
}
