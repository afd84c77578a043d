//! From directions to the box: the part of all oriented boxes that must not err.

use glam::{Mat3, Vec3};

use super::wide::{Wide, add, cross, dot, narrow, scale, square, sub, unit, upward, wide};
use crate::geometry::{Obb, in_range};

/// Three directions, orthonormal.
pub(super) type Frame = [Wide; 3];

/// The directions of the coordinate axes.
pub(super) const UPRIGHT: Frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The frame of two directions, of which the second is turned until it is at right angles; if they are all but
/// parallel, that of the first alone.
pub(super) fn frame(first: Wide, second: Wide) -> Frame {
    let turned = unit(first).zip(unit(second)).and_then(|(x, y)| {
        let z = cross(x, y);
        // Of less only the roundings would be turned into a direction.
        if square(z) > 1.0e-12 { Some((x, unit(z)?)) } else { None }
    });
    turned.map_or_else(|| frame_along(first), |(x, z)| [x, cross(z, x), z])
}

/// The frame that begins with this direction; upright if it is none.
pub(super) fn frame_along(first: Wide) -> Frame {
    let Some(x) = unit(first) else { return UPRIGHT };
    let [a, b, c] = x.map(f64::abs);
    let [e, f, g] = UPRIGHT;
    // At 54 degrees or more to the first.
    let aside = if a <= b && a <= c {
        e
    } else if b <= c {
        f
    } else {
        g
    };
    let z = unit(cross(x, aside)).unwrap_or(g);
    [x, cross(z, x), z]
}

/// The least and the greatest of `axis · (p - from)` for each axis.
pub(super) fn extents(frame: &Frame, from: Wide, points: impl Iterator<Item = Vec3>) -> [(f64, f64); 3] {
    let mut found = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    for p in points {
        let away = sub(wide(p), from);
        for ((low, high), axis) in found.iter_mut().zip(frame) {
            let along = dot(*axis, away);
            *low = if along < *low { along } else { *low };
            *high = if along > *high { along } else { *high };
        }
    }
    found
}

/// The least box along `frame` around all of `points`; `None` of none, or if one is not in range.
///
/// *Contains them:* the axes are rounded first, so that they are what a point is held against. Its distances along them
/// are off by less than `2^-50` of its distance, which is added before they are rounded upward.
pub(super) fn fitted(frame: Frame, points: impl Iterator<Item = Vec3> + Clone) -> Option<Obb> {
    let columns = frame.map(narrow);
    let axes = columns.map(wide);
    // Measured from a point of it, so that a far object does not lose its digits.
    let from = wide(points.clone().next()?);
    let middles = extents(&axes, from, points.clone()).map(|(low, high)| (low + high) * 0.5);
    let center = axes.iter().zip(middles).fold(from, |center, (&axis, middle)| add(center, scale(axis, middle)));
    let center = narrow(center);
    let mut half = [0.0; 3];
    for point in points {
        if !in_range(point) {
            return None;
        }
        let away = sub(wide(point), wide(center));
        let error = away.iter().map(|x| x.abs()).sum::<f64>() / 1_125_899_906_842_624.0;
        for (half, axis) in half.iter_mut().zip(axes) {
            let along = dot(axis, away).abs() + error;
            *half = if along > *half { along } else { *half };
        }
    }
    let [x, y, z] = columns;
    Some(Obb::new(center, Mat3::from_cols(x, y, z), Vec3::from_array(half.map(upward))))
}
