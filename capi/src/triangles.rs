//! A mesh as an asset can hold it.

#[cfg(feature = "lattice")]
use engine::LatticeMesh;
#[cfg(feature = "quads")]
use engine::primitives::QuadMesh;
#[cfg(feature = "numbers")]
use engine::primitives::Reordered;
use engine::{
    Hit, Mesh, PreparedRay, Primitives, Ray, Span,
    asset::{Asset, Kind},
    geometry::Aabb,
    glam::Vec3,
    primitives::{Probe, Proximity, Surface},
};

use crate::status::Status;

/// A mesh, perhaps on a lattice, whose triangles may stand in another order than their owner's, or in pairs.
#[derive(Clone, Copy)]
pub enum Triangles {
    /// In order.
    Plain(Mesh<'static>),
    /// With their owner's numbers.
    #[cfg(feature = "numbers")]
    Numbered(Reordered<'static, Mesh<'static>>),
    /// With vertices on a lattice.
    #[cfg(feature = "lattice")]
    Lattice(LatticeMesh<'static>),
    /// Both.
    #[cfg(all(feature = "numbers", feature = "lattice"))]
    NumberedLattice(Reordered<'static, LatticeMesh<'static>>),
    /// In pairs.
    #[cfg(feature = "quads")]
    Pairs(QuadMesh<Mesh<'static>>),
    /// In pairs, with vertices on a lattice.
    #[cfg(all(feature = "quads", feature = "lattice"))]
    LatticePairs(QuadMesh<LatticeMesh<'static>>),
}

/// What each kind answers.
macro_rules! either {
    ($triangles:expr, $mesh:ident => $answer:expr) => {
        match $triangles {
            Triangles::Plain($mesh) => $answer,
            #[cfg(feature = "numbers")]
            Triangles::Numbered($mesh) => $answer,
            #[cfg(feature = "lattice")]
            Triangles::Lattice($mesh) => $answer,
            #[cfg(all(feature = "numbers", feature = "lattice"))]
            Triangles::NumberedLattice($mesh) => $answer,
            #[cfg(feature = "quads")]
            Triangles::Pairs($mesh) => $answer,
            #[cfg(all(feature = "quads", feature = "lattice"))]
            Triangles::LatticePairs($mesh) => $answer,
        }
    };
}

impl Triangles {
    /// The triangles of an asset.
    pub fn stored(asset: &Asset<'static>) -> Result<Self, Status> {
        let numbered = has(asset, Kind::Numbers);
        let (on_lattice, in_pairs) = (has(asset, Kind::LatticeVertices), has(asset, Kind::Quads));
        Ok(match (numbered, on_lattice, in_pairs) {
            (false, false, false) => Self::Plain(asset.read()?),
            #[cfg(feature = "numbers")]
            (true, false, false) => Self::Numbered(asset.read()?),
            #[cfg(feature = "lattice")]
            (false, true, false) => Self::Lattice(asset.read()?),
            #[cfg(all(feature = "numbers", feature = "lattice"))]
            (true, true, false) => Self::NumberedLattice(asset.read()?),
            #[cfg(feature = "quads")]
            (false, false, true) => Self::Pairs(asset.read()?),
            #[cfg(all(feature = "quads", feature = "lattice"))]
            (false, true, true) => Self::LatticePairs(asset.read()?),
            _ => return Err(Status::LeftOut),
        })
    }
}

fn has(asset: &Asset<'_>, kind: Kind) -> bool {
    asset.sections().any(|section| section.kind == kind)
}

impl Primitives for Triangles {
    #[inline(always)]
    fn len(&self) -> u32 {
        either!(self, mesh => mesh.len())
    }

    fn numbers(&self) -> u32 {
        either!(self, mesh => mesh.numbers())
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
