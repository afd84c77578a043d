use super::{LatticeMesh, Primitives, Reordered};

/// Triangles on a lattice, as a [`LatticeScene`](crate::LatticeScene) needs them: a [`LatticeMesh`], or one reordered.
pub trait LatticeTriangles: Primitives {
    /// The triangles as they stand.
    fn mesh(&self) -> &LatticeMesh<'_>;

    /// The number that decides ties and that hits carry.
    fn number(&self, index: u32) -> u32;
}

impl LatticeTriangles for LatticeMesh<'_> {
    #[inline(always)]
    fn mesh(&self) -> &LatticeMesh<'_> {
        self
    }

    #[inline(always)]
    fn number(&self, index: u32) -> u32 {
        index
    }
}

/// The numbers are those of the triangles' owner.
impl<'a> LatticeTriangles for Reordered<'a, LatticeMesh<'a>> {
    #[inline(always)]
    fn mesh(&self) -> &LatticeMesh<'_> {
        self.inner()
    }

    #[inline(always)]
    fn number(&self, index: u32) -> u32 {
        Self::number(self, index).unwrap_or(index)
    }
}

impl<P: LatticeTriangles + ?Sized> LatticeTriangles for &P {
    #[inline(always)]
    fn mesh(&self) -> &LatticeMesh<'_> {
        (**self).mesh()
    }

    #[inline(always)]
    fn number(&self, index: u32) -> u32 {
        (**self).number(index)
    }
}
