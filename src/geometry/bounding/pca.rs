use glam::Vec3;

use super::{
    fit::{Frame, UPRIGHT, fitted, frame},
    wide::{add, mean, scale, sub, wide},
};
use crate::{
    geometry::{Axis, Obb},
    math,
};

/// Sweeps of Jacobi's method; it converges quadratically, in four or five.
const SWEEPS: u32 = 12;

/// A symmetric matrix by its rows.
type Symmetric = [[f64; 3]; 3];

/// Turns the plane of two axes until their covariance is nothing.
fn rotate(matrix: &mut Symmetric, vectors: &mut Frame, first: Axis) {
    let (p, q, r) = (first as usize, first.next() as usize, first.next().next() as usize);
    let off = matrix[p][q];
    if off == 0.0 {
        return;
    }
    // The tangent of the lesser angle.
    let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
    let t = 1.0 / (theta.abs() + math::sqrt64(theta * theta + 1.0));
    let t = if theta < 0.0 { -t } else { t };
    let c = 1.0 / math::sqrt64(t * t + 1.0);
    let s = t * c;
    matrix[p][p] -= t * off;
    matrix[q][q] += t * off;
    (matrix[p][q], matrix[q][p]) = (0.0, 0.0);
    let (a, b) = (matrix[r][p], matrix[r][q]);
    (matrix[r][p], matrix[r][q]) = (c * a - s * b, s * a + c * b);
    (matrix[p][r], matrix[q][r]) = (matrix[r][p], matrix[r][q]);
    let (v, w) = (vectors[p], vectors[q]);
    (vectors[p], vectors[q]) = (sub(scale(v, c), scale(w, s)), add(scale(v, s), scale(w, c)));
}

/// The eigenvectors of a symmetric matrix. Jacobi, *Über ein leichtes Verfahren …*, 1846, in cyclic order.
fn eigenvectors(mut matrix: Symmetric) -> Frame {
    let mut vectors = UPRIGHT;
    for _ in 0..SWEEPS {
        Axis::ALL.into_iter().for_each(|axis| rotate(&mut matrix, &mut vectors, axis));
    }
    let [x, y, _] = vectors;
    frame(x, y)
}

impl Obb {
    /// The box along the principal axes of the points, the eigenvectors of their covariance: four passes.
    ///
    /// As the lecture does it. Where points are dense, the axes are drawn to them. All points are contained, as real
    /// numbers; `None` of no points, or if a coordinate is not finite or exceeds
    /// [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
    #[must_use]
    pub fn pca(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let center = mean(points.clone())?;
        let mut covariance: Symmetric = [[0.0; 3]; 3];
        for point in points.clone() {
            let away = sub(wide(point), center);
            for (row, coordinate) in covariance.iter_mut().zip(away) {
                *row = add(*row, scale(away, coordinate));
            }
        }
        fitted(eigenvectors(covariance), points)
    }
}
