//! Instancing: a thousand million triangles in a few megabytes. A knot is placed 1,728 times, and that 125 times.
//!
//! `cargo run --release --features std --example billion`

mod stage;

use hitscan::{
    Instance, Instances, KdTree, Mesh, Primitives, Scene,
    accel::Plan,
    bake,
    geometry::Transform,
    glam::{Mat3, Vec3},
    kdtree::Options,
    render::{Camera, Light, Renderer},
};

/// A cube of `side`³ places, each turned another way.
fn places(side: i32, spacing: f32) -> Result<Vec<Instance>, hitscan::Error> {
    let at =
        |i: i32| [i % side, i / side % side, i / side / side].map(|k| (k as f32 - (side - 1) as f32 / 2.0) * spacing);
    let turn = |i: i32| Mat3::from_rotation_x(i as f32) * Mat3::from_rotation_y(i as f32 * 0.7);
    (0..side.pow(3)).map(|i| Ok(Instance::new(0, Transform::new(turn(i), Vec3::from_array(at(i)))?))).collect()
}

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(100);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    let plan = Plan::KdTree(Options::balanced());
    let knot_words = bake::build(&mesh, &plan)?;
    let knots = [Scene::new(KdTree::open(&knot_words)?, mesh)?];

    let mut placed = places(12, 2.3)?;
    let cloud = Instances::place(&knots, &mut placed)?;
    let cloud_words = bake::build(&cloud, &plan)?;
    let clouds = [Scene::new(KdTree::open(&cloud_words)?, cloud)?];

    let mut placed = places(5, 50.0)?;
    let sky = Instances::place(&clouds, &mut placed)?;
    let sky_words = bake::build(&sky, &plan)?;
    let scene = Scene::new(KdTree::open(&sky_words)?, sky)?;

    let bytes = 4 * (knot_words.len() + cloud_words.len() + sky_words.len());
    println!("{} triangles, {} of their own, {bytes} bytes of trees", sky.numbers(), mesh.len());
    let lights = [Light::directional(Vec3::new(-1.0, -1.0, -3.0), Vec3::ONE)];
    let camera = Camera::pinhole(Vec3::new(95.0, 65.0, 150.0), Vec3::new(10.0, 0.0, 0.0), Vec3::Y, 0.9);
    stage::save("billion", &Renderer::new(&scene, camera, 640, 480).with_lights(&lights))?;
    println!("at most {} of memory", stage::peak_memory().unwrap_or("an unknown amount".to_owned()));
    Ok(())
}
