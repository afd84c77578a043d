use std::{array, time::Duration};

use hitscan::Scene;

use crate::{
    clock::{median, time},
    engines::{Bvh2Slow, CwBvhVerySlow, Engine, Kd, Preset, triangles},
    mesh::Mesh,
    rays::{self, Kind, Query, RaySet},
};

/// What the rays of one kind came to with one engine.
struct Cast {
    /// Million rays per second in each round.
    speeds: Vec<f64>,
    /// `t` of each ray.
    answers: Vec<f32>,
}

/// Prints the table of one mesh: all engines, all kinds of rays.
pub fn run(mesh: &Mesh, ray_count: usize, rounds: usize) -> Result<(), String> {
    let view = mesh.view()?;
    let soup = triangles(mesh);

    // Build each twice and keep the lesser time: the first build pays for fresh memory.
    let mut memories = Preset::ALL.map(|preset| vec![0; preset.words(&view)]);
    let mut build_times = Vec::new();
    for (preset, memory) in Preset::ALL.iter().zip(&mut memories) {
        let least = best_of_2(|| preset.build(&view, memory).map(drop));
        build_times.push(least.map_err(|error| error.to_string())?.1);
    }
    let trees = memories.each_mut();
    let mut engines: Vec<Box<dyn Engine + '_>> = Vec::new();
    for (preset, memory) in Preset::ALL.into_iter().zip(trees) {
        let tree = preset.build(&view, memory).map_err(|error| error.to_string())?;
        let scene = Scene::new(tree, &view).map_err(|error| error.to_string())?;
        engines.push(Box::new(Kd { preset, scene }));
    }
    let _ = (&mut engines, &soup, ray_count, rounds, &mut build_times);
    let _: [RaySet; 0] = array::from_fn(|_| unreachable!());
    todo!()
}
