//! hitscan beside Embree, obvhs, bvh and parry3d on one core: bytes, build time, rays per second, and whose answers are
//! right. The README of this package says how to run it.

mod clock;
mod compare;
mod engines;
mod growth;
mod mesh;
mod plot;
mod procedural;
mod random;
mod rays;
mod table;

use std::{
    env,
    error::Error,
    ffi::OsString,
    path::{Path, PathBuf},
};

use clap::{Args, Parser, Subcommand};

use self::{
    compare::Effort,
    engines::{Libraries, Preset, Wanted},
    mesh::Mesh,
    rays::{Order, View},
};

/// hitscan beside Embree, obvhs, bvh and parry3d: bytes, build time and rays per second, as Markdown tables.
///
/// Read the ratios: they are medians of rounds in which the engines take turns, so that noise strikes all alike.
#[derive(Debug, Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    comparison: Comparison,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Time of hitscan's kD-tree builder from 62,500 to a million triangles of terrain.
    Growth {
        /// How the tree is built.
        #[arg(long, value_enum, default_value_t = Preset::Balanced)]
        preset: Preset,
    },
}

#[derive(Args, Debug)]
struct Comparison {
    /// Meshes: files NAME.tri in the folder that HITSCAN_DATA names, `all` for all of them, or terrain:N, soup:N, knot:N;
    /// seen from outside, or from within as MESH@inside.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "teapot,sponza@inside,bunny,hospital@inside,hair_mohawk,dragon,terrain:1000000"
    )]
    mesh: Vec<String>,
    /// Only engines whose names contain one of these words, whatever their case.
    #[arg(long, value_delimiter = ',')]
    engine: Vec<String>,
    /// Embree libraries beside each other, the one that others are measured by first; without this, the system's.
    #[arg(long, num_args = 1.., value_name = "LIBRARY")]
    embree: Vec<OsString>,
    /// Primary rays; of the other kinds there is one per hit of these.
    #[arg(long, default_value_t = 250_000)]
    rays: usize,
    /// The order of the rays that begin where primary ones hit.
    #[arg(long, value_enum, default_value_t = Order::Tiles)]
    order: Order,
    /// Times that each set of rays is cast.
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Draws the ratios, too.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    match arguments.command {
        Some(Command::Growth { preset }) => Ok(growth::run(preset)?),
        None => compare(&arguments.comparison),
    }
}

fn compare(arguments: &Comparison) -> Result<(), Box<dyn Error>> {
    let libraries = Libraries::open(&arguments.embree)?;
    if libraries.is_empty() {
        eprintln!("SKIPPED, because it is not installed: Embree");
    }
    let wanted = Wanted(arguments.engine.clone());
    let effort = Effort { rays: arguments.rays, rounds: arguments.rounds, order: arguments.order };
    let folder = env::var_os("HITSCAN_DATA").map(PathBuf::from);
    let mut outcomes = Vec::new();
    for name in names(&arguments.mesh, folder.as_deref())? {
        let (mesh, view) = match name.split_once('@') {
            None => (name.as_str(), View::Outside),
            Some((mesh, "inside")) => (mesh, View::Inside),
            Some((_, other)) => return Err(format!("{name}: there is @inside, but no @{other}").into()),
        };
        let Some(mesh) = open(mesh, folder.as_deref())? else {
            eprintln!("SKIPPED, because HITSCAN_DATA does not name the folder of real meshes: {name}");
            continue;
        };
        let outcome = compare::run(&mesh, view, effort, &libraries, &wanted)?;
        table::mesh(&outcome);
        outcomes.push(outcome);
    }
    table::summary(&outcomes);
    match &arguments.plot {
        Some(path) => plot::write(path, &outcomes),
        None => Ok(()),
    }
}

/// The meshes asked for, `all` spelled out.
fn names(asked: &[String], folder: Option<&Path>) -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for name in asked {
        match folder {
            Some(folder) if name == "all" => names.extend(Mesh::all(folder)?),
            _ => names.push(name.clone()),
        }
    }
    Ok(names)
}

/// The mesh of this name, or none if it is a file and there is no folder to look into.
fn open(name: &str, folder: Option<&Path>) -> Result<Option<Mesh>, Box<dyn Error>> {
    let Some((kind, count)) = name.split_once(':') else {
        let Some(folder) = folder else { return Ok(None) };
        return Ok(Some(Mesh::load(folder, name)?));
    };
    let generate = match kind {
        "terrain" => procedural::terrain,
        "soup" => procedural::soup,
        "knot" => procedural::knot,
        _ => return Err(format!("{name}: there are terrain:N, soup:N and knot:N").into()),
    };
    Ok(Some(generate(count.parse()?)))
}
