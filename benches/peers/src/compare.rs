use std::time::Duration;

use hitscan::Error;

use crate::{
    clock::{median, time},
    engines::{Bvh2Slow, CwBvhVerySlow, Engine, Kd, Preset, obvhs_triangles},
    mesh::Mesh,
    rays::{self, Query, RaySet, View},
};

/// The engine that the ratios refer to.
const REFERENCE: usize = 0;

/// The engine that the answers are compared with: hitscan's presets agree bit for bit.
const ORACLE: usize = 2;

/// What the rays of one set came to with one engine.
#[derive(Default)]
struct Cast {
    /// Rays per second of each round.
    speeds: Vec<f64>,
    /// The `t` of each ray.
    answers: Vec<f32>,
}

/// Prints the table of one mesh.
pub fn run(mesh: &Mesh, view: View, ray_count: usize, rounds: usize) -> Result<(), Error> {
    let triangles = mesh.view()?;
    let soup = obvhs_triangles(mesh);
    let (bvh2, bvh2_time) = Bvh2Slow::build(&soup);
    let (cwbvh, cwbvh_time) = CwBvhVerySlow::build(&soup);
    let mut memory = Preset::ALL.map(|preset| vec![0; preset.words(&triangles)]);
    let [small, balanced, fast] = memory.each_mut();
    let (small, small_time) = Kd::build(Preset::Small, &triangles, small)?;
    let (balanced, balanced_time) = Kd::build(Preset::Balanced, &triangles, balanced)?;
    let (fast, fast_time) = Kd::build(Preset::Fast, &triangles, fast)?;

    let sets = rays::all(balanced.scene(), view, ray_count);
    let engines: [&dyn Engine; 5] = [&bvh2, &cwbvh, &balanced, &small, &fast];
    let times = [bvh2_time, cwbvh_time, balanced_time, small_time, fast_time];
    let casts = sets.each_ref().map(|set| cast(&engines, set, rounds));

    print_head(mesh, view, &sets);
    for (index, (engine, build)) in engines.into_iter().zip(times).enumerate() {
        print_row(mesh, engine, build, times[REFERENCE], &casts, index);
    }
    println!();
    Ok(())
}

/// Casts the rays with each engine in turn, as many times over as there are rounds.
fn cast<const N: usize>(engines: &[&dyn Engine; N], set: &RaySet, rounds: usize) -> [Cast; N] {
    let mut casts = [(); N].map(|()| Cast::default());
    for _ in 0..rounds {
        for (engine, cast) in engines.iter().zip(&mut casts) {
            cast.answers.clear();
            let (_, spent) = time(|| match set.kind.query() {
                Query::Closest => engine.closest(&set.rays, &mut cast.answers),
                Query::Any => engine.any(&set.rays, &mut cast.answers),
            });
            cast.speeds.push(set.rays.len() as f64 / spent.as_secs_f64());
        }
    }
    casts
}

fn print_head(mesh: &Mesh, view: View, sets: &[RaySet]) {
    let from = if view == View::Inside { "inside" } else { "outside" };
    println!("{}: {} triangles, seen from {from}", mesh.name, mesh.len());
    print!("{:23} {:>6} {:>8} {:>6}", "engine", "B/tri", "build µs", "ratio");
    for set in sets {
        print!(" | {:>8}, {:>4} k {:>6} {:>6}", set.kind, set.rays.len() / 1000, "ratio", "differ");
    }
    println!();
}

fn print_row<const N: usize>(
    mesh: &Mesh,
    engine: &dyn Engine,
    build: Duration,
    reference_build: Duration,
    casts: &[[Cast; N]; 3],
    index: usize,
) {
    let count = mesh.len() as f64;
    print!(
        "{:23} {:6.1} {:8.2} {:6.2}",
        engine.name(),
        engine.bytes() as f64 / count,
        build.as_secs_f64() * 1.0e6 / count,
        build.as_secs_f64() / reference_build.as_secs_f64(),
    );
    for casts in casts {
        let (cast, reference) = (&casts[index], &casts[REFERENCE]);
        let ratios = cast.speeds.iter().zip(&reference.speeds).map(|(speed, reference)| speed / reference).collect();
        let differ = cast.answers.iter().zip(&casts[ORACLE].answers).filter(|&(&a, &b)| differ(a, b)).count();
        print!(" | {:16.3} {:6.3} {differ:6}", median(cast.speeds.clone()) / 1.0e6, median(ratios));
    }
    println!();
}

/// Whether one hits and the other does not, or both hit more than 1e-4 apart.
fn differ(a: f32, b: f32) -> bool {
    a.is_finite() != b.is_finite() || a.is_finite() && (a - b).abs() > 1.0e-4 * b.abs()
}
