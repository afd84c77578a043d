//! Bakes meshes and their trees for the programs, with what the host finds in them, and places the board's memory.

#[path = "src/answer.rs"]
mod answer;
#[path = "src/camera.rs"]
mod camera;
#[path = "bake/knot.rs"]
mod knot;

use std::{env, error::Error, fmt::Write as _, fs, path::PathBuf};

use answer::Answer;
use hitscan::{Arena, KdTree, Mesh, Scene, glam::Vec3, kdtree::Options};

fn main() -> Result<(), Box<dyn Error>> {
    for input in ["build.rs", "bake", "memory", "src/answer.rs", "src/camera.rs"] {
        println!("cargo:rerun-if-changed={input}");
    }
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let target = env::var("TARGET")?;
    let board = match target.split('-').next() {
        Some("thumbv6m") => "microbit",
        Some("thumbv8m.main") => "an505",
        Some("riscv32imc" | "riscv32imac" | "riscv32imafc") => "virt",
        _ => "mps2",
    };
    fs::copy(format!("memory/{board}.x"), out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());

    // The micro:bit has 16 kB of RAM: what is built there is smaller.
    let (along, around) = if board == "microbit" { (15, 4) } else { (100, 5) };
    let mut code = bake("KNOT", "A torus knot of 1,000 triangles.", 100, 5)?;
    code += &bake("REBUILT", "The knot that fits into RAM together with its tree.", along, around)?;
    let triangles = usize::from(along) * usize::from(around) * 2;
    writeln!(code, "/// Triangles of [`REBUILT`].\npub const REBUILT_TRIANGLES: usize = {triangles};")?;
    Ok(fs::write(out.join("baked.rs"), code)?)
}

/// A `static` with a knot, its tree and the answer to the camera's rays.
fn bake(name: &str, doc: &str, along: u16, around: u16) -> Result<String, Box<dyn Error>> {
    let (vertices, triangles) = knot::mesh(along, around);
    let mesh = Mesh::new(&vertices, triangles.as_slice())?;
    let options = Options::balanced();
    let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
    let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &options)?;
    let scene = Scene::new(tree, &mesh)?;
    let mut answer = Answer::NONE;
    for ray in (0..camera::HEIGHT).flat_map(camera::row) {
        answer.add(scene.closest_hit(&ray));
    }
    let vertices: Vec<u32> = vertices.iter().flat_map(Vec3::to_array).map(f32::to_bits).collect();
    let words = tree.as_words();
    Ok(format!(
        "/// {doc}\npub static {name}: Baked = Baked {{ vertices: &{vertices:?}, triangles: &{triangles:?}, \
         tree: &{words:?}, answer: {answer:?} }};\n"
    ))
}
