//! The octree: how deep? And its point in the middle, or where the surface area heuristic puts it.
//!
//! `cargo run --release --features std --example octree`

mod stage;

use hitscan::{
    Mesh,
    accel::Plan,
    octree::{Options, Split},
};

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(200);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    stage::table::head();
    for split in [Split::Middle, Split::Sah] {
        for max_depth in 1..8 {
            let options = Options { split, max_depth, ..Options::fast() };
            stage::table::row(&format!("{split:?}, {max_depth} levels"), &mesh, &Plan::Octree(options))?;
        }
    }
    Ok(())
}
