use hitscan::{glam::Vec3, render::Material};

use super::Builder;

/// Squares along a side.
const SQUARES: i32 = 14;

/// The side of a square.
const SIDE: f32 = 0.75;

/// A checkered board at height 0, its squares of two materials.
pub(super) fn build(builder: &mut Builder) {
    let polished = |grey: f32, tint: Vec3| Material::matte(tint * grey).with_highlights(0.25, 90.0);
    let light = polished(0.78, Vec3::new(1.0, 0.97, 0.91)).with_reflectivity(0.10);
    let dark = polished(0.06, Vec3::new(0.9, 0.95, 1.1)).with_reflectivity(0.16);
    let edge = SQUARES as f32 * SIDE * 0.5;
    for (row, column) in (0..SQUARES).flat_map(|row| (0..SQUARES).map(move |column| (row, column))) {
        let (x, z) = (column as f32 * SIDE - edge, row as f32 * SIDE - edge);
        let corner = |dx: f32, dz: f32| (Vec3::new(x + dx * SIDE, 0.0, z + dz * SIDE), Vec3::ZERO);
        let material = if (row + column) % 2 == 0 { light } else { dark };
        builder.push(
            &[corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 1.0), corner(1.0, 0.0)],
            &[[0, 1, 2], [0, 2, 3]],
            material,
        );
    }
    rim(builder, edge);
}

/// The wooden frame around and below the squares.
fn rim(builder: &mut Builder, edge: f32) {
    const WIDTH: f32 = 0.35;
    const DEPTH: f32 = 0.3;
    let wood = Material::matte(Vec3::new(0.16, 0.065, 0.025)).with_highlights(0.3, 60.0).with_reflectivity(0.08);
    let out = edge + WIDTH;
    for (side, along) in
        [(Vec3::X, Vec3::NEG_Z), (Vec3::NEG_Z, Vec3::NEG_X), (Vec3::NEG_X, Vec3::Z), (Vec3::Z, Vec3::X)]
    {
        let [inner, outer] = [edge, out].map(|at| [side * at - along * at, side * at + along * at]);
        let below = outer.map(|point| point - Vec3::Y * DEPTH);
        let points = [inner[0], inner[1], outer[0], outer[1], below[0], below[1]].map(|point| (point, Vec3::ZERO));
        builder.push(&points, &[[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]], wood);
    }
}
