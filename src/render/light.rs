use glam::Vec3;

use crate::geometry::Ray;

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// From a point, as bright at any distance.
    Point {
        /// Where it is.
        position: Vec3,
        /// Linear red, green, blue.
        color: Vec3,
    },
    /// From infinitely far.
    Directional {
        /// The direction in which the light travels.
        direction: Vec3,
        /// Linear red, green, blue.
        color: Vec3,
    },
}

impl Light {
    /// A light at a point.
    #[must_use]
    pub const fn point(position: Vec3, color: Vec3) -> Self {
        Self::Point { position, color }
    }

    /// A sun that shines along `direction`.
    #[must_use]
    pub const fn directional(direction: Vec3, color: Vec3) -> Self {
        Self::Directional { direction, color }
    }

    /// Its colour.
    #[must_use]
    pub const fn color(&self) -> Vec3 {
        match self {
            Self::Point { color, .. } | Self::Directional { color, .. } => *color,
        }
    }

    /// From `point` towards it, of any length.
    #[must_use]
    pub fn direction_from(&self, point: Vec3) -> Vec3 {
        match self {
            Self::Point { position, .. } => *position - point,
            Self::Directional { direction, .. } => -*direction,
        }
    }

    /// The ray from `point` on which nothing may lie if it is to be lit.
    #[must_use]
    pub fn shadow_ray(&self, point: Vec3) -> Ray {
        match self {
            Self::Point { position, .. } => Ray::between(point, *position),
            Self::Directional { direction, .. } => Ray::new(point, -*direction),
        }
    }
}
