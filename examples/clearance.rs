//! What a robot's bumper sees: how close it comes to a box and a post on its way past them. One table.
//!
//! `cargo run --example clearance`

use hitscan::{Arena, Error, KdTree, Mesh, Scene, geometry::Sphere, glam::Vec3, kdtree::Options, primitives::Spheres};

/// The bumper's radius, and the distance at which the robot slows down, in metres.
const BUMPER: f32 = 0.3;
const SLOW: f32 = 0.5;

fn main() -> Result<(), Error> {
    // A crate of 1 m, and a ball on a post.
    let vertices = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles: [[u16; 3]; 12] = std::array::from_fn(|i| {
        let [a, b, c, d] = sides[i / 2];
        if i % 2 == 0 { [a, b, c] } else { [a, c, d] }
    });
    let balls = [Sphere::new(Vec3::new(2.5, 0.5, 1.6), 0.2)];
    let yard = (Mesh::new(&vertices, &triangles)?, Spheres::new(&balls)?);

    let mut memory = [0; KdTree::words(13, &Options::small())];
    let tree = KdTree::build(&yard, &mut Arena::new(&mut memory), &Options::small())?;
    let scene = Scene::new(tree, &yard)?;

    println!("    x      z   distance  to  touching");
    for step in 0..=12 {
        let s = step as f32 / 12.0;
        let robot = Vec3::new(4.0 - 4.5 * s, 0.4, 1.0 + 0.6 * s * s);
        let touching = scene.overlaps(&Sphere::new(robot, BUMPER)).count();
        print!("{:5.2}  {:5.2}  ", robot.x, robot.z);
        match scene.nearest_point(robot, BUMPER + SLOW) {
            Some(near) if near.primitive < 12 => print!("{:7.3}  crate", near.distance - BUMPER),
            Some(near) => print!("{:7.3}   post", near.distance - BUMPER),
            None => print!("  clear       "),
        }
        println!("{touching:6}");
    }
    Ok(())
}
