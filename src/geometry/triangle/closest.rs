//! The point of a triangle closest to another: Ericson, *Real-Time Collision Detection*, 2005, §5.1.5, for slivers too.
//!
//! In `f64`, whose exponents hold all products of six coordinates: nothing over- or underflows. A test is about a hundred
//! operations, soft ones where there are no doubles in hardware.
//!
//! Whatever is rounded, the answer is a mean of corners with weights that are not negative, so that it lies on the triangle
//! up to 2^-50 of the largest coordinate difference: the distance is hardly ever too small, and the search of
//! [`Scene::nearest_point`](crate::Scene::nearest_point) rests on that.

use glam::Vec3;

use super::Triangle;

type V = [f64; 3];

fn between(from: Vec3, to: Vec3) -> V {
    let difference = |to: f32, from: f32| f64::from(to) - f64::from(from);
    [difference(to.x, from.x), difference(to.y, from.y), difference(to.z, from.z)]
}

fn dot([a, b, c]: V, [x, y, z]: V) -> f64 {
    a * x + b * y + c * z
}

fn cross([a, b, c]: V, [x, y, z]: V) -> V {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Where the segment from `corner` along `edge` is closest to the origin.
fn on_segment(corner: V, edge: V) -> V {
    let (along, length) = (-dot(corner, edge), dot(edge, edge));
    let s = if !(along > 0.0) {
        0.0
    } else if along < length {
        along / length
    } else {
        1.0
    };
    let ([x, y, z], [dx, dy, dz]) = (corner, edge);
    [x + dx * s, y + dy * s, z + dz * s]
}

/// From `point` to the closest point of the triangle, and the square of the distance.
pub(super) fn offset(triangle: &Triangle, point: Vec3) -> (V, f64) {
    let Triangle { a, b, c } = *triangle;
    // Corners and edges of two `f32` each; the point is the origin.
    let corners = [a, b, c].map(|corner| between(point, corner));
    let edges = [between(a, b), between(b, c), between(c, a)];
    let [p, q, r] = corners;
    let [pq, qr, rp] = edges;
    let normal = cross(pq, qr);
    let area = dot(normal, normal);
    // How much of the triangle lies across each edge from where the point projects to; negative beyond the edge.
    let weights = [dot(normal, cross(p, pq)), dot(normal, cross(q, qr)), dot(normal, cross(r, rp))];
    let [wr, wp, wq] = weights;

    // The signs of the weights are worth nothing for slivers: there, all edges are tried besides.
    let longest = dot(pq, pq) + dot(rp, rp);
    let trusted = area > longest * longest / 1_048_576.0;
    let mut best = (p, dot(p, p));
    let mut offer = |v: V| {
        let square = dot(v, v);
        if square < best.1 {
            best = (v, square);
        }
    };
    if wp >= 0.0 && wq >= 0.0 && wr >= 0.0 {
        let sum = wp + wq + wr;
        if sum > 0.0 {
            let (wp, wq, wr) = (wp / sum, wq / sum, wr / sum);
            let mean = |p: f64, q: f64, r: f64| p * wp + q * wq + r * wr;
            let ([px, py, pz], [qx, qy, qz], [rx, ry, rz]) = (p, q, r);
            offer([mean(px, qx, rx), mean(py, qy, ry), mean(pz, qz, rz)]);
        }
    }
    for ((corner, edge), weight) in corners.into_iter().zip(edges).zip(weights) {
        // The closest point of a convex shape is on an edge that faces the point.
        if weight < 0.0 || !trusted {
            offer(on_segment(corner, edge));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, cases};

    fn closest(corners: [[f32; 3]; 3], point: [f32; 3]) -> [f32; 3] {
        let [a, b, c] = corners.map(Vec3::from_array);
        Triangle::new(a, b, c).closest_point(point.into()).to_array()
    }

    #[test]
    fn faces_edges_and_corners_each_have_their_region() {
        let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        for (point, expected) in [
            ([1.0, 1.0, 5.0], [1.0, 1.0, 0.0]),
            ([1.0, 1.0, 0.0], [1.0, 1.0, 0.0]),
            ([1.0, -3.0, 2.0], [1.0, 0.0, 0.0]),
            ([3.0, 3.0, -1.0], [2.0, 2.0, 0.0]),
            ([-1.0, 2.0, 0.0], [0.0, 2.0, 0.0]),
            ([-1.0, -1.0, 3.0], [0.0, 0.0, 0.0]),
            ([9.0, 1.0, 0.0], [4.0, 0.0, 0.0]),
            ([0.0, 9.0, 1.0], [0.0, 4.0, 0.0]),
        ] {
            assert_eq!(closest(flat, point), expected, "{point:?}");
            let [a, b, c] = flat;
            assert_eq!(closest([c, a, b], point), expected, "{point:?}");
            assert_eq!(closest([c, b, a], point), expected, "{point:?}");
        }
    }

    #[test]
    fn triangles_without_area_are_segments_and_points() {
        let (a, b, c) = ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]);
        for corners in [[a, b, c], [b, c, a], [c, b, a], [a, a, c], [a, c, a], [c, a, a]] {
            assert_eq!(closest(corners, [2.0, 2.0, 2.0]), [2.0; 3]);
            assert_eq!(closest(corners, [9.0, 9.0, 9.0]), [3.0; 3]);
            assert_eq!(closest(corners, [-1.0, 0.0, 0.5]), [0.0; 3]);
        }
        assert_eq!(closest([b, b, b], [0.0, 5.0, 0.0]), b);
    }

    #[test]
    fn the_largest_and_least_coordinates_are_held() {
        for scale in [1.0, 2.0_f32.powi(125), 2.0_f32.powi(-140)] {
            let at = |v: [f32; 3]| v.map(|x| x * scale);
            let corners = [at([0.0, 0.0, 0.0]), at([2.0, 0.0, 0.0]), at([0.0, 2.0, 0.0])];
            assert_eq!(closest(corners, at([0.5, 0.5, -2.0])), at([0.5, 0.5, 0.0]));
            assert_eq!(closest(corners, at([2.0, 2.0, 1.0])), at([1.0, 1.0, 0.0]));
        }
    }

    /// The least distance to many points of the triangle.
    fn sampled(triangle: &Triangle, point: Vec3) -> f64 {
        const STEPS: i32 = 40;
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|corner| between(point, corner));
        let mut least = f64::INFINITY;
        for i in 0..=STEPS {
            for j in 0..=STEPS - i {
                let (v, w) = (f64::from(i) / f64::from(STEPS), f64::from(j) / f64::from(STEPS));
                let q = [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * v + (c[k] - a[k]) * w);
                least = least.min(dot(q, q).sqrt());
            }
        }
        least
    }

    #[test]
    fn no_sample_of_the_triangle_is_closer() {
        let mut random = Random::new(3);
        for round in 0..cases(4000) as usize {
            let thin = [1.0, 1.0e-3, 1.0e-5, 1.0e-7, 0.0][round % 5];
            let mut corner = || Vec3::new(random.unit(), random.unit() * thin, random.unit() * thin * 0.7);
            let triangle = Triangle::new(corner(), corner(), corner());
            let away = Vec3::new(random.unit(), random.unit(), random.unit()) * 2.0 - 1.0;
            let point = triangle.a + away * [1.0, 1.0e-2, 1.0e-5][random.below(3) as usize];
            let (v, square) = offset(&triangle, point);
            let (distance, sampled) = (square.sqrt(), sampled(&triangle, point));
            assert!(distance <= sampled + 1.0e-7, "{triangle:?} {point:?} {distance} {sampled}");
            let far = triangle.closest_point(point) - point;
            assert!(v.iter().zip(far.to_array()).all(|(x, y)| (x - f64::from(y)).abs() < 1.0e-6));
            // From there it is not far.
            let (_, again) = offset(&triangle, triangle.closest_point(point));
            assert!(again.sqrt() < 2.0e-7, "{triangle:?} {point:?} {again}");
        }
    }
}
