//! What an 8 x 8 time-of-flight sensor sees of a room's corner with a ball in it: depths and angles in one table.
//!
//! `cargo run --example ranges`

use hitscan::{
    Arena, Error, KdTree, Mesh, Scene,
    geometry::Sphere,
    glam::Vec3,
    kdtree::Options,
    primitives::Spheres,
    sensor::{Pose, RangeSensor, depth_zones},
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

    let beams = depth_zones::<8, 8>([45_f32.to_radians(); 2]);
    let sensor = RangeSensor::new(beams.as_flattened()).in_units_of(0.001).within(20.0, 4000.0);
    let pose = Pose::looking(Vec3::new(3.0, 1.5, 3.0), Vec3::new(1.0, 0.8, 1.0), Vec3::Y);
    for (zone, echo) in sensor.echoes(&scene, &pose).enumerate() {
        match echo {
            Some(echo) => {
                let mark = if echo.primitive == 6 { '*' } else { ' ' };
                print!("{:5.0}{mark}{:3.0} ", echo.range, echo.cosine * 100.0);
            }
            None => print!("    -     "),
        }
        if zone % 8 == 7 {
            println!();
        }
    }
    println!("depth in millimetres, * on the ball; cosine of incidence in percent");
    println!("{} bytes of tree", tree.as_words().len() * 4);
    Ok(())
}
