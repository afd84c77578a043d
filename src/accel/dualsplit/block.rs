use crate::geometry::{Aabb, Axis, Lattice};

/// One of the six sides of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Face {
    /// The axis across it.
    pub(super) axis: Axis,
    /// Whether it is the one of higher coordinates.
    pub(super) upper: bool,
}

/// A box on a lattice of 16 bits: per axis a word, its least plane in the lower half and its greatest in the upper.
///
/// The builder knows primitives as blocks only: all that it does once per primitive and level is done in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct Block([u32; 3]);

impl Block {
    /// Words per block.
    pub(super) const WORDS: usize = 3;

    /// The greatest number of a plane.
    pub(super) const LAST: u32 = 0xffff;

    /// The block of the whole lattice.
    pub(super) const WHOLE: Self = Self([Self::LAST << 16; 3]);

    /// The block that every union leaves as it is.
    pub(super) const EMPTY: Self = Self([Self::LAST; 3]);

    /// The least block around a box.
    pub(super) fn around(bounds: &Aabb, lattice: &Lattice) -> Self {
        Self(Axis::ALL.map(|axis| {
            let (min, max) = (axis.of(bounds.min), axis.of(bounds.max));
            lattice.below(axis, min) | lattice.above(axis, max) << 16
        }))
    }

    /// The number of the least plane along an axis.
    #[inline(always)]
    pub(super) const fn min(&self, axis: Axis) -> u32 {
        self.0[axis as usize] & Self::LAST
    }

    /// The number of the greatest plane along an axis.
    #[inline(always)]
    pub(super) const fn max(&self, axis: Axis) -> u32 {
        self.0[axis as usize] >> 16
    }

    /// How many steps it is long.
    #[inline(always)]
    pub(super) const fn length(&self, axis: Axis) -> u32 {
        self.max(axis).saturating_sub(self.min(axis))
    }

    /// Twice the middle along an axis.
    #[inline(always)]
    pub(super) const fn middle(&self, axis: Axis) -> u32 {
        self.min(axis) + self.max(axis)
    }

    /// The same between other planes along one axis.
    #[inline(always)]
    #[must_use]
    pub(super) const fn between(mut self, axis: Axis, min: u32, max: u32) -> Self {
        self.0[axis as usize] = min | max << 16;
        self
    }

    /// The plane of a face.
    #[inline(always)]
    pub(super) const fn plane(&self, face: Face) -> u32 {
        if face.upper { self.max(face.axis) } else { self.min(face.axis) }
    }

    /// The same up to a plane, or from it.
    #[inline(always)]
    #[must_use]
    pub(super) const fn cut(self, face: Face, plane: u32) -> Self {
        let (min, max) = (self.min(face.axis), self.max(face.axis));
        if face.upper { self.between(face.axis, min, plane) } else { self.between(face.axis, plane, max) }
    }

    /// The least block that contains both.
    #[inline(always)]
    #[must_use]
    pub(super) fn union(mut self, other: &Self) -> Self {
        for axis in Axis::ALL {
            self = self.between(axis, self.min(axis).min(other.min(axis)), self.max(axis).max(other.max(axis)));
        }
        self
    }
}
