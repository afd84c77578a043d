//! What the programs of the lecture share: a mesh to look at, the clock, and pictures in `target/lecture`.
#![allow(dead_code)]

pub mod table;

use std::{error::Error, f32::consts::TAU, fs, path::PathBuf, time::Instant};

use hitscan::{
    Accelerator, Primitives, Ray, Scene,
    glam::Vec3,
    parallel,
    render::{Camera, Caster, Renderer},
};

/// What a program may fail with.
pub type Fallible = Result<(), Box<dyn Error>>;

/// A torus knot of `rings` x 24 x 2 triangles, two units wide.
pub fn knot(rings: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const CORNERS: u32 = 24;
    let middle = |at: f32| {
        let radius = 0.7 + 0.25 * (3.0 * at).cos();
        Vec3::new(radius * (2.0 * at).cos(), 0.3 * (3.0 * at).sin(), radius * (2.0 * at).sin())
    };
    let point = |ring: u32, corner: u32| {
        let (at, turn) = (TAU * ring as f32 / rings as f32, TAU * corner as f32 / CORNERS as f32);
        let along = (middle(at + 0.01) - middle(at - 0.01)).normalize();
        let across = along.cross(Vec3::Y).normalize();
        middle(at) + (across * turn.cos() + across.cross(along) * turn.sin()) * 0.13
    };
    let vertices = (0..rings).flat_map(|ring| (0..CORNERS).map(move |corner| point(ring, corner))).collect();
    let number = |ring: u32, corner: u32| ring % rings * CORNERS + corner % CORNERS;
    let quads = (0..rings).flat_map(|ring| (0..CORNERS).map(move |corner| (ring, corner)));
    let triangles = quads.flat_map(|(ring, corner)| {
        let [a, b] = [number(ring, corner), number(ring, corner + 1)];
        let [c, d] = [number(ring + 1, corner), number(ring + 1, corner + 1)];
        [[a, b, c], [b, d, c]]
    });
    (vertices, triangles.collect())
}

/// The rays of a camera that sees all of a scene.
pub fn rays<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, side: u32) -> Vec<Ray> {
    let camera = Camera::framing(&scene.bounds(), Vec3::new(1.0, 2.0, 3.0), Vec3::Y);
    let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x as f32 + 0.5, y as f32 + 0.5)));
    pixels.map(|(x, y)| camera.ray(x, y, side, side)).collect()
}

/// The seconds that `work` takes, and what it gives.
pub fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// Draws a picture on all cores and saves it.
pub fn save<S: Caster + Sync>(name: &str, renderer: &Renderer<'_, S>) -> Fallible {
    let mut pixels = vec![[0_u8; 3]; (renderer.width() * renderer.height()) as usize];
    parallel::render(renderer, &mut pixels)?;
    save_pixels(name, renderer.width(), &pixels)
}

/// Saves pixels as `target/lecture/NAME.png`.
pub fn save_pixels(name: &str, width: u32, pixels: &[[u8; 3]]) -> Fallible {
    let folder = PathBuf::from("target/lecture");
    fs::create_dir_all(&folder)?;
    let path = folder.join(name).with_extension("png");
    let mut encoder = png::Encoder::new(fs::File::create(&path)?, width, pixels.len() as u32 / width.max(1));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(pixels.as_flattened())?;
    println!("{}", path.display());
    Ok(())
}

/// The most memory that the program has taken so far, where the system tells (Linux).
pub fn peak_memory() -> Option<String> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")).map(|most| most.trim().to_owned())
}
