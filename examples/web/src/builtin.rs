use std::f32::consts::TAU;

use hitscan::{
    geometry::{Aabb, Sphere},
    glam::{Mat3, Quat, Vec3},
    render::Material,
};

use crate::Model;

/// The models that need no file, the same bits on every target.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn;

impl BuiltIn {
    /// The model of this number in the page's list.
    #[must_use]
    pub fn model(number: u32) -> Option<Model> {
        Some(match number {
            0 => knot(),
            1 => sponge(),
            2 => terrain(),
            _ => return None,
        })
    }
}

/// The cosine and sine of an angle by the same arithmetic on every target.
fn turn(angle: f32) -> (f32, f32) {
    let at = Quat::from_rotation_z(angle) * Vec3::X;
    (at.x, at.y)
}

/// A knot of copper among balls that mirror it, on a checkered board.
fn knot() -> Model {
    const RINGS: u32 = 150;
    const CORNERS: u32 = 14;
    const ROPE: f32 = 0.34;
    let middle = |at: f32| {
        let ((cos, sin), (wide, high)) = (turn(TAU * (2.0 * at + 0.25)), turn(TAU * 3.0 * at));
        let radius = 1.0 + 0.45 * wide;
        Vec3::new(radius * cos, radius * sin + 1.79, 0.55 * high)
    };
    let copper = Material {
        diffuse: Vec3::new(0.60, 0.16, 0.04),
        specular: Vec3::new(1.0, 0.66, 0.42),
        shininess: 60.0,
        reflectivity: 0.18,
    };
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for ring in 0..RINGS {
        let at = ring as f32 / RINGS as f32;
        let (center, ahead) = (middle(at), middle(at + 1.0e-3));
        let along = (ahead - center).normalize_or_zero();
        // The frame leans on the direction away from the axis, which turns with the knot and so closes with it.
        let across = along.cross(Vec3::new(center.x, center.y - 1.79, 0.0)).normalize_or_zero();
        let out = across.cross(along);
        for corner in 0..CORNERS {
            let (cos, sin) = turn(corner as f32 / CORNERS as f32 * TAU);
            let normal = out * cos + across * sin;
            points.push((center + normal * ROPE, normal));
            let number = |ring: u32, corner: u32| (ring % RINGS) * CORNERS + corner % CORNERS;
            let [a, b] = [number(ring, corner), number(ring, corner + 1)];
            let [c, d] = [number(ring + 1, corner), number(ring + 1, corner + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    let mut model =
        Model { focus: Some(Aabb::new(Vec3::new(-2.2, -0.3, -1.6), Vec3::new(2.2, 2.8, 1.6))), ..Model::default() };
    model.push(&points, &triangles, copper);
    board(&mut model);
    let mirror = Material::matte(Vec3::splat(0.04)).with_highlights(0.9, 400.0).with_reflectivity(0.86);
    let glossy = |r, g, b| Material::matte(Vec3::new(r, g, b)).with_highlights(0.6, 120.0).with_reflectivity(0.12);
    for (x, z, radius, material) in [
        (-2.75, -1.15, 1.05, mirror),
        (2.55, -1.75, 1.3, mirror),
        (2.05, 1.65, 0.55, mirror),
        (-1.75, 1.75, 0.42, glossy(0.02, 0.30, 0.42)),
        (0.55, 2.45, 0.3, glossy(0.45, 0.03, 0.05)),
        (3.05, 0.35, 0.34, glossy(0.10, 0.35, 0.08)),
    ] {
        model.push_sphere(Sphere::new(Vec3::new(x, radius, z), radius), material);
    }
    model
}

/// Squares of two materials at height 0.
fn board(model: &mut Model) {
    const SQUARES: i32 = 12;
    let polished = |grey: f32, tint: Vec3| Material::matte(tint * grey).with_highlights(0.25, 90.0);
    let light = polished(0.78, Vec3::new(1.0, 0.97, 0.91)).with_reflectivity(0.10);
    let dark = polished(0.06, Vec3::new(0.9, 0.95, 1.1)).with_reflectivity(0.16);
    for (row, column) in (0..SQUARES).flat_map(|row| (0..SQUARES).map(move |column| (row, column))) {
        let at =
            |x: i32, z: i32| (Vec3::new((x - SQUARES / 2) as f32, 0.0, (z - SQUARES / 2) as f32) * 0.8, Vec3::ZERO);
        let points = [at(column, row), at(column, row + 1), at(column + 1, row + 1), at(column + 1, row)];
        model.push(&points, &[[0, 1, 2], [0, 2, 3]], if (row + column) % 2 == 0 { light } else { dark });
    }
}

/// A Menger sponge: a cube with holes that are holes again, 8,000 cubes of which only what is seen from outside is kept.
fn sponge() -> Model {
    const SIDE: i32 = 27;
    let solid = |cell: [i32; 3]| {
        cell.iter().all(|x| (0..SIDE).contains(x))
            && [1, 3, 9].iter().all(|third| cell.iter().filter(|x| *x / third % 3 == 1).count() < 2)
    };
    let stone = Material::matte(Vec3::new(0.72, 0.55, 0.30)).with_highlights(0.2, 40.0).with_reflectivity(0.06);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for n in 0..SIDE * SIDE * SIDE {
        let cell = [n % SIDE, n / SIDE % SIDE, n / (SIDE * SIDE)];
        for (axis, step) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut beside = cell;
            beside[axis] += step;
            if !solid(cell) || solid(beside) {
                continue;
            }
            let middle = Vec3::from(cell.map(|x| x as f32 + 0.5)) + Vec3::AXES[axis] * (step as f32 * 0.5);
            let (u, v) = (Vec3::AXES[(axis + 1) % 3] * 0.5, Vec3::AXES[(axis + 2) % 3] * (0.5 * step as f32));
            let first = points.len() as u32;
            points.extend([-u - v, u - v, u + v, v - u].map(|corner| ((middle + corner) / SIDE as f32, Vec3::ZERO)));
            triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|corner: u32| corner + first)));
        }
    }
    let mut model = Model::default();
    model.push(&points, &triangles, stone);
    model.on_the_ground()
}

