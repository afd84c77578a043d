//! Stack bytes of the queries and of the builder, found by painting.

#![no_std]
#![no_main]

use firmware::{
    baked::{KNOT, REBUILT, REBUILT_TRIANGLES},
    camera, entry, finish, stack_of,
};
use hitscan::{Arena, KdTree, Mesh, Ray, kdtree::Options};
use semihosting::println;
use static_cell::ConstStaticCell;

const WORDS: usize = KdTree::words(REBUILT_TRIANGLES, &Options::small());

static MEMORY: ConstStaticCell<[u32; WORDS]> = ConstStaticCell::new([0; WORDS]);

/// What any query and the builder may take.
const LIMIT: usize = 3072;

/// The most that any of the camera's rays takes.
fn most(mut query: impl FnMut(&Ray)) -> usize {
    let rows = (0..camera::HEIGHT).step_by(8);
    rows.flat_map(|y| camera::row(y).step_by(8)).map(|ray| stack_of(&mut || query(&ray))).max().unwrap_or(0)
}

#[entry]
fn main() -> ! {
    let scene = KNOT.scene();
    let (mut hits, mut shadows) = (0, 0);
    let closest = most(|ray| hits += u32::from(scene.closest_hit(ray).is_some()));
    let any = most(|ray| shadows += u32::from(scene.any_hit(ray)));
    // Aimed at a corner: the slow tiers of the triangle test decide.
    let corners = scene.primitives().vertices();
    let from = corners[0] * 3.0;
    let exact = corners.iter().step_by(7).map(|&corner| Ray::between(from, corner).up_to(2.0));
    let exact = exact.map(|ray| stack_of(&mut || hits += u32::from(scene.closest_hit(&ray).is_some())));
    let exact = exact.max().unwrap_or(0);
    let mesh: Mesh = REBUILT.read();
    let mut arena = Arena::new(MEMORY.take());
    let mut built = None;
    let build = stack_of(&mut || built = KdTree::build(&mesh, &mut arena, &Options::small()).ok());

    println!("stack: closest_hit {closest} bytes, any_hit {any}, with exact tests {exact}, build {build}");
    let most = closest.max(any).max(exact).max(build);
    finish(hits > 0 && shadows > 0 && built.is_some() && most <= LIMIT)
}
