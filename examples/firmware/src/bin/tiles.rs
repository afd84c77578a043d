//! What a picture's own rays take with and without tiles: instructions per pixel of 240 x 240.

#![no_std]
#![no_main]

use core::hint::black_box;

use firmware::{
    Answer, Counter,
    baked::{CONTEST, Contestant},
    entry, finish,
};
use hitscan::{
    Bvh, CompactKdTree, DualSplit, Grid, KdTree, Mesh, Octree, Scene,
    accel::Accelerator,
    asset::Stored,
    glam::Vec3,
    render::{Camera, Tiles},
};
use semihosting::println;

const SIDE: u32 = 240;

#[inline(never)]
fn measure<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    let scene: Scene<A, Mesh> = contestant.baked.scene_under();
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.2, 0.3, -1.0), Vec3::Y);
    let pixels = u64::from(SIDE * SIDE);
    let mut answers = [Answer::NONE; 2];
    let [mut plain, mut tiled, mut enters, mut count] = [0; 4];
    for tile in Tiles::new(SIDE, SIDE, 8, 8) {
        let mut hits = [None; 64];
        plain += counter.instructions(|| {
            for ((x, y), hit) in tile.pixels().zip(&mut hits) {
                *hit = scene.closest_hit(&camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIDE, SIDE));
            }
        });
        hits.into_iter().for_each(|hit| answers[0].add(hit));
        let mut entries = None;
        let enter = counter.instructions(|| entries = camera.bundle(&tile, SIDE, SIDE).map(|bundle| scene.enter(&bundle)));
        let entries = entries.unwrap();
        enters += enter;
        count += entries.iter().count() as u64;
        tiled += enter + counter.instructions(|| {
            if entries.is_empty() {
                hits.fill(None);
                return;
            }
            for ((x, y), hit) in tile.pixels().zip(&mut hits) {
                *hit = scene.closest_hit_from(&entries, &camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIDE, SIDE));
            }
        });
        hits.into_iter().for_each(|hit| answers[1].add(hit));
    }
    println!("{:24} {:6} {:6} {:6} {:4} {:2} % hit", contestant.name, plain / pixels, tiled / pixels, enters/900, count, answers[0].hits * 100 / answers[0].rays);
    answers[0] == answers[1]
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    let mut same = true;
    for contestant in black_box(CONTEST).iter().filter(|c| c.triangles == 5000) {
        let measure = match contestant.name.split(' ').next() {
            Some("grid") => measure::<Grid>,
            Some("octree") => measure::<Octree>,
            Some("kdtree") => measure::<KdTree>,
            Some("kdtree-compact") => measure::<CompactKdTree>,
            Some("bvh") => measure::<Bvh>,
            _ => measure::<DualSplit>,
        };
        for (most, opens) in [(1, 20), (2, 10), (2,20), (4, 16), (4, 32), (8, 32), (12, 48)] {
            hitscan::accel::TUNE[0].store(most, core::sync::atomic::Ordering::Relaxed);
            hitscan::accel::TUNE[1].store(opens, core::sync::atomic::Ordering::Relaxed);
            semihosting::print!("{most:2} {opens:2} ");
            same &= measure(&counter, contestant);
        }
    }
    finish(same)
}
