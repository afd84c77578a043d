//! What each structure takes over torus knots of 1,000 and 5,000 triangles: bytes of flash per triangle, bytes of stack,
//! instructions per closest and per any hit. Memory besides the stack: none. At the end the same of rays along axes.

#![no_std]
#![no_main]

use core::hint::black_box;

use firmware::{
    Answer, Counter,
    baked::{ALONG, CONTEST, Contestant, GRIDS, SOUPS},
    camera, entry, finish, for_structure, stack_of,
};
use hitscan::{
    Grid, KdTree, LatticeMesh, Mesh, Primitives, Ray, Scene,
    accel::Accelerator,
    asset::Stored,
    glam::Vec3,
    primitives::{QuadMesh, Soup},
};
use semihosting::println;

/// A row of the camera.
fn row(y: u32) -> camera::Row {
    let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
    rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
    rays
}

/// Prints the line of a contestant; whether its hits are the host's.
fn measure<A, P>(counter: &Counter, contestant: &Contestant) -> bool
where
    A: Accelerator + Stored<'static>,
    P: Primitives + Stored<'static>,
{
    measure_view::<A, P>(counter, contestant, ("", &contestant.baked.answer), row)
}

/// The same for a view of this name, in which this is hit.
#[inline(never)]
fn measure_view<A, P>(
    counter: &Counter,
    contestant: &Contestant,
    (view, expected): (&str, &Answer),
    row: impl Fn(u32) -> camera::Row,
) -> bool
where
    A: Accelerator + Stored<'static>,
    P: Primitives + Stored<'static>,
{
    let Contestant { name, triangles, bytes, baked } = contestant;
    let scene: Scene<A, P> = baked.scene_of();
    let (mut closest, mut any, mut shadows, mut stack) = (0, 0, 0, 0);
    let mut answer = Answer::NONE;
    for y in 0..camera::HEIGHT {
        let rays = row(y);
        for ray in &rays {
            let (mut hit, mut shadow) = (None, false);
            closest += counter.instructions(|| hit = scene.closest_hit(ray));
            any += counter.instructions(|| shadow = scene.any_hit(ray));
            answer.add(hit);
            shadows += u32::from(shadow);
        }
        if y % 8 == 0 {
            stack = stack.max(stack_of(&mut || _ = black_box(scene.closest_hit(&rays[32]))));
        }
    }
    let (closest, any) = (closest / u64::from(answer.rays), any / u64::from(answer.rays));
    let per_triangle = |bytes: usize| bytes as f32 / *triangles as f32;
    let (own, all) = (per_triangle(*bytes), per_triangle(baked.bytes.len()));
    let (structure, plan) = name.split_once(' ').unwrap_or((name, ""));
    let width = 29 - structure.len() - view.len();
    println!("{triangles:9} {structure}{view} {plan:width$} {own:9.2} {all:6.2} {closest:7} {any:7} {stack:5}");
    answer == *expected && shadows == answer.hits
}

/// Prints the lines of rays along axes; whether they hit what the list says.
fn measure_along<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    let answers = ALONG.iter().find(|(triangles, _)| *triangles == contestant.triangles);
    let Some((_, [level, parallel])) = answers else { return true };
    measure_view::<A, Mesh>(counter, contestant, ("-level", level), camera::level)
        & measure_view::<A, Mesh>(counter, contestant, ("-parallel", parallel), camera::parallel)
}

/// The same of one over a mesh.
fn measure_mesh<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    measure::<A, Mesh>(counter, contestant)
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    println!("                                         bytes/triangle   instructions stack");
    println!("triangles structure                      structure all in closest     any bytes");
    let mut same = true;
    for contestant in black_box(CONTEST) {
        same &= for_structure!(contestant, measure_mesh)(&counter, contestant);
    }
    // A micro:bit has no room for more.
    if cfg!(not(small)) {
        same &= more(&counter);
    }
    finish(same)
}

/// Prints the other lines; whether all hits are the host's.
fn more(counter: &Counter) -> bool {
    let mut same = true;
    for contestant in black_box(GRIDS) {
        same &= match contestant.name.split(' ').next() {
            Some("grid") => measure::<Grid, Mesh>(counter, contestant),
            Some("kdtree-quads") => measure::<KdTree, QuadMesh<Mesh>>(counter, contestant),
            Some("grid-quads") => measure::<Grid, QuadMesh<Mesh>>(counter, contestant),
            _ => measure::<Grid, QuadMesh<LatticeMesh>>(counter, contestant),
        };
    }
    for contestant in black_box(SOUPS) {
        same &= match contestant.name.split('-').next() {
            Some("grid") => measure::<Grid, Soup>(counter, contestant),
            _ => measure::<KdTree, Soup>(counter, contestant),
        };
    }
    for contestant in black_box(CONTEST) {
        same &= match contestant.name {
            "grid fast" => measure_along::<Grid>(counter, contestant),
            "kdtree fast" => measure_along::<KdTree>(counter, contestant),
            _ => true,
        };
    }
    same
}
