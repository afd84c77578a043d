//! A mesh as an asset can hold it.

use engine::{
    Hit, Mesh, PreparedRay, Primitives, Ray, Span,
    asset::{Asset, Stored},
    error::Error,
    geometry::Aabb,
    glam::Vec3,
    primitives::{Probe, Proximity, Surface},
};
#[cfg(feature = "numbers")]
use engine::{asset::Kind, primitives::Reordered};

/// A mesh, whose triangles may stand in another order than their owner's.
#[derive(Clone, Copy)]
pub enum Triangles {
    /// In order.
    Plain(Mesh<'static>),
    /// With their owner's numbers.
    #[cfg(feature = "numbers")]
    Numbered(Reordered<'static, Mesh<'static>>),
}

/// What both kinds answer.
macro_rules! either {
    ($triangles:expr, $mesh:ident => $answer:expr) => {
        match $triangles {
            Triangles::Plain($mesh) => $answer,
            #[cfg(feature = "numbers")]
            Triangles::Numbered($mesh) => $answer,
        }
    };
}

impl Stored<'static> for Triangles {
    fn read(asset: &Asset<'static>) -> Result<Self, Error> {
        #[cfg(feature = "numbers")]
        if asset.sections().any(|section| section.kind == Kind::Numbers) {
            return asset.read::<Reordered<_>>().map(Self::Numbered);
        }
        asset.read().map(Self::Plain)
    }
}

impl Primitives for Triangles {
    #[inline(always)]
    fn len(&self) -> u32 {
        either!(self, mesh => mesh.len())
    }

    fn bounds(&self, index: u32) -> Aabb {
        either!(self, mesh => mesh.bounds(index))
    }

    #[inline]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        either!(self, mesh => mesh.intersect(index, ray, span))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        either!(self, mesh => mesh.surface(ray, hit))
    }

    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        either!(self, mesh => mesh.mask(index))
    }

    #[inline(always)]
    fn is_certified(&self, index: u32) -> bool {
        either!(self, mesh => mesh.is_certified(index))
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        either!(self, mesh => mesh.clip(index, cell))
    }
}

impl Proximity for Triangles {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        either!(self, mesh => mesh.closest_point(number, point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        either!(self, mesh => mesh.approach(index, probe))
    }
}
