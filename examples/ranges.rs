//! An 8 x 8 range image of a room corner with a ball in it, as a time-of-flight sensor sees it: one table.
//!
//! `cargo run --example ranges`

use hitscan::{
    Arena, Error, KdTree, Mesh, Ray, Scene, geometry::Sphere, glam::Vec3, kdtree::Options, primitives::Spheres,
};

fn main() -> Result<(), Error> {
    // A floor and two walls, 4 m each.
    let vertices = [0, 1, 2, 3, 4, 5, 6].map(|i| {
        let bits = [0b000, 0b001, 0b101, 0b100, 0b011, 0b010, 0b110][i];
        Vec3::new((bits & 1) as f32, (bits >> 1 & 1) as f32, (bits >> 2 & 1) as f32) * 4.0
    });
    let triangles = [[0_u16, 2, 1], [0, 3, 2], [0, 1, 4], [0, 4, 5], [0, 5, 6], [0, 6, 3]];
    let balls = [Sphere::new(Vec3::new(1.2, 0.6, 1.2), 0.6)];
    let room = (Mesh::new(&vertices, &triangles)?, Spheres::new(&balls)?);

    let mut memory = [0; KdTree::words(7, &Options::small())];
    let tree = KdTree::build(&room, &mut Arena::new(&mut memory), &Options::small())?;
    let scene = Scene::new(tree, &room)?;

    let eye = Vec3::new(3.0, 1.5, 3.0);
    for row in 0..8 {
        for column in 0..8 {
            let (u, v) = (column as f32 / 7.0 - 0.5, 0.5 - row as f32 / 7.0);
            let direction = Vec3::new(-1.0 + u * 0.8, v - 0.3, -1.0 - u * 0.8).normalize();
            match scene.closest_hit(&Ray::new(eye, direction).up_to(8.0)) {
                Some(hit) => print!("{:5.2}{}", hit.t, if hit.primitive == 6 { '*' } else { ' ' }),
                None => print!("    - "),
            }
        }
        println!();
    }
    println!("metres; * is the ball; {} bytes of tree", tree.as_words().len() * 4);
    Ok(())
}
