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

/// A torus knot that stands on the board on two of its three lobes.
pub(super) fn build(builder: &mut Builder) {
    let copper = Material {
        diffuse: Vec3::new(0.60, 0.16, 0.04),
        specular: Vec3::new(1.0, 0.66, 0.42),
        shininess: 60.0,
        reflectivity: 0.18,
    };
    let mut points = Vec::new();
    for ring in 0..RINGS {
        let at = ring as f32 / RINGS as f32;
        let (center, ahead) = (middle(at), middle(at + 1.0e-3));
        let along = (ahead - center).normalize_or_zero();
        // The frame leans on the direction away from the axis, which turns with the knot and so closes with it.
        let across = along.cross(center.with_z(0.0)).normalize_or_zero();
        let out = across.cross(along);
        for corner in 0..CORNERS {
            let (sin, cos) = (corner as f32 / CORNERS as f32 * TAU).sin_cos();
            let normal = out * cos + across * sin;
            points.push((center + normal * ROPE, normal));
        }
    }
    let lowest = points.iter().map(|(point, _)| point.y).fold(f32::INFINITY, f32::min);
    points.iter_mut().for_each(|(point, _)| point.y -= lowest);
    let number = |ring: u32, corner: u32| (ring % RINGS) * CORNERS + corner % CORNERS;
    let mut triangles = Vec::new();
    for (ring, corner) in (0..RINGS).flat_map(|ring| (0..CORNERS).map(move |corner| (ring, corner))) {
        let [a, b] = [number(ring, corner), number(ring, corner + 1)];
        let [c, d] = [number(ring + 1, corner), number(ring + 1, corner + 1)];
        triangles.extend([[a, b, c], [b, d, c]]);
    }
    builder.push(&points, &triangles, copper);
}

/// The middle of the rope, `at` from 0 to 1, around the z axis.
fn middle(at: f32) -> Vec3 {
    let (around, through) = (TURNS.0 * at * TAU, TURNS.1 * at * TAU);
    let radius = 1.0 + 0.45 * through.cos();
    // A quarter turn puts one lobe on top.
    let (sin, cos) = (around + TAU / 4.0).sin_cos();
    Vec3::new(radius * cos, radius * sin, 0.55 * through.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_point_out_of_the_fronts() {
        let mut builder = Builder::default();
        build(&mut builder);
        for corners in &builder.triangles {
            let [a, b, c] = corners.map(|corner| builder.vertices[corner as usize]);
            let normal = builder.normals[corners[0] as usize];
            assert!((b - a).cross(c - a).dot(normal) > 0.0);
        }
    }
}
