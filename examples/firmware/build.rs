//! Bakes assets for the programs, with what the host finds in them, and places the board's memory.

#[path = "src/answer.rs"]
mod answer;
#[path = "src/builds.rs"]
mod builds;
#[path = "src/camera.rs"]
mod camera;
#[path = "bake/contest.rs"]
mod contest;
#[path = "src/hash.rs"]
mod hash;
#[path = "bake/knot.rs"]
mod knot;
#[path = "bake/lattice.rs"]
mod lattice;
#[path = "src/picture.rs"]
mod picture;
#[path = "src/room.rs"]
mod room;

use std::{convert::Infallible, env, error::Error, fmt::Write as _, fs, path::Path};

use answer::Answer;
use embedded_graphics::prelude::*;
use hash::Hash;
use hitscan::{
    Accelerator, Arena, KdTree, Mesh, Primitives, Scene,
    accel::Plan,
    bake::{self, Baker},
    kdtree::Options,
};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=bake\ncargo:rerun-if-changed=memory");
    for source in ["answer", "builds", "camera", "hash", "picture", "room"] {
        println!("cargo:rerun-if-changed=src/{source}.rs");
    }
    let out = env::var("OUT_DIR")?;
    let out = Path::new(&out);
    let target = env::var("TARGET")?;
    let board = match target.split('-').next() {
        Some("thumbv6m") if env::var_os("CARGO_FEATURE_ROOMY").is_none() => "microbit",
        Some("thumbv8m.main") => "an505",
        Some("riscv32imc" | "riscv32imac" | "riscv32imafc") => "virt",
        _ => "mps2",
    };
    fs::copy(format!("memory/{board}.x"), out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());
    let small = board == "microbit";
    if small {
        println!("cargo:rustc-cfg=small");
    }
    // The micro:bit has 16 kB of RAM, and the others without an FPU little patience.
    let fpu = target.ends_with("hf") || target.contains("imafc");
    let model = if small {
        (10, 3)
    } else if fpu {
        (100, 5)
    } else {
        (20, 4)
    };
    // A micro:bit's 256 kB hold all programs at once with the smaller tree.
    let options = if small { Options::small() } else { Options::balanced() };
    let code = [knots(out, &options, model)?, ranges()?, contest::contest(out, small)?, lattice::contest(out, small)?];
    Ok(fs::write(out.join("baked.rs"), code.concat())?)
}

/// The knot in flash, its pictures, and the knot that is built on the device with the hashes of what is built.
fn knots(out: &Path, options: &Options, (along, around): (u16, u16)) -> Result<String, Box<dyn Error>> {
    let mut code = String::new();
    let (vertices, triangles) = knot::mesh(100, 5);
    let mesh = Mesh::new(&vertices, triangles.as_slice())?;
    let tree = bake::build(&mesh, &Plan::KdTree(*options))?;
    let scene = Scene::new(KdTree::open(&tree)?, mesh)?;
    code += &asset(out, "KNOT", "A torus knot of 1,000 triangles.", &scene)?;
    let (mut color, mut binary) = (Hash::NONE, Hash::NONE);
    let Ok(()) = picture::color(&scene, |strip| -> Result<(), Infallible> {
        strip.iter().for_each(|pixel| color.add(pixel.into_storage().into()));
        Ok(())
    });
    let Ok(()) = picture::binary(&scene, |strip| -> Result<(), Infallible> {
        strip
            .chunks_exact(8)
            .for_each(|eight| binary.add(eight.iter().fold(0, |byte, pixel| byte << 1 | u32::from(pixel.is_off()))));
        Ok(())
    });
    writeln!(code, "/// The colour picture.\npub const COLOR_PICTURE: Hash = {color:?};")?;
    writeln!(code, "/// The picture in black and white.\npub const BINARY_PICTURE: Hash = {binary:?};")?;

    let (vertices, triangles) = knot::mesh(along, around);
    let mesh = Mesh::new(&vertices, triangles.as_slice())?;
    let tree = bake::build(&mesh, &Plan::KdTree(Options::small()))?;
    code +=
        &asset(out, "MODEL", "The knot over which structures are built.", &Scene::new(KdTree::open(&tree)?, mesh)?)?;
    let mut hashes = vec![];
    for build in builds::BUILDS {
        let mut memory = vec![0; (build.words)(mesh.len() as usize)];
        let words = (build.build)(&mesh, &mut Arena::new(&mut memory));
        let words = words.map_err(|error| format!("{}: {error}", build.name))?;
        hashes.push((build.name, Hash::of(words.iter().copied())));
    }
    writeln!(code, "/// The words of what is built, by its name.\npub const HASHES: &[(&str, Hash)] = &{hashes:?};")?;
    Ok(code)
}

/// What the sensor reports.
fn ranges() -> Result<String, Box<dyn Error>> {
    let mut memory = [0; 1024];
    let room = room::Room::new(&mut Arena::new(&mut memory))?;
    let mut hash = Hash::NONE;
    for frame in 0..room::FRAMES {
        room.ranges(frame)?.into_iter().for_each(|range| hash.add(range.map_or(u32::MAX, u32::from)));
    }
    Ok(format!("/// All ranges of the sensor.\npub const RANGES: Hash = {hash:?};\n"))
}

/// What the camera's rays hit.
fn camera_answer<A: Accelerator, P: Primitives>(scene: &Scene<A, P>) -> Answer {
    let mut answer = Answer::NONE;
    (0..camera::HEIGHT).flat_map(camera::row).for_each(|ray| answer.add(scene.closest_hit(&ray)));
    answer
}

/// Writes a scene to a file; the `static` that includes it beside the answer to the camera's rays.
fn asset(out: &Path, name: &str, doc: &str, scene: &Scene<KdTree, Mesh>) -> Result<String, Box<dyn Error>> {
    let words = Baker::new().mesh(scene.primitives()).structure(*scene.accelerator()).finish();
    let file = out.join(name).with_extension("hits");
    fs::write(&file, words.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;
    let answer = camera_answer(scene);
    let baked = format!("Baked {{ bytes: hitscan::include_asset!({file:?}), answer: {answer:?} }}");
    Ok(format!("/// {doc}\npub static {name}: Baked = {baked};\n"))
}
