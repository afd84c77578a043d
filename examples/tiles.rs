//! A picture tile by tile, with memory for one tile only: in the terminal, as characters.
//!
//! `cargo run --example tiles`

use hitscan::{
    List, Scene,
    geometry::Sphere,
    glam::Vec3,
    primitives::Spheres,
    render::{Camera, Light, Renderer},
};

const SIZE: (u32, u32) = (72, 30);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let balls = [
        Sphere::new(Vec3::ZERO, 1.0),
        Sphere::new(Vec3::new(1.4, 0.3, 0.6), 0.4),
        Sphere::new(Vec3::new(0.0, -101.0, 0.0), 100.0),
    ];
    let spheres = Spheres::new(&balls)?;
    let scene = Scene::new(List::new(&spheres)?, spheres)?;
    let lights = [Light::point(Vec3::new(4.0, 5.0, 3.0), Vec3::ONE)];
    let camera = Camera::pinhole(Vec3::new(1.0, 1.0, 5.0), Vec3::new(0.3, 0.0, 0.0), Vec3::Y, 0.6);
    let renderer = Renderer::new(&scene, camera, SIZE.0, SIZE.1)
        .with_lights(&lights)
        .with_background(Vec3::ZERO, Vec3::ZERO)
        .with_samples(2);

    let mut screen = vec![vec![' '; SIZE.0 as usize]; SIZE.1 as usize];
    let mut pixels = [0_u8; 8 * 8];
    for tile in renderer.tiles(8, 8) {
        renderer.fill(tile, &mut pixels)?;
        for ((x, y), grey) in tile.pixels().zip(pixels) {
            screen[y as usize][x as usize] = b" .:-=+*#%@"[usize::from(grey) * 10 / 256] as char;
        }
    }
    for row in screen {
        println!("{}", row.into_iter().collect::<String>());
    }
    Ok(())
}
