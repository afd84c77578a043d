//! Volumes around points: three spheres and the least one, and boxes along the axes or turned.
//!
//! A volume around a whole object lets rays that miss it pass by at the price of one test:
//! [`Bounded`](crate::accel::Bounded). Each kind has its function ([`Sphere::welzl`], [`Obb::dito`], …); [`Bounding`]
//! names them all, for tables and for choices at run time.
//!
//! Builders go over the points several times, keep none of them, and take time in proportion to their number, whatever
//! they are. They calculate in `f64`, which is soft on chips: there, find a volume once and keep it.

mod dito;
mod fit;
mod pca;
mod ritter;
mod sphere;
mod welzl;
mod wide;

use glam::Vec3;

use super::{Aabb, Obb, PreparedRay, Sphere, Volume};

/// A kind of volume and how it is found.
///
/// ```
/// use hitscan::{geometry::{Bounding, Volume}, glam::Vec3};
/// let corners = [Vec3::ZERO, Vec3::ONE, Vec3::new(2.0, 2.0, 1.0), Vec3::new(1.0, 0.0, 0.5)];
/// for kind in Bounding::ALL {
///     let volume = kind.around(corners.iter().copied()).unwrap();
///     println!("{:24} {}", kind.name(), volume.volume());
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Bounding {
    /// [`Sphere::around_barycenter`].
    BarycenterSphere,
    /// [`Sphere::around_box_center`].
    BoxCenterSphere,
    /// [`Sphere::ritter`].
    RitterSphere,
    /// [`Sphere::welzl`].
    WelzlSphere,
    /// [`Aabb::around`].
    Aabb,
    /// [`Obb::pca`].
    PcaObb,
    /// [`Obb::dito`].
    DitoObb,
}

impl Bounding {
    /// All of them: spheres, then boxes, the simplest first.
    pub const ALL: [Self; 7] = [
        Self::BarycenterSphere,
        Self::BoxCenterSphere,
        Self::RitterSphere,
        Self::WelzlSphere,
        Self::Aabb,
        Self::PcaObb,
        Self::DitoObb,
    ];

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BarycenterSphere => "sphere, barycentre",
            Self::BoxCenterSphere => "sphere, centre of box",
            Self::RitterSphere => "sphere, Ritter",
            Self::WelzlSphere => "sphere, Welzl",
            Self::Aabb => "AABB",
            Self::PcaObb => "OBB, PCA",
            Self::DitoObb => "OBB, DiTO",
        }
    }

    /// The volume of this kind around `points`; `None` of none, or if a coordinate is not finite or exceeds
    /// [`MAX_COORDINATE`](super::MAX_COORDINATE).
    #[must_use]
    pub fn around(self, points: impl Iterator<Item = Vec3> + Clone) -> Option<BoundingVolume> {
        Some(match self {
            Self::BarycenterSphere => BoundingVolume::Sphere(Sphere::around_barycenter(points)?),
            Self::BoxCenterSphere => BoundingVolume::Sphere(Sphere::around_box_center(points)?),
            Self::RitterSphere => BoundingVolume::Sphere(Sphere::ritter(points)?),
            Self::WelzlSphere => BoundingVolume::Sphere(Sphere::welzl(points)?),
            Self::Aabb => BoundingVolume::Aabb(around(points)?),
            Self::PcaObb => BoundingVolume::Obb(Obb::pca(points)?),
            Self::DitoObb => BoundingVolume::Obb(Obb::dito(points)?),
        })
    }
}

/// The least box along the axes, of points in range only.
fn around(points: impl Iterator<Item = Vec3> + Clone) -> Option<Aabb> {
    // Comparisons pass over NaN.
    let in_range = points.clone().all(super::in_range);
    Some(Aabb::around(points)).filter(|aabb| in_range && aabb.is_valid())
}

/// A volume of one of the kinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundingVolume {
    /// A sphere.
    Sphere(Sphere),
    /// A box along the axes.
    Aabb(Aabb),
    /// A box along directions of its own.
    Obb(Obb),
}

impl Volume for BoundingVolume {
    #[inline]
    fn may_meet(&self, ray: &PreparedRay, t_max: f32) -> bool {
        match self {
            Self::Sphere(sphere) => sphere.may_meet(ray, t_max),
            Self::Aabb(aabb) => aabb.may_meet(ray, t_max),
            Self::Obb(obb) => obb.may_meet(ray, t_max),
        }
    }

    fn volume(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.volume(),
            Self::Aabb(aabb) => aabb.volume(),
            Self::Obb(obb) => obb.volume(),
        }
    }
}
