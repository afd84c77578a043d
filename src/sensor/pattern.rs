//! Beams of common sensors, in their own coordinates: x to the right, y down, z ahead.

use core::array;

use glam::Vec3;

use crate::{math, primitives::unit};

/// The middles of zones behind a lens, rows from the top and each from the left, with 1 ahead: ranges along them are
/// depths, as imagers report them.
///
/// `fov` is the angle of view across and down, in radians; the zones divide the image, not the angle, evenly.
///
/// ```
/// use hitscan::sensor::depth_zones;
/// let [[left, right]] = depth_zones::<2, 1>([90_f32.to_radians(); 2]);
/// assert_eq!((left.z, right.z), (1.0, 1.0));
/// assert!((left.x + 0.5).abs() < 1e-6 && (right.x - 0.5).abs() < 1e-6);
/// ```
#[must_use]
pub fn depth_zones<const COLUMNS: usize, const ROWS: usize>(fov: [f32; 2]) -> [[Vec3; COLUMNS]; ROWS] {
    let [across, down] = fov.map(|angle| math::tan(angle * 0.5));
    let middle = |index: usize, count: usize| (2 * index + 1) as f32 / count as f32 - 1.0;
    array::from_fn(|row| {
        array::from_fn(|column| Vec3::new(across * middle(column, COLUMNS), down * middle(row, ROWS), 1.0))
    })
}

/// The same directions as [`depth_zones`], as unit vectors: ranges along them are distances.
#[must_use]
pub fn zones<const COLUMNS: usize, const ROWS: usize>(fov: [f32; 2]) -> [[Vec3; COLUMNS]; ROWS] {
    depth_zones(fov).map(|row| row.map(unit))
}

/// Unit vectors ahead, raised by these angles in radians: the lasers of a lidar, to be turned about its axis.
///
/// ```
/// use hitscan::{glam::Vec3, sensor::rings};
/// assert_eq!(rings([0.0]), [Vec3::Z]);
/// ```
#[must_use]
pub fn rings<const COUNT: usize>(elevations: [f32; COUNT]) -> [Vec3; COUNT] {
    elevations.map(|elevation| {
        let (sin, cos) = math::sin_cos(elevation);
        Vec3::new(0.0, -sin, cos)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_are_symmetric_unit_vectors_within_the_view() {
        let beams = zones::<8, 4>([0.8, 0.4]);
        for (row, mirrored) in beams.iter().zip(beams.iter().rev()) {
            for (beam, other) in row.iter().zip(mirrored.iter().rev()) {
                assert!((beam.length() - 1.0).abs() < 1.0e-6);
                assert!((beam.x + other.x).abs() < 1.0e-6 && (beam.y + other.y).abs() < 1.0e-6);
                assert!((beam.x / beam.z).atan().abs() < 0.4 && (beam.y / beam.z).atan().abs() < 0.2);
            }
        }
        // From the left, from the top.
        assert!(beams[0][0].x < beams[0][1].x && beams[0][0].y < beams[1][0].y);
    }

    #[test]
    fn rings_rise() {
        let beams = rings([-0.2, 0.0, 0.3]);
        assert!(beams.is_sorted_by(|a, b| a.y > b.y));
        assert!(beams.iter().all(|beam| (beam.length() - 1.0).abs() < 1.0e-6 && beam.x == 0.0));
    }
}
