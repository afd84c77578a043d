//! What a picture's rays take with and without tiles: instructions per pixel of 240 x 240, of the first coarse picture, and
//! bytes of stack. Queries alone, no shading; the camera's rays and the search for entries included. Last, vertices on lattices:
//! in floating point, and in whole numbers, which take less stack.

#![no_std]
#![no_main]

use core::hint::black_box;

use firmware::{
    Answer, Counter,
    baked::{CONTEST, Contestant, LATTICES},
    entry, finish, for_structure, stack_of,
};
use hitscan::{
    CompactKdTree, DualSplit, Hit, LatticeMesh, Mesh, Scene,
    accel::{Accelerator, LatticeAccelerator},
    asset::Stored,
    glam::Vec3,
    query::ItemBuffer,
    render::{Camera, Caster, Tile, Tiles},
};
use semihosting::println;

/// Pixels in a row, and rows.
const SIDE: u32 = 240;

/// The hits of each `stride`th pixel of a tile, in each `stride`th row, one by one.
#[inline(never)]
fn plain<S: Caster>(scene: &S, camera: &Camera, tile: Tile, hits: &mut [Option<Hit>]) {
    for ((x, y), hit) in tile.pixels().zip(hits) {
        *hit = scene.closest_hit(&camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIDE, SIDE), 0);
    }
}

/// The same of all pixels at once, or else begun together; whether at once.
#[inline(never)]
fn tiled<S: Caster>(scene: &S, camera: &Camera, tile: Tile, items: &mut ItemBuffer, hits: &mut [Option<Hit>]) -> bool {
    let pencil = camera.pencil(&tile, SIDE, SIDE);
    let at_once = pencil.as_ref().is_some_and(|pencil| scene.closest_hits(pencil, items));
    if !at_once {
        begun(scene, camera, tile, 1, hits);
    }
    at_once
}

/// The same begun together.
#[inline(never)]
fn begun<S: Caster>(scene: &S, camera: &Camera, tile: Tile, stride: usize, hits: &mut [Option<Hit>]) {
    let entries = camera.bundle(&tile, SIDE, SIDE).map(|bundle| scene.enter(&bundle));
    let Some(entries) = entries.filter(|entries| !entries.is_empty()) else { return hits.fill(None) };
    let pixels = (tile.y..tile.y + tile.height)
        .step_by(stride)
        .flat_map(|y| (tile.x..tile.x + tile.width).step_by(stride).map(move |x| (x, y)));
    let whole = entries.is_everything();
    for ((x, y), hit) in pixels.zip(hits) {
        let ray = camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIDE, SIDE);
        *hit = if whole { scene.closest_hit(&ray, 0) } else { scene.closest_hit_from(&entries, &ray) };
    }
}

/// Prints the line of a contestant; whether tiles change no bit.
#[inline(never)]
fn measure<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    let scene: Scene<A, Mesh> = contestant.baked.scene_under();
    compare(counter, "", contestant.name, &scene)
}

/// The same of a mesh on a lattice.
#[inline(never)]
fn measure_floats<A: Accelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    compare(counter, "f32-", contestant.name, &contestant.baked.scene_on_lattice::<A>())
}

/// The same in whole numbers.
#[inline(never)]
fn measure_whole<A: LatticeAccelerator + Stored<'static>>(counter: &Counter, contestant: &Contestant) -> bool {
    compare(counter, "", contestant.name, &contestant.baked.lattice_scene::<A, LatticeMesh<'_>>())
}

fn compare<S: Caster>(counter: &Counter, kind: &str, name: &str, scene: &S) -> bool {
    let camera = Camera::framing(&scene.bounds(), Vec3::new(0.2, 0.3, -1.0), Vec3::Y);
    let mut answers = [Answer::NONE; 2];
    let (mut alone, mut together, mut coarse, mut stack) = (0, 0, 0, 0);
    let (mut items, mut hits) = (ItemBuffer::new(), [None; 64]);
    for tile in Tiles::new(SIDE, SIDE, 8, 8) {
        alone += counter.instructions(|| plain(scene, &camera, tile, &mut hits));
        hits.into_iter().for_each(|hit| answers[0].add(hit));
        let mut at_once = false;
        together += counter.instructions(|| at_once = tiled(scene, &camera, tile, &mut items, &mut hits));
        if at_once {
            (0..).zip(&mut hits).for_each(|(i, hit)| *hit = items.get(i % 8, i / 8));
        }
        hits.into_iter().for_each(|hit| answers[1].add(hit));
        if tile.x == tile.y {
            stack = stack.max(stack_of(&mut || _ = tiled(scene, &camera, tile, &mut items, &mut hits)));
        }
    }
    for tile in Tiles::new(SIDE, SIDE, 64, 64) {
        coarse += counter.instructions(|| begun(scene, &camera, tile, 8, &mut hits));
    }
    let filled = answers[0].hits * 100 / answers[0].rays;
    let share = (coarse * 1000 / together) as f32 / 10.0;
    let [alone, together] = [alone, together].map(|all| all / u64::from(SIDE * SIDE));
    println!("{kind}{name:width$} {filled:6} {alone:6} {together:6} {share:7.1} {stack:6}", width = 36 - kind.len());
    answers[0] == answers[1]
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    println!("                                     filled instructions    coarse  stack");
    println!("structure                                 %  alone  tiled        %  bytes");
    let mut same = true;
    for contestant in black_box(CONTEST).iter().filter(|contestant| contestant.triangles == 5000) {
        same &= for_structure!(contestant, measure)(&counter, contestant);
    }
    for contestant in black_box(LATTICES).iter().filter(|contestant| contestant.triangles == 5000) {
        same &= match contestant.name.split(' ').next() {
            Some("lattice-kdtree-compact") => {
                measure_floats::<CompactKdTree>(&counter, contestant)
                    & measure_whole::<CompactKdTree>(&counter, contestant)
            }
            _ => measure_whole::<DualSplit>(&counter, contestant),
        };
    }
    finish(same)
}
