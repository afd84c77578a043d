use super::{Indices, MeshError, Sides};

/// What meshes have in common, wherever their vertices are: corners, and from where and by which rays they are seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faces<'a> {
    pub(super) indices: Indices<'a>,
    pub(super) sides: Sides,
    pub(super) masks: Option<&'a [u32]>,
}

impl<'a> Faces<'a> {
    /// Those of corners that were checked, seen from both sides by all rays.
    pub(super) const fn new(indices: Indices<'a>) -> Self {
        Self { indices, sides: Sides::Both, masks: None }
    }

    /// The same, each seen only by rays that share a bit with its mask.
    pub(super) fn with_masks(self, masks: &'a [u32]) -> Result<Self, MeshError> {
        if masks.len() == self.indices.len() {
            Ok(Self { masks: Some(masks), ..self })
        } else {
            Err(MeshError::Masks { masks: masks.len(), triangles: self.len() })
        }
    }

    #[inline(always)]
    pub(super) const fn len(&self) -> u32 {
        self.indices.len() as u32
    }

    #[inline(always)]
    pub(super) fn mask(&self, index: u32) -> u32 {
        match self.masks {
            None => u32::MAX,
            Some(masks) => masks.get(index as usize).copied().unwrap_or(0),
        }
    }
}
