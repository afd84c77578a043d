//! The built-in scene: a knot of copper, a board to stand on, balls that mirror it all.

mod board;
mod knot;

use hitscan::{
    geometry::Sphere,
    glam::Vec3,
    render::{Light, Material},
};

use super::{Geometry, Palette};
use crate::stage::{CameraArg, Lighting};

/// What is built in.
#[derive(Debug)]
pub struct BuiltIn {
    /// Knot and board.
    pub geometry: Geometry,
    /// A normal per vertex, zero where triangles are meant to be flat.
    pub normals: Vec<Vec3>,
    /// Balls, numbered after the triangles.
    pub spheres: Vec<Sphere>,
    /// Materials of triangles and balls.
    pub palette: Palette,
}

/// Triangles under construction.
#[derive(Debug, Default)]
struct Builder {
    vertices: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    palette: Palette,
}

impl Builder {
    /// Adds triangles of one material, their corners counted from the first of `points`, each with its normal.
    fn push(&mut self, points: &[(Vec3, Vec3)], triangles: &[[u32; 3]], material: Material) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(points.iter().map(|(point, _)| *point));
        self.normals.extend(points.iter().map(|(_, normal)| *normal));
        self.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        self.palette.push(material, triangles.len());
    }
}

impl BuiltIn {
    /// From where it looks best.
    pub const CAMERA: CameraArg = CameraArg::new(Vec3::new(1.2, 4.3, 8.7), Vec3::new(0.05, 1.0, 0.0), 34.0);

    /// A warm lamp, a weak cold one, and a soft sky.
    pub fn lighting() -> Lighting {
        Lighting {
            lights: vec![
                Light::point(Vec3::new(-5.5, 8.5, 6.0), Vec3::new(1.02, 0.90, 0.74)),
                Light::point(Vec3::new(7.0, 5.0, 2.5), Vec3::new(0.20, 0.26, 0.36)),
            ],
            ambient: Vec3::new(0.15, 0.17, 0.21),
            background: [Vec3::new(0.44, 0.48, 0.57), Vec3::new(0.004, 0.02, 0.09)],
        }
    }

    /// Makes it; the same bits every time.
    pub fn new() -> Self {
        let mut builder = Builder::default();
        knot::build(&mut builder);
        board::build(&mut builder);
        let Builder { vertices, normals, triangles, mut palette } = builder;
        let spheres = balls().map(|(sphere, material)| {
            palette.push(material, 1);
            sphere
        });
        let spheres = spheres.collect();
        Self { geometry: Geometry::new(vertices, triangles, Palette::default()), normals, spheres, palette }
    }
}

/// Balls on the board, with their materials.
fn balls() -> impl Iterator<Item = (Sphere, Material)> {
    let mirror = Material::matte(Vec3::splat(0.04)).with_highlights(0.9, 400.0).with_reflectivity(0.86);
    let glossy = |r, g, b| Material::matte(Vec3::new(r, g, b)).with_highlights(0.6, 120.0).with_reflectivity(0.12);
    let resting = |x, z, radius: f32, material| (Sphere::new(Vec3::new(x, radius, z), radius), material);
    [
        resting(-2.75, -1.15, 1.05, mirror),
        resting(2.55, -1.75, 1.3, mirror),
        resting(2.05, 1.65, 0.55, mirror),
        resting(-1.75, 1.75, 0.42, glossy(0.02, 0.30, 0.42)),
        resting(-2.75, 0.95, 0.3, glossy(0.75, 0.42, 0.03)),
        resting(0.55, 2.45, 0.3, glossy(0.45, 0.03, 0.05)),
        resting(3.05, 0.35, 0.34, glossy(0.10, 0.35, 0.08)),
        resting(-0.75, 2.75, 0.22, mirror),
    ]
    .into_iter()
}
