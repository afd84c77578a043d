use glam::Vec3;

use super::MeshError;
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::in_range,
};

/// The corners of triangles: three vertex numbers each, in 16 bits where they fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indices<'a> {
    /// Numbers up to 65,535: 6 bytes a triangle.
    Narrow(&'a [[u16; 3]]),
    /// Numbers up to 2^32 - 1: 12 bytes a triangle.
    Wide(&'a [[u32; 3]]),
}

impl<'a> Indices<'a> {
    /// How many triangles there are.
    #[inline(always)]
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Narrow(list) => list.len(),
            Self::Wide(list) => list.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The corners of a triangle.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, triangle: u32) -> Option<[u32; 3]> {
        match self {
            Self::Narrow(list) => list.get(triangle as usize).map(|corners| corners.map(u32::from)),
            Self::Wide(list) => list.get(triangle as usize).copied(),
        }
    }

    /// Checks that all corners name vertices, of which `position` knows where they are, within the range of coordinates.
    pub(super) fn check(&self, vertices: usize, position: impl Fn(u32) -> Option<Vec3>) -> Result<(), MeshError> {
        let count = u32::try_from(self.len()).ok().filter(|&n| n < u32::MAX).ok_or(MeshError::TooMany)?;
        for triangle in 0..count {
            for vertex in self.get(triangle).into_iter().flatten() {
                let vertices = vertices as u32;
                let position = position(vertex).ok_or(MeshError::Index { triangle, vertex, vertices })?;
                if !in_range(position) {
                    return Err(MeshError::Vertex { triangle, vertex });
                }
            }
        }
        Ok(())
    }
}

impl<'a> From<&'a [[u16; 3]]> for Indices<'a> {
    fn from(list: &'a [[u16; 3]]) -> Self {
        Self::Narrow(list)
    }
}

impl<'a> From<&'a [[u32; 3]]> for Indices<'a> {
    fn from(list: &'a [[u32; 3]]) -> Self {
        Self::Wide(list)
    }
}

impl<'a, const N: usize> From<&'a [[u16; 3]; N]> for Indices<'a> {
    fn from(list: &'a [[u16; 3]; N]) -> Self {
        Self::Narrow(list)
    }
}

impl<'a, const N: usize> From<&'a [[u32; 3]; N]> for Indices<'a> {
    fn from(list: &'a [[u32; 3]; N]) -> Self {
        Self::Wide(list)
    }
}

/// The section of indices, of either width.
impl<'a> Stored<'a> for Indices<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        match asset.section(Kind::NarrowIndices) {
            Ok(words) => {
                let error = AssetError::Shape { kind: Kind::NarrowIndices, words: words.len() };
                let (&count, words) = words.split_first().ok_or(error)?;
                let halves: &[u16] = bytemuck::try_cast_slice(words).map_err(|_| error)?;
                let used = (count as usize).checked_mul(3).ok_or(error)?;
                if used.next_multiple_of(2) != halves.len() {
                    return Err(error.into());
                }
                let halves = halves.get(..used).ok_or(error)?;
                Ok(Self::Narrow(bytemuck::try_cast_slice(halves).map_err(|_| error)?))
            }
            Err(_) => {
                let words = asset.section(Kind::WideIndices)?;
                let error = AssetError::Shape { kind: Kind::WideIndices, words: words.len() };
                Ok(Self::Wide(bytemuck::try_cast_slice(words).map_err(|_| error)?))
            }
        }
    }
}
