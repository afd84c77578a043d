//! What `bench` shows, of queries in whole numbers over the same knots on lattices.

#![no_std]
#![no_main]

use core::hint::black_box;

use firmware::{
    Answer, Counter,
    baked::{Contestant, LATTICES},
    camera, entry, finish, stack_of,
};
use hitscan::{
    CompactKdTree, DualSplit, LatticeMesh, Ray,
    accel::{Accelerator, LatticeAccelerator},
    asset::Stored,
    glam::Vec3,
};
use semihosting::println;

/// Where the rays of a row begin, the direction of the first, and what each next one has more; none has length 1.
fn line(y: u32) -> (Vec3, Vec3, Vec3) {
    let up = (0.5 - (y as f32 + 0.5) / camera::HEIGHT as f32) * 0.9 - 0.12;
    let left = (0.5 / camera::WIDTH as f32 - 0.5) * 1.2 - 0.17;
    (camera::EYE, Vec3::new(left, up, 1.0), Vec3::X * (1.2 / camera::WIDTH as f32))
}

/// Prints the line of a contestant; whether its hits are the host's.
#[inline(never)]
fn measure<A: LatticeAccelerator + Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    let Contestant { name, triangles, bytes, baked } = contestant;
    let scene = baked.lattice_scene::<A, LatticeMesh<'_>>();
    let (mut setup, mut closest, mut any, mut row) = (0, 0, 0, 0);
    let (mut shadows, mut row_hits, mut stack) = (0, 0, 0);
    let mut answer = Answer::NONE;
    for y in 0..camera::HEIGHT {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
        rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
        for ray in &rays {
            let (mut hit, mut shadow) = (None, false);
            setup += counter.instructions(|| _ = black_box(&scene.space().ray(ray)));
            closest += counter.instructions(|| hit = scene.closest_hit(ray));
            answer.add(hit);
            any += counter.instructions(|| shadow = scene.any_hit(ray));
            shadows += u32::from(shadow);
        }
        let (eye, first, step) = line(y);
        row += counter.instructions(|| {
            for ray in scene.space().rays(eye, first, step, camera::WIDTH).flatten() {
                row_hits += u32::from(black_box(scene.closest_hit_along(&ray)).is_some());
            }
        });
        if y % 8 == 0 {
            stack = stack.max(stack_of(&mut || _ = black_box(scene.closest_hit(&rays[32]))));
        }
    }
    let [closest, any, setup, row] = [closest, any, setup, row].map(|sum| sum / u64::from(answer.rays));
    let per_triangle = |bytes: usize| bytes as f32 / *triangles as f32;
    let (structure, all) = (per_triangle(*bytes), per_triangle(baked.bytes.len()));
    println!("{triangles:9} {name:32} {structure:9.2} {all:6.2} {closest:7} {any:7} {stack:5}");
    println!("          of it to make the ray {setup}; closest in rows {row}");
    if cfg!(any(target_abi = "eabihf", target_feature = "f")) {
        let floats = floats::<A>(counter, contestant);
        println!("          closest in floating point, by a Scene, {floats}");
    }
    // Directions are rounded otherwise in rows: at an edge they may differ.
    answer == baked.answer && shadows == answer.hits && row_hits.abs_diff(answer.hits) < 20
}

/// Instructions of a closest hit by the float path over the same asset.
fn floats<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> u64 {
    let scene = contestant.baked.scene_on_lattice::<A>();
    let mut closest = 0;
    let mut shadows = 0;
    for ray in (0..camera::HEIGHT).flat_map(camera::row) {
        closest += counter.instructions(|| _ = black_box(scene.closest_hit(black_box(&ray))));
        // Two callers, as in any program with shadows.
        shadows += u64::from(scene.any_hit(&ray));
    }
    black_box(shadows);
    closest / u64::from(camera::WIDTH * camera::HEIGHT)
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    println!("                                           bytes/triangle   instructions stack");
    println!("triangles structure                        structure all in closest     any bytes");
    let mut same = true;
    for contestant in black_box(LATTICES) {
        // Stacks as high as the trees are deep.
        same &= match (contestant.name, contestant.triangles) {
            ("lattice-kdtree-compact small", _) => measure::<CompactKdTree<20>>(&counter, contestant),
            ("lattice-kdtree-compact balanced", _) => measure::<CompactKdTree<24>>(&counter, contestant),
            ("lattice-dual-split fast", 1000) => measure::<DualSplit<12>>(&counter, contestant),
            (_, 1000) => measure::<DualSplit<11>>(&counter, contestant),
            _ => measure::<DualSplit<16>>(&counter, contestant),
        };
    }
    finish(same)
}
