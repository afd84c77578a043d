//! Bakes assets for the programs, with what the host finds in them, and places the board's memory.

#[path = "src/answer.rs"]
mod answer;
#[path = "src/camera.rs"]
mod camera;
#[path = "bake/knot.rs"]
mod knot;

use std::{env, error::Error, fmt::Write as _, fs, path::Path};

use answer::Answer;
use hitscan::{
    KdTree, Mesh, Scene,
    accel::Plan,
    bake::{self, Baker},
    kdtree::Options,
};

fn main() -> Result<(), Box<dyn Error>> {
    for input in ["build.rs", "bake", "memory", "src/answer.rs", "src/camera.rs"] {
        println!("cargo:rerun-if-changed={input}");
    }
    let out = env::var("OUT_DIR")?;
    let out = Path::new(&out);
    let target = env::var("TARGET")?;
    let board = match target.split('-').next() {
        Some("thumbv6m") => "microbit",
        Some("thumbv8m.main") => "an505",
        Some("riscv32imc" | "riscv32imac" | "riscv32imafc") => "virt",
        _ => "mps2",
    };
    fs::copy(format!("memory/{board}.x"), out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());

    let mut code = asset(out, "KNOT", "A torus knot of 1,000 triangles.", (100, 5), &Options::balanced())?;
    // The micro:bit has 16 kB of RAM: what is built there has 60 triangles.
    let (along, around) = if board == "microbit" { (10, 3) } else { (100, 5) };
    code += &asset(out, "REBUILT", "The knot that is also built on the device.", (along, around), &Options::small())?;
    let triangles = usize::from(along) * usize::from(around) * 2;
    writeln!(code, "/// Triangles of [`REBUILT`].\npub const REBUILT_TRIANGLES: usize = {triangles};")?;
    Ok(fs::write(out.join("baked.rs"), code)?)
}

/// Writes a knot and its tree to a file; the `static` that includes it beside the answer to the camera's rays.
fn asset(
    out: &Path,
    name: &str,
    doc: &str,
    (along, around): (u16, u16),
    options: &Options,
) -> Result<String, Box<dyn Error>> {
    let (vertices, triangles) = knot::mesh(along, around);
    let mesh = Mesh::new(&vertices, triangles.as_slice())?;
    let tree = bake::build(&mesh, &Plan::KdTree(*options))?;
    let tree = KdTree::open(&tree)?;
    let words = Baker::new().mesh(&mesh).structure(tree).finish();
    let file = out.join(name).with_extension("hits");
    fs::write(&file, words.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;

    let scene = Scene::new(tree, &mesh)?;
    let mut answer = Answer::NONE;
    for ray in (0..camera::HEIGHT).flat_map(camera::row) {
        answer.add(scene.closest_hit(&ray));
    }
    let baked = format!("Baked {{ bytes: hitscan::include_asset!({file:?}), answer: {answer:?} }}");
    Ok(format!("/// {doc}\npub static {name}: Baked = {baked};\n"))
}
