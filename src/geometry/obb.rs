use glam::{Mat3, Vec3};

use super::in_range;

/// An oriented box: all points whose distance from the centre is, along each axis, at most half the size.
///
/// With the columns of `axes` read as real numbers these are the `p` with `|axis · (p - center)| <= half_size`, three
/// slabs; that the columns are orthonormal up to rounding makes it a box. Around points it is made by
/// [`dito`](Self::dito) or [`pca`](Self::pca).
///
/// ```
/// use hitscan::{geometry::{Obb, Volume}, glam::{Mat3, Vec3}};
/// let rod = Obb::new(Vec3::ZERO, Mat3::from_rotation_z(0.5), Vec3::new(4.0, 1.0, 1.0));
/// assert!(rod.is_valid() && rod.volume() == 32.0);
/// assert!(rod.contains(rod.axes.x_axis * 3.9) && !rod.contains(Vec3::X * 3.9));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obb {
    /// The middle.
    pub center: Vec3,
    /// The directions of the edges: orthonormal columns.
    pub axes: Mat3,
    /// Half the edge lengths.
    pub half_size: Vec3,
}

impl Obb {
    /// The box of this middle, these orthonormal columns and half edge lengths.
    #[inline]
    #[must_use]
    pub const fn new(center: Vec3, axes: Mat3, half_size: Vec3) -> Self {
        Self { center, axes, half_size }
    }

    /// Whether the columns are orthonormal to within 2^-20, no size is negative, all are finite, and the middle is
    /// within 2^127 of the origin along each axis.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let Mat3 { x_axis: x, y_axis: y, z_axis: z } = self.axes;
        let off = [x.dot(x) - 1.0, y.dot(y) - 1.0, z.dot(z) - 1.0, x.dot(y), y.dot(z), z.dot(x)];
        off.iter().all(|off| off.abs() <= 1.0 / 1_048_576.0)
            && in_range(self.center * 0.5)
            && self.half_size.is_finite()
            && self.half_size.cmpge(Vec3::ZERO).all()
    }

    /// Whether `point` lies inside or on the surface; decided in `f64`, to within its rounding.
    #[must_use]
    pub fn contains(&self, point: Vec3) -> bool {
        let away = |axis: Vec3| {
            let [x, y, z] =
                [(axis.x, point.x, self.center.x), (axis.y, point.y, self.center.y), (axis.z, point.z, self.center.z)]
                    .map(|(axis, p, c)| f64::from(axis) * (f64::from(p) - f64::from(c)));
            (x + y + z).abs()
        };
        let (axes, size) = (&self.axes, self.half_size);
        away(axes.x_axis) <= f64::from(size.x)
            && away(axes.y_axis) <= f64::from(size.y)
            && away(axes.z_axis) <= f64::from(size.z)
    }

    /// Half the surface area.
    #[inline]
    #[must_use]
    pub fn half_area(&self) -> f32 {
        let s = self.half_size * 2.0;
        s.x * s.y + s.y * s.z + s.z * s.x
    }
}
