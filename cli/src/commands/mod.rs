//! The subcommands: their options, and what they do with them.

mod bake;
mod cast;
mod compare;
mod diff;
mod info;
mod merge;
mod render;

use std::{
    fmt::{self, Write as _},
    num::NonZeroUsize,
    path::Path,
    process::ExitCode,
    thread,
};

use hitscan::Primitives;

use crate::{
    chip::{Chip, Prediction},
    failure::Failure,
    output::write_atomically,
    scene::Built,
    trial::Rays,
};

/// What to do.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    Render(render::Render),
    Bake(bake::Bake),
    Info(info::Info),
    Cast(cast::Cast),
    Compare(compare::Compare),
    Diff(diff::Diff),
    Merge(merge::Merge),
}

impl Command {
    /// Their names, in order.
    pub const NAMES: [&'static str; 7] = ["render", "bake", "info", "cast", "compare", "diff", "merge"];

    /// Does it; the code to exit with.
    pub fn run(&self) -> Result<ExitCode, Failure> {
        match self {
            Self::Render(render) => render.run(),
            Self::Bake(bake) => bake.run(),
            Self::Info(info) => info.run(),
            Self::Cast(cast) => cast.run(),
            Self::Compare(compare) => compare.run(),
            Self::Diff(diff) => diff.run(),
            Self::Merge(merge) => merge.run(),
        }
    }
}

/// Prints a report on standard output.
fn print(text: &str) -> Result<(), Failure> {
    Ok(write_atomically(Path::new("-"), |out| out.write_all(text.as_bytes()))?)
}

/// Adds a line `  what  value` to a report. Writing to a string cannot fail.
fn line(text: &mut String, what: &str, value: impl fmt::Display) {
    let _ = writeln!(text, "  {what:<18} {value}");
}

/// Adds what a scene, an asset of so many bytes, will cost on a chip.
fn predict<P: Primitives + Sync>(
    text: &mut String,
    chip: Chip,
    built: &Built,
    mesh: &P,
    asset: usize,
) -> Result<(), Failure> {
    let rays = Rays::around(&*built.scene(mesh)?);
    let _ = writeln!(text, "on {}", chip.phrase());
    match Prediction::new(chip, built, mesh, &rays)? {
        Some(prediction) => prediction.rows(asset).into_iter().for_each(|(what, value)| line(text, what, value)),
        None => line(text, "unknown", "this structure was not measured there"),
    }
    Ok(())
}

/// The option that sets how many threads work.
#[derive(Clone, Copy, Debug, clap::Args)]
struct Threads {
    /// Threads to work on; the result is the same for any number [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl Threads {
    /// How many there are to be.
    fn count(self) -> usize {
        let cores = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.threads.map_or_else(cores, usize::from)
    }

    /// A pool of as many.
    fn pool(self) -> Result<rayon::ThreadPool, Failure> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count()).build();
        pool.map_err(|error| Failure::new(format!("no threads: {error}"), "ask for fewer with --threads"))
    }
}
