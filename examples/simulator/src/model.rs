//! What is shown: a torus knot of 5,120 triangles beside a mirror, on a floor.

use std::{error::Error, iter};

use hitscan::{
    Arena, KdTree, Mesh, Scene,
    geometry::Sphere,
    glam::Vec3,
    kdtree::Options,
    primitives::Spheres,
    render::{Camera, Light, Material, Materials, Numbers, Renderer},
};

#[path = "../../firmware/bake/knot.rs"]
mod knot;

type Shapes<'a> = (Mesh<'a>, Spheres<'a>);

/// The picture, as large as a display.
pub type Picture<'a> = Renderer<'a, Scene<KdTree<'a>, Shapes<'a>>>;

/// What `show` shows of the scene, when it asks for pictures by their size.
pub fn with<R>(
    show: impl for<'a> FnOnce(&dyn Fn(u32, u32) -> Picture<'a>) -> Result<R, Box<dyn Error>>,
) -> Result<R, Box<dyn Error>> {
    let (vertices, triangles) = knot::mesh(160, 16);
    let floor = vertices.iter().map(|vertex| vertex.z).fold(0.0, f32::min);
    let balls =
        [Sphere::new(Vec3::new(0.0, 0.0, floor - 200.0), 200.0), Sphere::new(Vec3::new(1.45, -1.5, floor + 0.4), 0.4)];
    let shapes = (Mesh::new(&vertices, triangles.as_slice())?, Spheres::new(&balls)?);
    let mut memory = vec![0; KdTree::words(triangles.len() + balls.len(), &Options::balanced())];
    let tree = KdTree::build(&shapes, &mut Arena::new(&mut memory), &Options::balanced())?;
    let scene = Scene::new(tree, shapes)?;

    let palette = [
        Material::matte(Vec3::new(0.9, 0.34, 0.09)).with_highlights(0.5, 40.0).with_reflectivity(0.08),
        Material::matte(Vec3::splat(0.05)).with_reflectivity(0.12),
        Material::matte(Vec3::splat(0.05)).with_highlights(0.9, 200.0).with_reflectivity(0.85),
    ];
    let numbers: Vec<u8> = iter::repeat_n(0, triangles.len()).chain([1, 2]).collect();
    let lights = [Light::point(Vec3::new(3.0, -2.5, 6.0), Vec3::splat(1.3))];
    show(&|width, height| {
        // The knot is wider than high.
        let fov = if width < 2 * height { 0.64 } else { 0.44 };
        let camera = Camera::pinhole(Vec3::new(0.6, -5.2, 3.6), Vec3::new(0.0, -0.1, -0.1), Vec3::Z, fov);
        Renderer::new(&scene, camera, width, height)
            .with_lights(&lights)
            .with_materials(Materials::new(&palette, Numbers::Narrow(&numbers)))
            .with_background(Vec3::new(0.03, 0.06, 0.12), Vec3::ZERO)
            .with_bounces(2)
            .with_samples(2)
    })
}
