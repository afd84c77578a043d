use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use hitscan::{Hit, Ray};
use rayon::prelude::*;

use super::Threads;
use crate::{
    failure::{self, Failure},
    hits::{HitRecord, write_csv, write_hits},
    output,
    progress::Progress,
    rays::{RayRecord, read_rays},
    scene::{Queries, Source, StructureArgs},
    units::{count, seconds},
};

/// Rays that a thread takes at a time.
const BATCH: usize = 1024;

/// Cast the rays of a file at a mesh or an asset
///
/// RAYS holds six little-endian f32 per ray: origin and direction, for t from 0 to infinity. HITS gets eight bytes per ray:
/// t as f32, infinity for a miss, and the primitive's number in the file's order as u32, 0xffffffff for a miss. The same
/// bytes for every structure and any number of threads.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitscan cast bunny.obj.gz bunny.rays -o bunny.hits")]
pub struct Cast {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz) or baked asset
    #[arg(value_name = "MODEL|ASSET")]
    model: PathBuf,
    /// Rays; - for standard input
    rays: PathBuf,
    /// Hits to write; - for standard output
    #[arg(short, long, value_name = "HITS", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    structure: StructureArgs,
    /// What is asked of each ray
    #[arg(short, long, value_name = "QUERY", default_value = "closest")]
    query: Query,
    #[command(flatten)]
    threads: Threads,
    /// Rays are eight f32: t_min and t_max follow the direction
    #[arg(short, long)]
    interval: bool,
    /// Write lines of text for people instead
    #[arg(long)]
    csv: bool,
}

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Query {
    /// The first hit
    Closest,
    /// Whether there is a hit: t = 0 and primitive 0 for yes
    Any,
    /// The number of hits in place of the primitive, 0 for none; t is that of the first
    Count,
}

impl Query {
    fn ask(self, scene: &dyn Queries, ray: &RayRecord) -> HitRecord {
        let ray = Ray::from(ray);
        match self {
            Self::Closest => scene.closest_hit(&ray, 0).map_or(HitRecord::MISS, record),
            Self::Any if scene.any_hit(&ray, 0) => HitRecord { t: 0.0, primitive: 0 },
            Self::Any => HitRecord::MISS,
            Self::Count => {
                let (first, primitive) = scene.count(&ray);
                HitRecord { t: first.map_or(f32::INFINITY, |hit| hit.t), primitive }
            }
        }
    }

    /// The columns of its answers in a table.
    fn columns(self) -> &'static str {
        match self {
            Self::Closest => "t,primitive",
            Self::Any => "hit",
            Self::Count => "t,hits",
        }
    }

    /// An answer in these columns, `t` as the shortest text that reads back to the same f32.
    fn cells(self, hit: &HitRecord) -> String {
        let t = if hit.t.is_finite() { hit.t.to_string() } else { String::new() };
        match self {
            Self::Closest if hit.is_miss() => ",".to_owned(),
            Self::Closest | Self::Count => format!("{t},{}", hit.primitive),
            Self::Any => u8::from(!hit.is_miss()).to_string(),
        }
    }
}

fn record(hit: Hit) -> HitRecord {
    HitRecord { t: hit.t, primitive: hit.primitive }
}

impl Cast {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        if !self.csv && self.output == Path::new("-") && io::stdout().is_terminal() {
            return Err(Failure::new("hits are no text for a terminal", "give -o FILE, or --csv"));
        }
        output::check(&self.output)?;
        let rays = read_rays(&self.rays, self.interval)?;
        let source = Source::load(&self.model)?;
        let view = source.view(&self.model)?;
        let built = view.build(self.structure.structure, self.structure.preset)?;
        let renumbered = view.renumbered(view.mesh)?;
        let scene = match &renumbered {
            Some(triangles) => built.scene(triangles)?,
            None => built.scene(&view.mesh)?,
        };
        let (hits, took) = self.cast(&*scene, &rays)?;

        match self.csv {
            true => write_csv(&self.output, &hits, self.query.columns(), |hit| self.query.cells(hit))?,
            false => write_hits(&self.output, &hits)?,
        }
        let name = &built.name;
        let rate = rays.len() as f64 / took.max(1.0e-9) * 1.0e-6;
        let (built, took, number) = (built.time(), seconds(took), count(rays.len()));
        failure::note(&format!("{name} {built}; {number} rays in {took}, {rate:.3} Mrays/s\n"));
        Ok(ExitCode::SUCCESS)
    }

    /// The answers in the order of the rays, and the seconds they took.
    fn cast(&self, scene: &dyn Queries, rays: &[RayRecord]) -> Result<(Vec<HitRecord>, f64), Failure> {
        let mut hits = vec![HitRecord::MISS; rays.len()];
        let pool = self.threads.pool()?;
        let progress = Progress::bar("casting rays", rays.len() as u64);
        let begun = Instant::now();
        pool.install(|| {
            hits.par_chunks_mut(BATCH).zip(rays.par_chunks(BATCH)).for_each(|(hits, rays)| {
                for (hit, ray) in hits.iter_mut().zip(rays) {
                    *hit = self.query.ask(scene, ray);
                }
                progress.advance(rays.len() as u64);
            });
        });
        Ok((hits, begun.elapsed().as_secs_f64()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_show_what_was_asked() {
        let hit = HitRecord { t: 0.1, primitive: 7 };
        assert_eq!((Query::Closest.cells(&hit), Query::Closest.cells(&HitRecord::MISS)), ("0.1,7".into(), ",".into()));
        assert_eq!((Query::Any.cells(&hit), Query::Any.cells(&HitRecord::MISS)), ("1".into(), "0".into()));
        let none = HitRecord { t: f32::INFINITY, primitive: 0 };
        assert_eq!((Query::Count.cells(&hit), Query::Count.cells(&none)), ("0.1,7".into(), ",0".into()));
    }
}
