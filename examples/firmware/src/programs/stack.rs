//! Stack bytes of the queries, found by painting.

use hitscan::Ray;

use crate::{Board, baked::KNOT, camera, figure, stack_of};

/// The most that any of the camera's rays takes.
fn most(mut query: impl FnMut(&Ray)) -> usize {
    let rows = (0..camera::HEIGHT).step_by(8);
    rows.flat_map(|y| camera::row(y).step_by(8)).map(|ray| stack_of(&mut || query(&ray))).max().unwrap_or(0)
}

/// Queries in the kD-tree in flash, with and without the slow tiers of the triangle test.
pub fn run(_board: &mut Board) -> bool {
    let scene = KNOT.scene();
    let (mut hits, mut shadows) = (0, 0);
    let closest = most(|ray| hits += u32::from(scene.closest_hit(ray).is_some()));
    let any = most(|ray| shadows += u32::from(scene.any_hit(ray)));
    // Aimed at a corner: the slow tiers decide.
    let corners = scene.primitives().vertices();
    let from = corners[0] * 3.0;
    let exact = corners.iter().step_by(7).map(|&corner| Ray::between(from, corner).up_to(2.0));
    let exact = exact.map(|ray| stack_of(&mut || hits += u32::from(scene.closest_hit(&ray).is_some())));
    let exact = exact.max().unwrap_or(0);
    for (what, bytes) in [("closest", closest), ("any", any), ("exact", exact)] {
        figure("stack", what, bytes as u64);
    }
    hits > 0 && shadows > 0
}
