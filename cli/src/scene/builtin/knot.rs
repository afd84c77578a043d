use std::f32::consts::TAU;

use hitscan::{glam::Vec3, render::Material};

use super::Builder;

/// Turns around the axis and around the torus's tube.
const TURNS: (f32, f32) = (2.0, 3.0);

/// Rings along the knot and corners of a ring.
const RINGS: u32 = 720;
const CORNERS: u32 = 48;

/// Half the rope's thickness.
const ROPE: f32 = 0.34;

/// A torus knot that stands on the board.
pub(super) fn build(builder: &mut Builder) {
    let copper = Material {
        diffuse: Vec3::new(0.50, 0.13, 0.045),
        specular: Vec3::new(1.0, 0.62, 0.38),
        shininess: 70.0,
        reflectivity: 0.22,
    };
    let mut points = Vec::new();
    for ring in 0..RINGS {
        let at = ring as f32 / RINGS as f32;
        let (center, ahead) = (middle(at), middle(at + 1.0e-3));
        let along = (ahead - center).normalize_or_zero();
        // The frame leans on the direction away from the axis, which turns with the knot and so closes with it.
        let across = along.cross(away(center)).normalize_or_zero();
        let out = across.cross(along);
        for corner in 0..CORNERS {
            let (sin, cos) = (corner as f32 / CORNERS as f32 * TAU).sin_cos();
            let normal = out * cos + across * sin;
            points.push((center + normal * ROPE, normal));
        }
    }
    let number = |ring: u32, corner: u32| (ring % RINGS) * CORNERS + corner % CORNERS;
    let mut triangles = Vec::new();
    for (ring, corner) in (0..RINGS).flat_map(|ring| (0..CORNERS).map(move |corner| (ring, corner))) {
        let [a, b] = [number(ring, corner), number(ring, corner + 1)];
        let [c, d] = [number(ring + 1, corner), number(ring + 1, corner + 1)];
        triangles.extend([[a, c, b], [b, c, d]]);
    }
    builder.push(&points, &triangles, copper);
}

/// The middle of the rope, `at` from 0 to 1.
fn middle(at: f32) -> Vec3 {
    let (around, through) = (TURNS.0 * at * TAU, TURNS.1 * at * TAU);
    let radius = 1.0 + 0.45 * through.cos();

    // Upright, its lowest point one rope above the board.
    Vec3::new(radius * around.cos(), radius * around.sin() + 1.45 + ROPE, 0.55 * through.sin())
}

/// Away from the knot's axis.
fn away(point: Vec3) -> Vec3 {
    Vec3::new(point.x, point.y - 1.45 - ROPE, 0.0).normalize_or_zero()
}
