use std::{fs, path::PathBuf, time::Instant};

use anyhow::{Context, Result, ensure};
use hitscan::{Ray, glam::Vec3};

use super::Source;
use crate::{Query, settle};

/// Casts the rays of a file.
#[derive(Debug, clap::Args)]
pub struct Cast {
    #[command(flatten)]
    source: Source,
    /// Little-endian f32: origin and direction, 24 bytes a ray
    rays: PathBuf,
    /// Where hits go: per ray f32 t and u32 primitive; of a miss infinity and 0xffffffff
    #[arg(short, long)]
    output: PathBuf,
    /// Rays have an interval, t_min and t_max, too: 32 bytes
    #[arg(long)]
    interval: bool,
    /// Ask only whether there is a hit: t and primitive are then 0
    #[arg(long)]
    any: bool,
}

impl Cast {
    pub fn run(&self) -> Result<()> {
        let rays = self.read()?;
        let query = if self.any { Query::Any } else { Query::Closest };
        self.source.open(|uploaded, _, world| {
            let begun = Instant::now();
            let answers = uploaded.cast(&rays, query);
            let cast = begun.elapsed().as_secs_f64();
            let (hits, tally) = settle(world, &rays, &answers, query);
            let seconds = begun.elapsed().as_secs_f64();
            let record = |hit: &Option<hitscan::Hit>| {
                let (t, primitive) = hit.map_or((f32::INFINITY, u32::MAX), |hit| (hit.t, hit.primitive));
                [t.to_bits(), primitive].map(u32::to_le_bytes)
            };
            let bytes: Vec<u8> = hits.iter().flat_map(record).flatten().collect();
            fs::write(&self.output, bytes).with_context(|| self.output.display().to_string())?;
            eprintln!(
                "{} rays in {seconds:.3} s, {cast:.3} s of it on the GPU; {} ({:.3} %) were finished on the CPU, {} refuted",
                tally.rays,
                tally.finished,
                100.0 * tally.finished as f64 / tally.rays.max(1) as f64,
                tally.refuted
            );
            Ok(())
        })
    }

    fn read(&self) -> Result<Vec<Ray>> {
        let bytes = fs::read(&self.rays).with_context(|| self.rays.display().to_string())?;
        let size = if self.interval { 32 } else { 24 };
        ensure!(
            bytes.len().is_multiple_of(size),
            "{}: not a whole number of rays of {size} bytes: check --interval",
            self.rays.display()
        );
        let ray = |bytes: &[u8]| {
            let f: Vec<f32> = bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect();
            let ray = Ray::new(Vec3::from_slice(&f), Vec3::from_slice(&f[3..]));
            if self.interval { ray.starting_at(f[6]).up_to(f[7]) } else { ray }
        };
        Ok(bytes.chunks_exact(size).map(ray).collect())
    }
}
