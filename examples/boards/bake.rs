//! The build script of all boards: bakes a scene for `include_asset!`, and tells the linker where the memory is.

#[path = "../firmware/bake/knot.rs"]
mod knot;

use std::{env, error::Error, fs, path::Path};

use hitscan::{
    KdTree, Mesh,
    accel::Plan,
    bake::{self, Baker},
    kdtree::Options,
};

fn main() -> Result<(), Box<dyn Error>> {
    let out = env::var("OUT_DIR")?;
    let out = Path::new(&out);

    let (vertices, triangles) = knot::mesh(100, 5);
    let mesh = Mesh::new(&vertices, triangles.as_slice())?;
    let tree = bake::build(&mesh, &Plan::KdTree(Options::balanced()))?;
    let words = Baker::new().mesh(&mesh).structure(KdTree::open(&tree)?).finish();
    fs::write(out.join("scene.hits"), words.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;

    // Some boards have a memory.x, some one for each feature; the crates of others bring their own.
    let memory = match (env::var_os("CARGO_FEATURE_PICO2"), env::var_os("CARGO_FEATURE_PICO")) {
        (Some(_), _) => "memory/pico2.x",
        (None, Some(_)) => "memory/pico.x",
        (None, None) => "memory.x",
    };
    if Path::new(memory).exists() {
        fs::copy(memory, out.join("memory.x"))?;
        println!("cargo:rustc-link-search={}", out.display());
        println!("cargo:rerun-if-changed={memory}");
    }
    println!("cargo:rerun-if-changed=../bake.rs");
    Ok(())
}
