use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use rayon::prelude::*;

use super::Threads;
use crate::{
    casting::Casting,
    failure::{self, Failure},
    hits::{HitRecord, write_csv, write_hits},
    output,
    progress::Progress,
    rays::{RayRecord, read_rays},
    scene::{Queries, Source},
    units::{count, seconds},
};

/// Rays that a thread takes at a time.
const BATCH: usize = 1024;

/// Cast the rays of a file at a mesh, an asset or a world
///
/// RAYS holds six little-endian f32 per ray: origin and direction, for t from 0 to infinity. ANSWERS gets eight bytes per ray:
/// t as f32, infinity for a miss, and the primitive's number in the file's order as u32, 0xffffffff for a miss; of an asset
/// that is its own order, unless it was baked with --keep-numbers. The same bytes for every structure and any number of
/// threads.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitscan cast bunny.obj.gz bunny.rays -o bunny.answers")]
pub struct Cast {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz), baked asset or world (.toml)
    #[arg(value_name = "MODEL|ASSET|WORLD")]
    model: PathBuf,
    /// Rays; - for standard input
    rays: PathBuf,
    /// Answers to write; - for standard output
    #[arg(short, long, value_name = "ANSWERS", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    casting: Casting,
    #[command(flatten)]
    threads: Threads,
    /// Write lines of text for people instead
    #[arg(long)]
    csv: bool,
}

impl Cast {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        if !self.csv && self.output == Path::new("-") && io::stdout().is_terminal() {
            return Err(Failure::new("answers are no text for a terminal", "give -o FILE, or --csv"));
        }
        output::check(&self.output)?;
        output::spare("-o", &self.output, [&*self.model, &*self.rays])?;
        let rays = read_rays(&self.rays, self.casting.interval)?;
        let source = Source::load(&self.model)?;
        source.with_subject(&self.model, &self.casting.structure, false, |subject| {
            let (hits, took) = self.cast(subject.scene, &rays)?;
            let query = self.casting.query;
            match self.csv {
                true => write_csv(&self.output, &hits, query.columns(), |hit| query.cells(hit))?,
                false => write_hits(&self.output, &hits)?,
            }
            let rate = rays.len() as f64 / took.max(1.0e-9) * 1.0e-6;
            let (built, took, number) = (subject.time(), seconds(took), count(rays.len()));
            failure::note(&format!("{built}; {number} rays in {took}, {rate:.3} Mrays/s\n"));
            Ok(ExitCode::SUCCESS)
        })
    }

    /// The answers in the order of the rays, and the seconds they took.
    fn cast(&self, scene: &dyn Queries, rays: &[RayRecord]) -> Result<(Vec<HitRecord>, f64), Failure> {
        let mut hits = vec![HitRecord::MISS; rays.len()];
        let pool = self.threads.pool()?;
        let progress = Progress::bar("casting rays", rays.len() as u64);
        let begun = Instant::now();
        pool.install(|| {
            hits.par_chunks_mut(BATCH).zip(rays.par_chunks(BATCH)).for_each(|(hits, rays)| {
                hits.copy_from_slice(&self.casting.query.ask(scene, rays));
                progress.advance(rays.len() as u64);
            });
        });
        Ok((hits, begun.elapsed().as_secs_f64()))
    }
}