/// Hills by the sum of turned waves, with water in the valleys.
fn terrain() -> Model {
    const SIDE: u32 = 96;
    let mut scale = 1.0;
    let waves: Vec<(Mat3, f32)> = (0..6)
        .map(|octave| {
            let frame = Mat3::from_rotation_y(octave as f32 * 1.3);
            let wave = (frame * (2.1 * scale), 0.32 / scale);
            scale *= 1.9;
            wave
        })
        .collect();
    let height = |x: f32, z: f32| -> f32 {
        let wave = |(frame, high): &(Mat3, f32)| {
            let at = *frame * Vec3::new(x, 0.0, z);
            (turn(at.x + 0.7).1 * turn(at.z * 1.1 + 0.4).0) * high
        };
        waves.iter().map(wave).sum()
    };
    let at = |n: u32| n as f32 / SIDE as f32 * 4.0 - 2.0;
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (row, column) in (0..=SIDE).flat_map(|row| (0..=SIDE).map(move |column| (row, column))) {
        points.push(Vec3::new(at(column), height(at(column), at(row)), at(row)));
        if row < SIDE && column < SIDE {
            let (a, b) = (row * (SIDE + 1) + column, (row + 1) * (SIDE + 1) + column);
            triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
        }
    }
    let normals = crate::normals::normals(&points, &triangles);
    let points: Vec<(Vec3, Vec3)> = points.into_iter().zip(normals).collect();
    let grass = Material::matte(Vec3::new(0.23, 0.30, 0.10));
    let water = Material::matte(Vec3::new(0.02, 0.10, 0.14)).with_highlights(0.8, 200.0).with_reflectivity(0.45);
    let mut model =
        Model { focus: Some(Aabb::new(Vec3::new(-1.4, -0.4, -1.4), Vec3::new(1.4, 0.4, 1.4))), ..Model::default() };
    model.push(&points, &triangles, grass);
    let corners =
        [(-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -2.0)].map(|(x, z)| (Vec3::new(x, -0.12, z), Vec3::ZERO));
    model.push(&corners, &[[0, 1, 2], [0, 2, 3]], water);
    model
}
