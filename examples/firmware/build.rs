//! Bakes assets for the programs, with what the host finds in them, and places the board's memory.

#[path = "src/answer.rs"]
mod answer;
#[path = "src/camera.rs"]
mod camera;
#[path = "bake/knot.rs"]
mod knot;
#[path = "bake/lattice.rs"]
mod lattice;

use std::{env, error::Error, fmt::Write as _, fs, path::Path};

use answer::Answer;
use hitscan::{
    KdTree, Mesh, Scene,
    accel::{List, Plan, Structure},
    bake::{self, Baker},
    bvh, dualsplit, grid, kdtree,
    kdtree::Options,
    octree,
};

fn main() -> Result<(), Box<dyn Error>> {
    for input in ["build.rs", "bake", "memory", "src/answer.rs", "src/camera.rs"] {
        println!("cargo:rerun-if-changed={input}");
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

    let mut code = asset(out, "KNOT", "A torus knot of 1,000 triangles.", (100, 5), &Options::balanced())?;
    // The micro:bit has 16 kB of RAM: what is built there has 60 triangles.
    let (along, around) = if board == "microbit" { (10, 3) } else { (100, 5) };
    code += &asset(out, "REBUILT", "The knot that is also built on the device.", (along, around), &Options::small())?;
    let triangles = usize::from(along) * usize::from(around) * 2;
    writeln!(code, "/// Triangles of [`REBUILT`].\npub const REBUILT_TRIANGLES: usize = {triangles};")?;
    code += &contest(out)?;
    code += &lattice::contest(out, board == "microbit")?;
    Ok(fs::write(out.join("baked.rs"), code)?)
}

/// What `bench` compares.
fn plans() -> Vec<(&'static str, Plan)> {
    vec![
        ("grid small", Plan::Grid(grid::Options::small())),
        ("grid balanced", Plan::Grid(grid::Options::balanced())),
        ("grid fast", Plan::Grid(grid::Options::fast())),
        ("octree balanced", Plan::Octree(octree::Options::balanced())),
        ("kdtree small", Plan::KdTree(kdtree::Options::small())),
        ("kdtree balanced", Plan::KdTree(kdtree::Options::balanced())),
        ("kdtree fast", Plan::KdTree(kdtree::Options::fast())),
        ("kdtree-compact small", Plan::CompactKdTree(kdtree::Options::small())),
        ("kdtree-compact balanced", Plan::CompactKdTree(kdtree::Options::balanced())),
        ("bvh balanced", Plan::Bvh(bvh::Options::balanced())),
        ("dual-split small", Plan::DualSplit(dualsplit::Options::small())),
        ("dual-split balanced", Plan::DualSplit(dualsplit::Options::balanced())),
        ("dual-split fast", Plan::DualSplit(dualsplit::Options::fast())),
    ]
}

/// The knots under every plan, in the order of the leaves where there are no references.
fn contest(out: &Path) -> Result<String, Box<dyn Error>> {
    let mut code = "/// What `bench` compares.\npub static CONTEST: &[Contestant] = &[\n".to_string();
    for (size, (along, around)) in [("1k", (100, 5)), ("5k", (250, 10))] {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        for (name, plan) in plans() {
            let kind = plan.kind().ok_or("every plan has a kind")?;
            let mut words = bake::build(&mesh, &plan)?;
            let mut corners = bake::reorder(&mesh, &(0..mesh.indices().len() as u32).collect::<Vec<_>>());
            if let Some((ordered, order)) = bake::ordered(&Structure::open(kind, &words)?) {
                corners = bake::reorder(&mesh, &order);
                words = ordered;
            }
            let mesh = Mesh::new(&vertices, corners.as_slice())?;
            let structure = Structure::open(kind, &words)?;
            let asset = Baker::new().mesh(&mesh).structure(structure).finish();
            let file = out.join(format!("{size} {name}.hits"));
            fs::write(&file, asset.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;
            let scene = Scene::new(List::new(&mesh)?, &mesh)?;
            let mut answer = Answer::NONE;
            for ray in (0..camera::HEIGHT).flat_map(camera::row) {
                answer.add(scene.closest_hit(&ray));
            }
            let triangles = corners.len();
            let bytes = words.len() * 4;
            writeln!(
                code,
                "    Contestant {{ name: {name:?}, triangles: {triangles}, bytes: {bytes}, baked: Baked {{ bytes: \
                 hitscan::include_asset!({file:?}), answer: {answer:?} }} }},"
            )?;
        }
    }
    Ok(code + "];\n")
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
