use std::time::Instant;

use anyhow::{Result, ensure};
use hitscan::{
    Hit, Ray,
    glam::Vec3,
    render::{Camera, Caster, Renderer},
};
use rayon::prelude::*;

use super::Source;
use crate::{Query, Uploaded, World, settle};

/// Measures.
#[derive(Debug, clap::Args)]
pub struct Bench {
    #[command(flatten)]
    source: Source,
    /// Camera rays, about; as many shadow rays and bounce rays as of these hit something
    #[arg(long, default_value_t = 1 << 20)]
    rays: u32,
    /// How often to cast; the median counts
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
}

/// Numbers that are the same every time (SplitMix64, Steele, Lea and Flood 2014), from 0 up to 1.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ x >> 31) >> 40) as f32 / 16_777_216.0
    }

    /// A point of the unit sphere.
    fn direction(&mut self) -> Vec3 {
        let (z, angle) = (self.unit() * 2.0 - 1.0, self.unit() * std::f32::consts::TAU);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    }
}

impl Bench {
    pub fn run(&self) -> Result<()> {
        self.source.open(|uploaded, _, world| {
            println!("| rays | number | Mrays/s, shader | with transfer and finishing | library, all threads | nodes/ray | tests/ray | bytes/ray | GB/s | finished |");
            println!("|---|---|---|---|---|---|---|---|---|---|");
            let primary = self.primary(world.as_caster());
            let hits = self.measure("primary", uploaded, world, &primary, Query::Closest);
            let (bounce, shadow) = secondary(world.as_caster(), &primary, &hits);
            ensure!(!bounce.is_empty(), "no camera ray hits anything: nothing bounces");
            self.measure("bounce", uploaded, world, &bounce, Query::Closest);
            self.measure("shadow", uploaded, world, &shadow, Query::Any);
            Ok(())
        })
    }

    /// Rays of a camera that sees everything, tile by tile.
    fn primary(&self, scene: &dyn Caster) -> Vec<Ray> {
        let side = self.rays.isqrt().max(8);
        let camera = Camera::framing(&scene.bounds(), Vec3::new(0.6, 0.5, 1.0), Vec3::Y);
        let tiles = Renderer::new(scene, camera, side, side).tiles(8, 8);
        let pixels = tiles.flat_map(|tile| tile.pixels());
        pixels.map(|(x, y)| camera.ray(x as f32 + 0.5, y as f32 + 0.5, side, side)).collect()
    }

    fn measure(
        &self,
        name: &str,
        uploaded: &Uploaded,
        world: &World<'_, '_>,
        rays: &[Ray],
        query: Query,
    ) -> Vec<Option<Hit>> {
        // Compiles, and warms up.
        let answers = uploaded.cast(rays, query);
        let number = rays.len() as f64;
        let rate = |seconds: f64| number / seconds * 1.0e-6;
        let shader = rate(self.median(|| uploaded.seconds(rays, query)));
        let (mut hits, mut tally) = settle(world, rays, &answers, query);
        let whole = rate(self.median(|| {
            let begun = Instant::now();
            (hits, tally) = settle(world, rays, &uploaded.cast(rays, query), query);
            begun.elapsed().as_secs_f64()
        }));
        let library = rate(self.median(|| {
            let begun = Instant::now();
            let caster = world.as_caster();
            let found = match query {
                Query::Closest => rays.par_iter().filter(|ray| caster.closest_hit(ray, 0).is_some()).count(),
                Query::Any => rays.par_iter().filter(|ray| caster.any_hit(ray, 0)).count(),
            };
            std::hint::black_box(found);
            begun.elapsed().as_secs_f64()
        }));
        let (node, test) = uploaded.traffic();
        let (nodes, tests) = (tally.nodes as f64 / number, tally.tests as f64 / number);
        let bytes = nodes * node + tests * test + 40.0;
        println!(
            "| {name} | {} | {shader:.2} | {whole:.2} | {library:.2} | {nodes:.1} | {tests:.1} | {bytes:.0} | {:.2} | {:.3} % |",
            rays.len(),
            bytes * shader * 1.0e-3,
            100.0 * tally.finished as f64 / number
        );
        hits
    }

    fn median(&self, mut seconds: impl FnMut() -> f64) -> f64 {
        let mut all: Vec<f64> = (0..self.rounds).map(|_| seconds()).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    }
}

/// From each hit a ray in any direction away from the surface, by the cosine's law, and one to a light above all.
fn secondary(scene: &dyn Caster, rays: &[Ray], hits: &[Option<Hit>]) -> (Vec<Ray>, Vec<Ray>) {
    let mut random = Random(7);
    let light = scene.bounds().center() + scene.bounds().size().length() * Vec3::new(0.2, 1.0, 0.3);
    let from = |(ray, hit): (&Ray, &Option<Hit>)| {
        let surface = scene.surface(ray, &(*hit)?);
        let away = surface.normal_towards_ray() * 1.001 + random.direction();
        let bounce = Ray::new(surface.start_towards(away), away);
        Some((bounce, Ray::between(surface.start_towards(light - surface.point), light)))
    };
    rays.iter().zip(hits).filter_map(from).unzip()
}
