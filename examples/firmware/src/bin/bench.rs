//! What each structure takes over torus knots of 1,000 and 5,000 triangles: bytes of flash per triangle, bytes of stack,
//! instructions per closest and per any hit. Memory besides the stack: none.

#![no_std]
#![no_main]

use core::hint::black_box;

use firmware::{
    Answer, Counter,
    baked::{CONTEST, Contestant, GRIDS, SOUPS},
    camera, entry, finish, for_structure, stack_of,
};
use hitscan::{
    Grid, KdTree, LatticeMesh, Mesh, Primitives, Ray, Scene, accel::Accelerator, asset::Stored, glam::Vec3, primitives::Soup,
};
use semihosting::println;

/// Prints the line of a contestant; whether its hits are the host's.
#[inline(never)]
fn measure<A, P>(counter: &Counter, contestant: &Contestant) -> bool
where
    A: Accelerator + Stored<'static>,
    P: Primitives + Stored<'static>,
{
    let Contestant { name, triangles, bytes, baked } = contestant;
    let scene: Scene<A, P> = baked.scene_of();
    let (mut closest, mut any, mut shadows, mut stack) = (0, 0, 0, 0);
    let mut answer = Answer::NONE;
    for y in 0..camera::HEIGHT {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
        rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
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
    let (structure, all) = (per_triangle(*bytes), per_triangle(baked.bytes.len()));
    println!("{triangles:9} {name:24} {structure:9.2} {all:6.2} {closest:7} {any:7} {stack:5}");
    answer == baked.answer && shadows == answer.hits
}

/// The same of one over a mesh.
fn measure_mesh<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    measure::<A, Mesh>(counter, contestant)
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    println!("                                   bytes/triangle   instructions stack");
    println!("triangles structure                structure all in closest     any bytes");
    let mut same = true;
    for contestant in black_box(CONTEST) {
        same &= for_structure!(contestant, measure_mesh)(&counter, contestant);
    }
    for contestant in black_box(GRIDS) {
        same &= match contestant.name.split(' ').next() {
            Some("grid") => measure::<Grid, Mesh>(&counter, contestant),
            _ => measure::<Grid, LatticeMesh>(&counter, contestant),
        };
    }
    for contestant in black_box(SOUPS) {
        same &= match contestant.name.split('-').next() {
            Some("grid") => measure::<Grid, Soup>(&counter, contestant),
            _ => measure::<KdTree, Soup>(&counter, contestant),
        };
    }
    finish(same)
}
