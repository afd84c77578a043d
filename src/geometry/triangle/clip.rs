//! Bounds of a clipped triangle, for perfect splits: Havran and Bittner, *On improving kd-trees for ray shooting*, 2002.

use glam::Vec3;

use super::Triangle;
use crate::geometry::{Aabb, Axis};

/// Six cuts add at most six corners to a triangle; roundings may make a sliver concave, so there is room to spare.
type Polygon = heapless::Vec<[f64; 3], 16>;

/// The sides of a cut that are kept.
#[derive(Clone, Copy)]
enum Keep {
    Above,
    Below,
}

/// The part of `polygon` on one side of a plane (Sutherland and Hodgman 1974); `None` if it has too many corners.
fn cut(polygon: &Polygon, axis: Axis, at: f64, keep: Keep) -> Option<Polygon> {
    let k = axis as usize;
    let kept = |v: &[f64; 3]| match keep {
        Keep::Above => v[k] >= at,
        Keep::Below => v[k] <= at,
    };
    let mut result = Polygon::new();
    let mut previous = *polygon.last()?;
    for &corner in polygon {
        if kept(&previous) != kept(&corner) {
            let s = (at - previous[k]) / (corner[k] - previous[k]);
            let ([x0, y0, z0], [x1, y1, z1]) = (previous, corner);
            let mut crossing = [(x0, x1), (y0, y1), (z0, z1)].map(|(from, to)| from + (to - from) * s);
            crossing[k] = at;
            result.push(crossing).ok()?;
        }
        if kept(&corner) {
            result.push(corner).ok()?;
        }
        previous = corner;
    }
    Some(result)
}

/// The greatest `f32` not above `x`.
fn down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// The least `f32` not below `x`.
fn up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}

/// See [`Triangle::clip`].
pub(super) fn bounds(triangle: &Triangle, cell: &Aabb) -> Option<Aabb> {
    let whole = triangle.bounds();
    let within = whole.intersection(cell);
    if within.is_empty() {
        return None;
    }
    if within == whole {
        return Some(whole);
    }
    // What the cuts round away is below 2^-50 of the largest coordinate.
    let largest = whole.min.abs().max(whole.max.abs()).max_element();
    let pad = f64::from(largest) / 70_368_744_177_664.0; // 2^46
    let mut polygon = Polygon::new();
    for corner in [triangle.a, triangle.b, triangle.c] {
        polygon.push(corner.to_array().map(f64::from)).ok()?;
    }
    for axis in Axis::ALL {
        let (lo, hi) = (axis.of(cell.min), axis.of(cell.max));
        let cuts = [
            (axis.of(whole.min) < lo, f64::from(lo) - pad, Keep::Above),
            (axis.of(whole.max) > hi, f64::from(hi) + pad, Keep::Below),
        ];
        for (needed, at, keep) in cuts {
            if needed {
                match cut(&polygon, axis, at, keep) {
                    Some(rest) => polygon = rest,
                    // Nothing left, or too ragged to say: only the former is certain.
                    None if polygon.is_empty() => return None,
                    None => return Some(within),
                }
            }
        }
    }
    if polygon.is_empty() {
        return None;
    }
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in &polygon {
        for i in 0..3 {
            min[i] = if corner[i] < min[i] { corner[i] } else { min[i] };
            max[i] = if corner[i] > max[i] { corner[i] } else { max[i] };
        }
    }
    let part = Aabb::new(Vec3::from_array(min.map(|x| down(x - pad))), Vec3::from_array(max.map(|x| up(x + pad))));
    let part = part.intersection(&within);
    (!part.is_empty()).then_some(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: Triangle = Triangle::new(Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0));

    #[test]
    fn parts_are_tight_and_never_too_small() {
        let cell = Aabb::new(Vec3::new(1.0, -1.0, -1.0), Vec3::new(2.0, 9.0, 1.0));
        let part = TRIANGLE.clip(&cell).unwrap();
        assert!(part.max.y >= 3.0 && part.max.y < 3.000_001, "{part:?}");
        assert_eq!((part.min.x, part.max.x), (1.0, 2.0));
    }

    #[test]
    fn outside_is_none_and_touching_is_some() {
        let at = |x: f32| Aabb::new(Vec3::new(x, 3.0, -1.0), Vec3::new(9.0, 9.0, 1.0));
        assert!(TRIANGLE.clip(&at(1.0)).is_some());
        assert!(TRIANGLE.clip(&at(1.1)).is_none());
        assert_eq!(TRIANGLE.clip(&Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0))), Some(TRIANGLE.bounds()));
    }
}
