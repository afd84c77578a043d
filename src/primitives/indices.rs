use glam::Vec3;

use super::{MeshError, Meshlets};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::in_range,
};

/// The corners of triangles: three vertex numbers each, in as few bits as they fit, or four of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indices<'a> {
    /// Numbers up to 65,535: 6 bytes a triangle.
    Narrow(&'a [[u16; 3]]),
    /// Numbers up to 2^32 - 1: 12 bytes a triangle.
    Wide(&'a [[u32; 3]]),
    /// Numbers that are counted from where each [`Meshlets::SIZE`] triangles begin: 3 bytes a triangle.
    Meshlets(Meshlets<'a>),
    /// Pairs of triangles that share an edge, `a b c` and `a c d`, by four numbers that are counted like those of meshlets: 2 bytes a
    /// triangle. What is numbered are the triangles; structures may refer to pairs, see [`QuadMesh`](super::QuadMesh).
    Quads(Meshlets<'a, 4>),
}

impl<'a> Indices<'a> {
    /// How many triangles there are.
    #[inline(always)]
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Narrow(list) => list.len(),
            Self::Wide(list) => list.len(),
            Self::Meshlets(meshlets) => meshlets.len(),
            Self::Quads(quads) => quads.len() * 2,
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
            Self::Meshlets(meshlets) => meshlets.get(triangle),
            Self::Quads(quads) => {
                let &first = quads.first().get(triangle as usize / (2 * Meshlets::<4>::SIZE))?;
                let &[a, b, c, d] = quads.corners().get(triangle as usize / 2)?;
                let [b, c] = if triangle & 1 == 0 { [b, c] } else { [c, d] };
                Some([a, b, c].map(|corner| first.wrapping_add(u32::from(corner))))
            }
        }
    }

    /// How many quads there are, if that is what triangles are stored in.
    #[inline(always)]
    pub(super) const fn quads(&self) -> Option<u32> {
        match self {
            Self::Quads(quads) => Some(quads.len() as u32),
            _ => None,
        }
    }

    /// The corners of a quad.
    #[inline(always)]
    pub(super) fn quad(&self, quad: u32) -> Option<[u32; 4]> {
        match self {
            Self::Quads(quads) => quads.get(quad),
            _ => None,
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

impl<'a> From<Meshlets<'a>> for Indices<'a> {
    fn from(meshlets: Meshlets<'a>) -> Self {
        Self::Meshlets(meshlets)
    }
}

impl<'a> From<Meshlets<'a, 4>> for Indices<'a> {
    fn from(quads: Meshlets<'a, 4>) -> Self {
        Self::Quads(quads)
    }
}

/// The section of indices, of whichever width.
impl<'a> Stored<'a> for Indices<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        if let Ok(words) = asset.section(Kind::Meshlets) {
            let error = AssetError::Shape { kind: Kind::Meshlets, words: words.len() };
            return Ok(Self::Meshlets(Meshlets::of_words(words).ok_or(error)?));
        }
        if let Ok(words) = asset.section(Kind::Quads) {
            let error = AssetError::Shape { kind: Kind::Quads, words: words.len() };
            return Ok(Self::Quads(Meshlets::of_words(words).ok_or(error)?));
        }
        if let Ok(words) = asset.section(Kind::NarrowIndices) {
            let error = AssetError::Shape { kind: Kind::NarrowIndices, words: words.len() };
            return Ok(Self::Narrow(narrow(words).ok_or(error)?));
        }
        let words = asset.section(Kind::WideIndices)?;
        let error = AssetError::Shape { kind: Kind::WideIndices, words: words.len() };
        Ok(Self::Wide(bytemuck::try_cast_slice(words).map_err(|_| error)?))
    }
}

/// A count and so many corners, an odd number of which is padded to a word.
fn narrow(words: &[u32]) -> Option<&[[u16; 3]]> {
    let (&count, words) = words.split_first()?;
    let halves: &[u16] = bytemuck::try_cast_slice(words).ok()?;
    let used = (count as usize).checked_mul(3).filter(|used| used.next_multiple_of(2) == halves.len())?;
    bytemuck::try_cast_slice(halves.get(..used)?).ok()
}
