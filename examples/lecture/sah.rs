//! The surface area heuristic: against midpoints and medians, and as the lever between bytes and speed.
//!
//! `cargo run --release --features std --example sah`

mod stage;

use hitscan::{
    Mesh,
    accel::Plan,
    kdtree::{Options, Split},
};

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(200);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    stage::table::head();
    for split in [Split::Midpoint, Split::Median, Split::Sah] {
        for leaf_size in [1, 4, 16] {
            let options = Options { split, leaf_size, ..Options::fast() };
            stage::table::row(&format!("{split:?}, leaves of {leaf_size}"), &mesh, &Plan::KdTree(options))?;
        }
    }
    for intersection_cost in [0.1, 0.25, 0.5, 1.0, 2.0, 8.0] {
        let options = Options { intersection_cost, ..Options::fast() };
        stage::table::row(&format!("a test costs {intersection_cost} nodes"), &mesh, &Plan::KdTree(options))?;
    }
    Ok(())
}
