//! Instructions per ray and bytes per triangle of every structure, over torus knots of 1,000 and 5,000 triangles.

#![no_std]
#![no_main]

use firmware::{
    Answer, Counter,
    baked::{CONTEST, Contestant},
    camera, entry, finish, stack_of,
};
use hitscan::{
    Bvh, CompactKdTree, DualSplit, Grid, KdTree, Mesh, Octree, Ray, Scene, accel::Accelerator, asset::Stored,
    glam::Vec3,
};
use semihosting::println;

/// Prints the line of a contestant; whether its hits are the host's.
#[inline(never)]
fn measure<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    let scene: Scene<A, Mesh> = contestant.baked.scene_under();
    let (mut closest, mut any, mut shadows, mut stack) = (0, 0, 0, 0);
    let mut answer = Answer::NONE;
    for y in 0..camera::HEIGHT {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
        rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
        for ray in &rays {
            let (mut hit, mut shadow) = (None, false);
            closest += counter.instructions(|| hit = scene.closest_hit(ray));
            answer.add(hit);
            any += counter.instructions(|| shadow = scene.any_hit(ray));
            shadows += u32::from(shadow);
        }
        if y % 8 == 0 {
            stack = stack.max(stack_of(&mut || _ = core::hint::black_box(scene.closest_hit(&rays[32]))));
        }
    }
    let rays = u64::from(answer.rays);
    let bytes = contestant.bytes as f32 / contestant.triangles as f32;
    println!(
        "{:5} {:<24} {bytes:6.2} B/tri {:6} closest {:6} any {stack:5} B of stack",
        contestant.triangles,
        contestant.name,
        closest / rays,
        any / rays
    );
    answer == contestant.baked.answer && shadows == answer.hits
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    let mut same = true;
    for contestant in core::hint::black_box(CONTEST) {
        let measure = match contestant.name.split(' ').next() {
            Some("grid") => measure::<Grid>,
            Some("octree") => measure::<Octree>,
            Some("kdtree") => measure::<KdTree>,
            Some("kdtree-compact") => measure::<CompactKdTree>,
            Some("bvh") => measure::<Bvh>,
            _ => measure::<DualSplit>,
        };
        same &= measure(&counter, contestant);
    }
    finish(same)
}
