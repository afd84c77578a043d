//! Bounding volumes: the lecture's exercise. An object that fills a small part of the picture, a list of its triangles, and
//! in front of the list nothing (335 s in the lecture) or a volume (11 s).
//!
//! `cargo run --release --features std --example bounding`

mod stage;

use hitscan::{
    List, Mesh, Scene,
    accel::Bounded,
    geometry::{Bounding, Volume},
    glam::Vec3,
    render::Camera,
};

const SIDE: u32 = 200;

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(60);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    let list = List::new(&mesh)?;
    let camera = Camera::pinhole(Vec3::new(4.0, 8.0, 12.0), Vec3::ZERO, Vec3::Y, 0.9);
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x as f32 + 0.5, y as f32 + 0.5)));
    let rays: Vec<_> = pixels.map(|(x, y)| camera.ray(x, y, SIDE, SIDE)).collect();

    let bare = Scene::new(list, &mesh)?;
    let (alone, hits) = stage::timed(|| rays.iter().filter(|ray| bare.closest_hit(ray).is_some()).count());
    println!("{} triangles, {} rays, {hits} of them hit\n", triangles.len(), rays.len());
    println!("{:22} {:>8} {:>9} {:>16} {:>8}", "volume", "build", "size", "false positives", "seconds");
    println!("{:22} {:>8} {:>9} {:15.1}% {alone:8.2}", "none", "", "", 100.0);
    for kind in Bounding::ALL {
        let (build, volume) = stage::timed(|| kind.around(vertices.iter().copied()));
        let volume = volume.ok_or("a mesh of nothing")?;
        let scene = Scene::new(Bounded::new(volume, list), &mesh)?;
        let (seconds, found) = stage::timed(|| rays.iter().filter(|ray| scene.closest_hit(ray).is_some()).count());
        assert_eq!(found, hits, "a volume may only leave out work");
        let met = rays.iter().filter_map(|ray| ray.prepare()).filter(|ray| volume.may_meet(ray, f32::MAX)).count();
        let false_positives = 100.0 * (met - hits) as f32 / (rays.len() - hits) as f32;
        let (size, name) = (volume.volume(), kind.name());
        println!("{name:22} {:6.0}µs {size:9.3} {false_positives:15.1}% {seconds:8.2}", build * 1.0e6);
    }
    Ok(())
}
