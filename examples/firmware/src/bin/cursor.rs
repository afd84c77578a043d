//! What the library's traversal cursor costs against a walk with an inlined closure: instructions per closest hit.

#![no_std]
#![no_main]

use firmware::{
    Answer, Counter, baked, camera, entry, figure, finish,
    inlined::{InlinedTree, views},
};
use hitscan::{Ray, glam::Vec3};
use semihosting::println;

/// The cursor may cost 5 % more than the inlined walk.
const LIMIT: f32 = 1.05;

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    let baked = core::hint::black_box(&baked::KNOT);
    let scene = baked.scene();
    let inlined = InlinedTree::new(scene.accelerator());

    let (mut by_cursor, mut by_closure) = (Answer::NONE, Answer::NONE);
    let (mut cursor, mut closure, mut prepare) = (0, 0, 0);
    let mut shadows = 0;
    for y in 0..camera::HEIGHT {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
        rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
        for ray in &rays {
            let (mut hit, views) = (None, views(ray));
            cursor += counter.instructions(|| hit = scene.closest_hit(ray));
            by_cursor.add(hit);
            closure += counter.instructions(|| hit = inlined.closest_hit(scene.primitives(), ray, &views));
            by_closure.add(hit);
            prepare += counter.instructions(|| _ = core::hint::black_box(ray.prepare()));
            // As in any program with shadows, the cursor has two callers, and is not inlined into its only one.
            shadows += u32::from(scene.any_hit(ray));
        }
    }
    let rays = u64::from(by_cursor.rays);
    let ratio = cursor as f32 / closure as f32;
    println!("{} instructions per ray by the cursor", cursor / rays);
    figure("cursor", "closest", cursor / rays);
    println!("{} by the inlined closure, ratio {ratio:.3}", closure / rays);
    println!("{} of them prepare the ray", prepare / rays);
    let same = by_cursor == baked.answer && by_closure == baked.answer && shadows == baked.answer.hits;
    finish(same && ratio <= LIMIT)
}
