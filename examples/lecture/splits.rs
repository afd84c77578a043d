//! Cells of structures, cut open: grid, octree, and kD-trees split at midpoints, medians and by the surface area heuristic.
//!
//! `cargo run --release --features std --example splits`

mod stage;

use hitscan::accel::{Hierarchy, Inside, Plan, Structure};
use hitscan::{Mesh, bake, grid, kdtree, octree};

const SIDE: usize = 640;

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(60);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    let split = |split| Plan::KdTree(kdtree::Options { split, ..kdtree::Options::balanced() });
    let plans = [
        ("cells-grid", Plan::Grid(grid::Options::balanced())),
        ("cells-octree", Plan::Octree(octree::Options::balanced())),
        ("cells-kd-midpoint", split(kdtree::Split::Midpoint)),
        ("cells-kd-median", split(kdtree::Split::Median)),
        ("cells-kd-sah", split(kdtree::Split::Sah)),
    ];
    for (name, plan) in plans {
        let words = bake::build(&mesh, &plan)?;
        let structure = Structure::open(plan.kind().ok_or("a list has no cells")?, &words)?;
        let root = structure.root().ok_or("an empty mesh has no cells")?;
        let (min, middle, scale) = (root.bounds.min, root.bounds.center().y, (SIDE - 1) as f32 / root.bounds.size());
        let (column, row) = (|x: f32| ((x - min.x) * scale.x) as usize, |z: f32| ((z - min.z) * scale.z) as usize);
        let (mut pixels, mut stack) = (vec![[255_u8; 3]; SIDE * SIDE], vec![root]);
        while let Some(cell) = stack.pop() {
            let (low, high) = (cell.bounds.min, cell.bounds.max);
            match structure.open(&cell) {
                _ if low.y > middle || high.y < middle => {}
                Inside::Cells(cells) => stack.extend(cells.into_iter().flatten()),
                Inside::Leaf(leaf) => {
                    // The more primitives, the darker; borders are blue.
                    let shade = 255 - leaf.count().min(8) as u8 * 24;
                    let ([x0, x1], [z0, z1]) = ([low.x, high.x].map(column), [low.z, high.z].map(row));
                    for (x, z) in (x0..=x1).flat_map(|x| (z0..=z1).map(move |z| (x, z))) {
                        let border = x == x0 || x == x1 || z == z0 || z == z1;
                        pixels[z * SIDE + x] = if border { [60, 100, 200] } else { [shade; 3] };
                    }
                }
            }
        }
        stage::save_pixels(name, SIDE as u32, &pixels)?;
    }
    Ok(())
}
