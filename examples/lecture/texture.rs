//! A texture: a checkerboard of 16 bytes on a floor, as squares and blended, and as colours of the knot upon it.
//!
//! `cargo run --release --features std --example texture`

mod stage;

use hitscan::{
    KdTree, Mesh, Scene,
    accel::Plan,
    bake,
    glam::{Vec2, Vec3},
    kdtree::Options,
    primitives::{Mapped, TexCoords},
    render::{Camera, Filter, Light, Material, Materials, Numbers, Renderer, Texels, Texture, Textured, Textures},
};

fn main() -> stage::Fallible {
    let (mut vertices, mut triangles) = stage::knot(200);
    // Once around the tube is once across the picture, and eight pictures long.
    let along = |vertex: u32| Vec2::new((vertex % 24) as f32 / 24.0, (vertex / 24) as f32 / 25.0);
    let mut coordinates: Vec<Vec2> = (0..vertices.len() as u32).map(along).collect();
    let first = vertices.len() as u32;
    let corners = [Vec2::new(-4.0, -4.0), Vec2::new(-4.0, 4.0), Vec2::new(4.0, 4.0), Vec2::new(4.0, -4.0)];
    vertices.extend(corners.map(|at| Vec3::new(at.x, -0.45, at.y)));
    coordinates.extend(corners);
    let knot = triangles.len();
    triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);

    let mesh = Mesh::new(&vertices, &triangles[..])?;
    let words = bake::build(&mesh, &Plan::KdTree(Options::balanced()))?;
    let scene = Scene::new(KdTree::open(&words)?, Mapped::new(mesh, &mesh, TexCoords::new(&coordinates)))?;
    let palette = [Material::default(), Material::matte(Vec3::ONE).with_reflectivity(0.1)];
    let numbers: Vec<u8> = (0..triangles.len()).map(|triangle| u8::from(triangle >= knot)).collect();
    let materials = Materials::new(&palette, Numbers::Narrow(&numbers));

    let stripes = Texture::new(1, 4, Texels::Palette4 { palette: &[0xfd20, 0x02ff], texels: &[0x00, 0x11] })?;
    let board = Texels::Palette4 { palette: &[0xef7d, 0x39e7], texels: &[0x10, 0x10, 0x01, 0x01] };
    for (name, filter) in [("texture-nearest", Filter::Nearest), ("texture-bilinear", Filter::Bilinear)] {
        let textures = [stripes, Texture::new(4, 2, board)?].map(|texture| Some(texture.with_filter(filter)));
        let textured = Textured::new(&scene, materials, Textures::new(&textures));
        let lights = [Light::point(Vec3::new(3.0, 4.0, 2.0), Vec3::ONE)];
        let camera = Camera::pinhole(Vec3::new(1.2, 1.6, 2.4), Vec3::new(0.0, -0.1, 0.0), Vec3::Y, 0.8);
        let renderer = Renderer::new(&textured, camera, 480, 360).with_lights(&lights).with_materials(materials);
        stage::save(name, &renderer.with_bounces(2).with_samples(4))?;
    }
    Ok(())
}
