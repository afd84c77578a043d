use alloc::{collections::BTreeMap, vec::Vec};

use crate::primitives::{Indices, Meshlets};

/// Corners in 3 bytes a triangle, or in 4 a quad, and the order of vertices which that takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InMeshlets<const CORNERS: usize = 3> {
    /// Which of the old vertices stands at each place; some stand at several.
    pub order: Vec<u32>,
    first: Vec<u32>,
    corners: Vec<[u8; CORNERS]>,
}

impl<const CORNERS: usize> InMeshlets<CORNERS> {
    /// The corners, for meshes over [`vertices`](Self::vertices).
    #[must_use]
    pub fn indices<'a>(&'a self) -> Indices<'a>
    where
        Indices<'a>: From<Meshlets<'a, CORNERS>>,
    {
        Meshlets::new(&self.first, &self.corners).map_or(Indices::Narrow(&[]), Indices::from)
    }

    /// Those of polygons in this order.
    pub(super) fn of(polygons: &[[u32; CORNERS]]) -> Self {
        let mut made = Self { order: Vec::new(), first: Vec::new(), corners: Vec::new() };
        let mut last = BTreeMap::new();
        for polygons in polygons.chunks(<Meshlets>::SIZE) {
            made.push(polygons, &mut last);
        }
        made
    }

    /// What there is of each vertex, positions or normals, in the new order.
    #[must_use]
    pub fn vertices<T: Copy>(&self, old: &[T]) -> Vec<T> {
        self.order.iter().filter_map(|&vertex| old.get(vertex as usize).copied()).collect()
    }

    /// Puts the corners of a meshlet behind those before it; `last` are the last places of the vertices.
    fn push(&mut self, polygons: &[[u32; CORNERS]], last: &mut BTreeMap<u32, usize>) {
        let mut vertices: Vec<u32> = polygons.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let mut places: Vec<usize> = vertices.iter().filter_map(|vertex| last.get(vertex).copied()).collect();
        places.sort_unstable_by(|a, b| b.cmp(a));
        // As many of these are kept as can be, if the other vertices stand behind all, be it once more.
        let first_of = |kept: usize| (self.order.len() + vertices.len() - kept).saturating_sub(REACH);
        let kept = places.iter().enumerate().rev().find(|&(kept, &place)| place >= first_of(kept + 1));
        let first = first_of(kept.map_or(0, |(last, _)| last + 1));
        let order = &mut self.order;
        let mut corner = |vertex: u32| {
            let mut place = last.get(&vertex).copied().filter(|&place| place >= first);
            let place = *place.get_or_insert_with(|| {
                order.push(vertex);
                order.len() - 1
            });
            last.insert(vertex, place);
            (place - first) as u8
        };
        self.corners.extend(polygons.iter().map(|corners| corners.map(&mut corner)));
        self.first.push(first as u32);
    }
}

/// How many vertices a byte can name.
const REACH: usize = 1 << 8;

/// Puts vertices into the order in which triangles name them, so that three bytes are enough for a triangle's corners.
///
/// A vertex stands there several times if triangles name it that are far apart. That changes no answer and costs about a sixth of
/// the vertices at most where triangles that follow one another are neighbours, as they are in the order of the leaves of a
/// [`Bvh`](crate::Bvh). Where they are not, other indices take fewer bytes.
///
/// ```
/// use hitscan::{Mesh, bake, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[3_u16, 1, 2], [0, 3, 2]])?;
/// let meshlets = bake::meshlets(&mesh);
/// let vertices = meshlets.vertices(&vertices);
/// let smaller = Mesh::new(&vertices, meshlets.indices())?;
/// assert_eq!(smaller.triangle(1), mesh.triangle(1));
/// # Ok::<(), hitscan::primitives::MeshError>(())
/// ```
#[must_use]
pub fn meshlets<'a>(indices: impl Into<Indices<'a>>) -> InMeshlets {
    let indices = indices.into();
    let triangles: Vec<[u32; 3]> = (0..indices.len() as u32).filter_map(|triangle| indices.get(triangle)).collect();
    InMeshlets::of(&triangles)
}
