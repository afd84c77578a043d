//! How many cells along each axis.

use super::MAX_RESOLUTION;
use crate::{
    geometry::Aabb,
    math::{self, greatest, least},
};

/// The resolution that divides `bounds` into at most `cells` cells as nearly cubes as can be.
///
/// The edge of a cube is the cube root of a cell's part of the volume (Cleary et al. 1983); of a box thinner than that,
/// the square root of its part of the area, and of a rod, its part of the length.
pub(super) fn resolution(bounds: &Aabb, cells: u32) -> [u32; 3] {
    let size = bounds.size();
    let largest = size.max_element();
    if !(largest > 0.0) {
        return [1; 3];
    }
    // Sides relative to the largest, which is 1.
    let [x, y, z] = [size.x / largest, size.y / largest, size.z / largest];
    let low = least(least(x, y), z);
    let middle = greatest(least(x, y), least(greatest(x, y), z));
    let count = cells as f32;
    // How many cubes stand along the largest side.
    let along = if low > 0.0 && count * low * low >= middle {
        math::pow(count / (low * middle), 1.0 / 3.0)
    } else if count * middle >= 1.0 {
        math::sqrt(count / middle)
    } else {
        count
    };
    let cubes = |side: f32| ((along * side) as u32).clamp(1, MAX_RESOLUTION);
    let mut counts = [cubes(x), cubes(y), cubes(z)];
    // There may be a few too many by rounding.
    let product = |[x, y, z]: [u32; 3]| u64::from(x) * u64::from(y) * u64::from(z);
    while product(counts) > u64::from(cells.max(1)) {
        let most = counts.iter().copied().max().unwrap_or(1);
        if let Some(count) = counts.iter_mut().find(|count| **count == most) {
            *count = (*count - 1).max(1);
        }
    }
    counts
}
