//! The quest for realism: one scene in five pictures, each with one term of light more; small and side by side, too.
//!
//! `cargo run --release --features std --example realism`

mod stage;

use hitscan::{
    KdTree, Mesh, Primitives, Scene,
    accel::Plan,
    bake,
    geometry::Sphere,
    glam::Vec3,
    kdtree::Options,
    primitives::Spheres,
    render::{Camera, Light, Material, Materials, Numbers, Renderer, Terms},
};

fn main() -> stage::Fallible {
    let (vertices, triangles) = stage::knot(200);
    let mesh = Mesh::new(&vertices, &triangles[..])?;
    let balls = [Sphere::new(Vec3::new(0.0, -100.45, 0.0), 100.0), Sphere::new(Vec3::new(0.0, 0.2, 0.0), 0.35)];
    let both = (mesh, Spheres::new(&balls)?);
    let words = bake::build(&both, &Plan::KdTree(Options::balanced()))?;
    let scene = Scene::new(KdTree::open(&words)?, &both)?;

    let shiny = |color, reflectivity| Material::matte(color).with_highlights(0.6, 40.0).with_reflectivity(reflectivity);
    let palette = [shiny(Vec3::new(0.8, 0.3, 0.1), 0.1), shiny(Vec3::splat(0.5), 0.15), shiny(Vec3::splat(0.1), 0.8)];
    let mut numbers = vec![0_u8; mesh.len() as usize];
    numbers.extend([1, 2]);
    let lights = [Light::point(Vec3::new(3.0, 4.0, 2.0), Vec3::ONE)];
    let camera = Camera::pinhole(Vec3::new(1.2, 1.6, 2.4), Vec3::new(0.0, -0.1, 0.0), Vec3::Y, 0.8);
    let renderer = |width, height| {
        Renderer::new(&scene, camera, width, height)
            .with_lights(&lights)
            .with_materials(Materials::new(&palette, Numbers::Narrow(&numbers)))
            .with_bounces(4)
            .with_samples(4)
    };

    let ambient = Terms { ambient: true, ..Terms::NONE };
    let diffuse = Terms { diffuse: true, ..ambient };
    let specular = Terms { specular: true, ..diffuse };
    let shadows = Terms { shadows: true, ..specular };
    let steps = [ambient, diffuse, specular, shadows, Terms::ALL];
    for (terms, name) in steps.into_iter().zip(["1-ambient", "2-diffuse", "3-specular", "4-shadows", "5-reflections"]) {
        stage::save(name, &renderer(480, 360).with_terms(terms))?;
    }
    let small = steps.map(|terms| renderer(160, 120).with_terms(terms));
    let rows = small[0].scanlines();
    let pixels: Vec<[u8; 3]> = rows.flat_map(|row| small.iter().flat_map(move |step| step.colors(row))).collect();
    stage::save_pixels("realism", 5 * 160, &pixels)
}
