//! Boxes around what is where: for a hierarchy just linked, and for primitives that moved.

use super::{
    Bvh,
    node::{Pair, Planes},
    open::{Header, references},
};
use crate::{
    accel::{Leaf, Malformed, Reason, leaf::References},
    asset::Kind,
    error::{BuildError, Error},
    geometry::{Aabb, Lattice},
    primitives::{Primitives, bounds_of},
};

/// Makes all boxes anew, from the last pair to the first: children come after their parents.
///
/// A parent's box is the union of its children's on the lattice, which is that of its primitives: rounding outward and
/// union change places.
pub(super) fn fit<P: Primitives + ?Sized>(
    pairs: &mut [Pair],
    references: References<'_>,
    primitives: &P,
    lattice: &Lattice,
) {
    for index in (0..pairs.len()).rev() {
        let Some(mut pair) = pairs.get(index).copied() else { continue };
        for node in &mut pair {
            node.planes = if node.link.is_leaf() {
                let leaf = Leaf::of(references, node.link.number(), node.link.count());
                let bounds = leaf.fold(Aabb::EMPTY, |bounds, number| bounds.union(&primitives.bounds(number)));
                Planes::around(&bounds, lattice)
            } else {
                let Some([left, right]) = pairs.get(node.link.number() as usize) else { continue };
                left.planes.union(right.planes)
            };
        }
        if let Some(place) = pairs.get_mut(index) {
            *place = pair;
        }
    }
}

impl<'a> Bvh<'a> {
    /// Fits the hierarchy in `words` to `primitives` that have moved: the same order, new boxes, in one pass.
    ///
    /// It answers exactly, wherever they are now; how much work that is depends on whether neighbours have stayed
    /// neighbours. An ordered hierarchy expects them in its order.
    ///
    /// ```
    /// use hitscan::{Arena, Bvh, Mesh, Ray, Scene, bvh::Options, glam::Vec3};
    /// let mut vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = [[0_u16, 1, 2], [1, 2, 3]];
    /// let mut memory = vec![0; Bvh::words(2, &Options::fast())];
    /// let mesh = Mesh::new(&vertices, &triangles)?;
    /// let length = Bvh::build(&mesh, &mut Arena::new(&mut memory), &Options::fast())?.as_words().len();
    ///
    /// vertices[3] = Vec3::new(1.0, 1.0, 9.0);
    /// let mesh = Mesh::new(&vertices, &triangles)?;
    /// let scene = Scene::new(Bvh::refit(&mut memory[..length], &mesh)?, &mesh)?;
    /// assert!(scene.any_hit(&Ray::new(Vec3::new(0.0, 0.9, 5.0), Vec3::X)));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`BuildError::Bounds`] names the first primitive whose bounds are not valid; [`Malformed`] if the words are no
    /// hierarchy over so many primitives. The words are then as they were.
    pub fn refit<P: Primitives + ?Sized>(words: &'a mut [u32], primitives: &P) -> Result<Self, Error> {
        let old = Bvh::open(words)?;
        if old.primitives != primitives.len() {
            return Err(Malformed { structure: Kind::Bvh, word: 1, reason: Reason::Header }.into());
        }
        let pairs = old.pairs.len();
        let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
        if let Some((header, pairs, list)) = parts(words, pairs) {
            let lattice = Bvh::lattice(&bounds);
            fit(pairs, references(list, primitives.len() as usize), primitives, &lattice);
            if let Some(old) = Header::from_words(header) {
                super::build::copy(header, &Header { bounds, ..old }.to_words());
            }
        }
        Ok(Self::view(words).unwrap_or_else(Self::nothing))
    }
}

/// Header, pairs and list.
fn parts(words: &mut [u32], pairs: usize) -> Option<(&mut [u32], &mut [Pair], &[u32])> {
    let (header, rest) = words.split_at_mut_checked(super::HEADER_WORDS)?;
    let (pairs, list) = rest.split_at_mut_checked(pairs * super::node::PAIR_WORDS)?;
    Some((header, bytemuck::try_cast_slice_mut(pairs).ok()?, list))
}
