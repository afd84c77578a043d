use super::LatticeRay;

/// What a walk in whole numbers follows: a ray, or all rays of a tile.
///
/// Depths are counted in whole planes of the major axis, in the order in which they are passed.
pub trait LatticePath {
    /// Depths between which something may be hit.
    fn inside(&self) -> (u16, u16);

    /// A bit per axis along which higher numbers are met first, repeated every four bits.
    fn descending(&self) -> u32;

    /// Nothing that is behind a plane across an axis is hit before this depth.
    fn entry(&self, axis: u32, plane: u32) -> Option<i32>;

    /// Nothing that is before the plane is hit after this one.
    fn exit(&self, axis: u32, plane: u32) -> Option<i32>;
}

impl LatticePath for LatticeRay {
    #[inline(always)]
    fn inside(&self) -> (u16, u16) {
        self.inside
    }

    #[inline(always)]
    fn descending(&self) -> u32 {
        self.descending
    }

    #[inline(always)]
    fn entry(&self, axis: u32, plane: u32) -> Option<i32> {
        Some(self.views.get(axis as usize)?.entry(plane))
    }

    #[inline(always)]
    fn exit(&self, axis: u32, plane: u32) -> Option<i32> {
        Some(self.views.get(axis as usize)?.exit(plane))
    }
}
