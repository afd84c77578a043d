use super::MeshError;

/// The corners of triangles in 3 bytes each: vertices are counted from where each [`SIZE`](Self::SIZE) triangles begin. Or those of
/// quads in 4: see [`Indices::Quads`](super::Indices::Quads).
///
/// Made by `bake::meshlets` and `bake::quads` (feature `alloc`), which put vertices into the order in which triangles name them. After the
/// meshlets of mesh shaders, which have a list of vertices each; here that is a stretch of the mesh's, and neighbours may share
/// a part of theirs.
///
/// ```
/// use hitscan::{Mesh, glam::Vec3, primitives::Meshlets};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let meshlets = Meshlets::new(&[1], &[[0, 1, 2]])?;
/// assert_eq!(meshlets.get(0), Some([1, 2, 3]));
/// assert_eq!(Mesh::new(&vertices, meshlets)?.triangle(0).c, Vec3::Z);
/// # Ok::<(), hitscan::primitives::MeshError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meshlets<'a, const CORNERS: usize = 3> {
    first: &'a [u32],
    corners: &'a [[u8; CORNERS]],
}

impl<'a, const CORNERS: usize> Meshlets<'a, CORNERS> {
    /// How many triangles, or quads, count from the same vertex; so few that a byte can name all of their corners, whatever the mesh.
    pub const SIZE: usize = 64;

    /// Triangles whose corners are so many vertices behind the first one of their meshlet.
    ///
    /// # Errors
    ///
    /// [`MeshError::Meshlets`] if there is not one first vertex for each [`SIZE`](Self::SIZE) triangles.
    pub const fn new(first: &'a [u32], corners: &'a [[u8; CORNERS]]) -> Result<Self, MeshError> {
        if first.len() == corners.len().div_ceil(Self::SIZE) {
            Ok(Self { first, corners })
        } else {
            Err(MeshError::Meshlets { meshlets: first.len(), triangles: corners.len() })
        }
    }

    /// How many triangles there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The first vertex of each meshlet.
    #[must_use]
    pub const fn first(&self) -> &'a [u32] {
        self.first
    }

    /// How many vertices the corners of each triangle are behind that.
    #[must_use]
    pub const fn corners(&self) -> &'a [[u8; CORNERS]] {
        self.corners
    }

    /// The corners of a triangle.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, triangle: u32) -> Option<[u32; CORNERS]> {
        let first = *self.first.get(triangle as usize / Self::SIZE)?;
        Some(self.corners.get(triangle as usize)?.map(|corner| first.wrapping_add(u32::from(corner))))
    }

    /// Those of a section: a count, the first vertices, and bytes that are padded to a word.
    pub(super) fn of_words(words: &'a [u32]) -> Option<Self> {
        let (first, bytes) = parts(words, CORNERS)?;
        Some(Self { first, corners: bytes.as_chunks().0 })
    }
}

/// The first vertices in a section and so many bytes for each of what it counts; once for all numbers of corners.
#[inline(never)]
fn parts(words: &[u32], corners: usize) -> Option<(&[u32], &[u8])> {
    let (&count, words) = words.split_first()?;
    let (first, words) = words.split_at_checked((count as usize).div_ceil(<Meshlets>::SIZE))?;
    let used = (count as usize).checked_mul(corners).filter(|used| used.div_ceil(4) == words.len())?;
    let bytes: &[u8] = bytemuck::try_cast_slice(words).ok()?;
    Some((first, bytes.get(..used)?))
}
