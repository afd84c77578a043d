use glam::Vec3;

use super::{
    fit::{Frame, UPRIGHT, extents, fitted, frame, frame_along},
    wide::{Wide, cross, dot, square, sub, wide},
};
use crate::geometry::Obb;

/// Normals of slabs: sums and differences of coordinates, no products.
const SLABS: usize = 13;

/// The points that touch the slabs from within, in pairs.
type Touching = [(Vec3, Vec3); SLABS];

/// The coordinates along the normals: x, y, z, the four diagonals and those of the faces.
fn along([x, y, z]: [f32; 3]) -> [f32; SLABS] {
    [x, y, z, x + y + z, x + y - z, x - y + z, x - y - z, x + y, x - y, x + z, x - z, y + z, y - z]
}

/// Comparisons need not be exact: any points are good enough to find directions by.
fn touching(points: impl Iterator<Item = Vec3>) -> Option<Touching> {
    let mut found: Option<[(f32, Vec3, f32, Vec3); SLABS]> = None;
    for p in points {
        let places = along(p.to_array());
        match &mut found {
            None => found = Some(places.map(|at| (at, p, at, p))),
            Some(found) => {
                for ((low, lowest, high, highest), at) in found.iter_mut().zip(places) {
                    if at < *low {
                        (*low, *lowest) = (at, p);
                    }
                    if at > *high {
                        (*high, *highest) = (at, p);
                    }
                }
            }
        }
    }
    found.map(|found| found.map(|(_, lowest, _, highest)| (lowest, highest)))
}

/// The first of `things` for which `measure` is greatest.
fn greatest_by<T: Copy>(things: impl Iterator<Item = T>, measure: impl Fn(T) -> f64) -> Option<T> {
    let best = things.fold(None, |best: Option<(T, f64)>, thing| {
        let value = measure(thing);
        if best.is_none_or(|(_, greatest)| value > greatest) { Some((thing, value)) } else { best }
    });
    best.map(|(thing, _)| thing)
}

/// Half the surface of the box along a frame around some of the points.
fn half_area(frame: &Frame, from: Wide, points: impl Iterator<Item = Vec3>) -> f64 {
    let [x, y, z] = extents(frame, from, points).map(|(low, high)| high - low);
    x * y + y * z + z * x
}

/// The frames whose boxes have a face on the triangle and an edge along one of its sides.
fn frames([p, q, r]: [Wide; 3]) -> [Frame; 3] {
    let (side, other) = (sub(q, p), sub(r, p));
    [frame(side, other), frame(sub(r, q), side), frame(other, side)]
}

/// The best frame by the boxes around the touching points.
fn best(touching: &Touching) -> Frame {
    let points = touching.iter().flat_map(|&(low, high)| [low, high]);
    let [(first, _), ..] = *touching;
    let mut best = (UPRIGHT, half_area(&UPRIGHT, wide(first), points.clone()));
    let mut consider = |frame: Frame| {
        let area = half_area(&frame, wide(first), points.clone());
        if area < best.1 {
            best = (frame, area);
        }
    };

    // The base triangle: the widest pair, and the point farthest from its line.
    let pairs = touching.iter().map(|&(low, high)| (wide(low), wide(high)));
    let Some((p, q)) = greatest_by(pairs, |(low, high)| square(sub(high, low))) else { return UPRIGHT };
    let along = frame_along(sub(q, p));
    consider(along);
    let [side, ..] = along;
    let others = || points.clone().map(wide);
    let Some(r) = greatest_by(others(), |r| square(cross(sub(r, p), side))) else { return best.0 };

    // Two tetrahedra on it: their tips are the points farthest above and below.
    let [.., normal] = frame(side, sub(r, p));
    let above = greatest_by(others(), |tip| dot(tip, normal));
    let below = greatest_by(others(), |tip| -dot(tip, normal));
    frames([p, q, r]).into_iter().for_each(&mut consider);
    for tip in [above, below].into_iter().flatten() {
        for side in [[p, q, tip], [q, r, tip], [r, p, tip]] {
            frames(side).into_iter().for_each(&mut consider);
        }
    }
    best.0
}

impl Obb {
    /// A tight box in five passes: along the sides of two tetrahedra between the points that touch thirteen slabs, or
    /// along the coordinate axes if these have less surface.
    ///
    /// Larsson and Källberg, *Fast computation of tight-fitting oriented bounding boxes*, Game Engine Gems 2, 2011: the
    /// ditetrahedron algorithm, DiTO-26. All points are contained, as real numbers; `None` of no points, or if a
    /// coordinate is not finite or exceeds [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
    #[must_use]
    pub fn dito(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let upright = fitted(UPRIGHT, points.clone())?;
        let turned = fitted(best(&touching(points.clone())?), points)?;
        let area = |of: &Self| {
            let [x, y, z] = of.half_size.to_array().map(f64::from);
            x * y + y * z + z * x
        };
        Some(if area(&turned) < area(&upright) { turned } else { upright })
    }
}
