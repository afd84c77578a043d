//! The uniform grid: how many cells? Few are tested in full, many are walked for nothing.
//!
//! `cargo run --release --features std --example grid`

mod stage;

use hitscan::{
    Mesh,
    accel::Plan,
    grid::{Form, Options},
};

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(200);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    stage::table::head();
    for form in Form::ALL {
        for density in [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] {
            let options = Options { density, form, ..Options::fast() };
            stage::table::row(&format!("{form:?}, {density} cells a triangle"), &mesh, &Plan::Grid(options))?;
        }
    }
    Ok(())
}
