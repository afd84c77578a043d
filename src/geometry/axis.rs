use glam::Vec3;

/// A coordinate axis.
///
/// Indexing a `[T; 3]` by `axis as usize` needs no bounds check: the compiler knows the range.
///
/// ```
/// use hitscan::{geometry::Axis, glam::Vec3};
/// let v = Vec3::new(1.0, -5.0, 2.0);
/// assert_eq!(Axis::of_largest(v), Axis::Y);
/// assert_eq!(Axis::Y.of(v), -5.0);
/// assert_eq!(Axis::Z.next(), Axis::X);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Axis {
    /// The first coordinate.
    X = 0,
    /// The second coordinate.
    Y = 1,
    /// The third coordinate.
    Z = 2,
}

impl Axis {
    /// The three axes in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The axis after this one, cyclically.
    #[inline(always)]
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::Z,
            Self::Z => Self::X,
        }
    }

    /// The first axis along which `v` is largest in magnitude.
    #[inline]
    #[must_use]
    pub fn of_largest(v: Vec3) -> Self {
        let (x, y, z) = (v.x.abs(), v.y.abs(), v.z.abs());
        if y > x {
            if z > y { Self::Z } else { Self::Y }
        } else if z > x {
            Self::Z
        } else {
            Self::X
        }
    }

    /// The coordinate of `v` along this axis.
    #[inline(always)]
    #[must_use]
    pub fn of(self, v: Vec3) -> f32 {
        // Cannot fail; written so that no panic is linked in where the compiler loses sight of the range.
        v.to_array().get(self as usize).copied().unwrap_or(0.0)
    }
}
