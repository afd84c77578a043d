//! What a picture's rays take with and without tiles: instructions per pixel of 240 x 240, and bytes of stack; and in passes, rough
//! at first: instructions per pixel, and what of a picture's the first pass takes, in passes and in tiles. Queries alone, no
//! shading; the camera's rays and the search for entries included. Last, vertices on lattices: in floating point, and in whole
//! numbers, which take less stack.

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
    accel::{Accelerator, Entries, LatticeAccelerator},
    asset::Stored,
    glam::Vec3,
    query::ItemBuffer,
    render::{Camera, Caster, Interlaced, Tile, Tiles},
};
use semihosting::println;

/// Pixels in a row, and rows.
const SIDE: u32 = 240;

/// The hits of a tile's pixels, one by one.
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
        begun(scene, camera, tile, hits);
    }
    at_once
}

/// The same begun together.
#[inline(never)]
fn begun<S: Caster>(scene: &S, camera: &Camera, tile: Tile, hits: &mut [Option<Hit>]) {
    let entries = camera.bundle(&tile, SIDE, SIDE).map(|bundle| scene.enter(&bundle));
    let Some(entries) = entries.filter(|entries| !entries.is_empty()) else { return hits.fill(None) };
    for (pixel, hit) in tile.pixels().zip(hits) {
        *hit = hit_from(scene, camera, &entries, pixel);
    }
}

/// The hit of a pixel.
#[inline(always)]
fn hit_from<S: Caster>(scene: &S, camera: &Camera, entries: &Entries, (x, y): (u32, u32)) -> Option<Hit> {
    let ray = camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIDE, SIDE);
    if entries.is_everything() { scene.closest_hit(&ray, 0) } else { scene.closest_hit_from(entries, &ray) }
}

/// How many of the first pixels in passes hit something, begun together where they are neighbours.
#[inline(never)]
fn in_passes<S: Caster>(scene: &S, camera: &Camera, count: usize) -> u32 {
    let (mut hits, mut begun) = (0, None);
    let mut pixels = Interlaced::new(SIDE, SIDE);
    for _ in 0..count {
        let Some(Tile { x, y, .. }) = pixels.next() else { break };
        let tile = pixels.tile();
        if begun.as_ref().is_none_or(|(at_hand, _)| *at_hand != tile) {
            begun = camera.bundle(&tile, SIDE, SIDE).map(|bundle| (tile, scene.enter(&bundle)));
        }
        if let Some((_, entries)) = begun.as_ref().filter(|(_, entries)| !entries.is_empty()) {
            hits += u32::from(hit_from(scene, camera, entries, (x, y)).is_some());
        }
    }
    hits
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
    let (mut alone, mut alone_stack, mut together, mut stack) = (0, 0, 0, 0);
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
            alone_stack = alone_stack.max(stack_of(&mut || plain(scene, &camera, tile, &mut hits)));
            stack = stack.max(stack_of(&mut || _ = tiled(scene, &camera, tile, &mut items, &mut hits)));
        }
    }
    let (pixels, mut hits) = ((SIDE * SIDE) as usize, 0);
    let [first, passes] =
        [pixels / 64, pixels].map(|count| counter.instructions(|| hits = in_passes(scene, &camera, count)));
    let filled = answers[0].hits * 100 / answers[0].rays;
    let [of_passes, of_tiles] = [passes, together].map(|all| (first * 1000 / all) as f32 / 10.0);
    let [alone, together, passes] = [alone, together, passes].map(|all| all / pixels as u64);
    let width = 36 - kind.len();
    println!(
        "{kind}{name:width$} {filled:6} {alone:6} {alone_stack:6} {together:6} {stack:6} {passes:7} {of_passes:5.1} {of_tiles:5.1}"
    );
    answers[0] == answers[1] && answers[0].hits == hits
}

#[entry]
fn main() -> ! {
    let counter = Counter::new();
    println!("                                     filled     alone      in tiles in passes, the first of  ");
    println!("structure                                 %        stack         stack             %  tiles %");
    let mut same = true;
    for contestant in black_box(CONTEST).iter().filter(|contestant| contestant.triangles == 5000) {
        same &= for_structure!(contestant, measure)(&counter, contestant);
    }
    for contestant in black_box(LATTICES).iter().filter(|contestant| contestant.triangles == 5000) {
        // Stacks as high as the trees are deep.
        same &= match contestant.name {
            "lattice-kdtree-compact small" => {
                measure_floats::<CompactKdTree<20>>(&counter, contestant)
                    & measure_whole::<CompactKdTree<20>>(&counter, contestant)
            }
            "lattice-kdtree-compact balanced" => {
                measure_floats::<CompactKdTree<24>>(&counter, contestant)
                    & measure_whole::<CompactKdTree<24>>(&counter, contestant)
            }
            _ => measure_whole::<DualSplit<16>>(&counter, contestant),
        };
    }
    finish(same)
}
