use super::{LatticeMesh, Mesh, Primitives, Sides, Smooth};
use crate::geometry::Triangle;

/// Primitives that are triangles: a [`Mesh`], a [`Smooth`] one, a [`LatticeMesh`], a [`Soup`](super::Soup).
///
/// What [`Primitives::intersect`] returns must be what [`Triangle::intersect`] finds for the triangle of that index, on the
/// sides that can be hit, and carry the index as its number; and all must be [certified](Primitives::is_certified). Structures that
/// keep triangles of their own answer by these.
pub trait Triangles: Primitives {
    /// The triangle of this index; one without area if there is none.
    fn triangle(&self, index: u32) -> Triangle;

    /// The sides from which the triangles can be hit.
    fn sides(&self) -> Sides {
        Sides::Both
    }
}

impl Triangles for Mesh<'_> {
    #[inline]
    fn triangle(&self, index: u32) -> Triangle {
        Self::triangle(self, index)
    }

    fn sides(&self) -> Sides {
        Self::sides(self)
    }
}

impl Triangles for Smooth<'_> {
    fn triangle(&self, index: u32) -> Triangle {
        self.mesh().triangle(index)
    }

    fn sides(&self) -> Sides {
        self.mesh().sides()
    }
}

impl Triangles for LatticeMesh<'_> {
    fn triangle(&self, index: u32) -> Triangle {
        Self::triangle(self, index)
    }

    fn sides(&self) -> Sides {
        Self::sides(self)
    }
}

impl<P: Triangles + ?Sized> Triangles for &P {
    fn triangle(&self, index: u32) -> Triangle {
        (**self).triangle(index)
    }

    fn sides(&self) -> Sides {
        (**self).sides()
    }
}
