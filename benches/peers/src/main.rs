//! hitscan beside obvhs, the fastest ray engine in Rust that we know: bytes, build time and rays per second, on one core.
//!
//! ```text
//! HITSCAN_DATA=/path/to/meshes cargo run --release
//! cargo run --release -- --mesh terrain:100000,soup:100000,knot:5000
//! cargo run --release -- growth
//! ```
//!
//! Both are compiled with the flags a user has by default. For those of this machine, from which obvhs' CwBvh gains most:
//! `RUSTFLAGS=-Ctarget-cpu=native cargo run --release`. Read the ratios: they are medians of rounds in which the engines
//! take turns, so that noise strikes all alike.

mod clock;
mod compare;
mod engines;
mod growth;
mod mesh;
mod procedural;
mod random;
mod rays;

use std::{env, error::Error, path::Path};

use clap::{Parser, Subcommand};

use self::{engines::Preset, mesh::Mesh, rays::View};

/// hitscan beside obvhs: bytes, build time and rays per second.
#[derive(Debug, Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// Meshes: files NAME.tri in the folder that HITSCAN_DATA names, or terrain:N, soup:N, knot:N; seen from outside, or
    /// from within as MESH@inside.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "bunny,hospital,hospital@inside,terrain:100000,soup:100000,knot:5000"
    )]
    mesh: Vec<String>,
    /// Primary rays; of the other kinds there is one per hit of these.
    #[arg(long, default_value_t = 250_000)]
    rays: usize,
    /// Times that each set of rays is cast.
    #[arg(long, default_value_t = 9)]
    rounds: usize,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Time of hitscan's builder from 62,500 to a million triangles of terrain.
    Growth {
        /// How the tree is built.
        #[arg(long, value_enum, default_value_t = Preset::Balanced)]
        preset: Preset,
    },
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    if let Some(Command::Growth { preset }) = arguments.command {
        return Ok(growth::run(preset)?);
    }
    let mut skipped = Vec::new();
    for name in &arguments.mesh {
        let (mesh, view) = match name.split_once('@') {
            None => (name.as_str(), View::Outside),
            Some((mesh, "inside")) => (mesh, View::Inside),
            Some((_, other)) => return Err(format!("{name}: there is @inside, but no @{other}").into()),
        };
        match open(mesh)? {
            Some(mesh) => compare::run(&mesh, view, arguments.rays, arguments.rounds)?,
            None => skipped.push(name.as_str()),
        }
    }
    if !skipped.is_empty() {
        eprintln!("SKIPPED, because HITSCAN_DATA does not name the folder of real meshes: {}", skipped.join(", "));
    }
    Ok(())
}

/// The mesh of this name, or none if it is a file and there is no folder to look into.
fn open(name: &str) -> Result<Option<Mesh>, Box<dyn Error>> {
    let Some((kind, count)) = name.split_once(':') else {
        let Some(folder) = env::var_os("HITSCAN_DATA") else { return Ok(None) };
        return Ok(Some(Mesh::load(Path::new(&folder), name)?));
    };
    let generate = match kind {
        "terrain" => procedural::terrain,
        "soup" => procedural::soup,
        "knot" => procedural::knot,
        _ => return Err(format!("{name}: there are terrain:N, soup:N and knot:N").into()),
    };
    Ok(Some(generate(count.parse()?)))
}
