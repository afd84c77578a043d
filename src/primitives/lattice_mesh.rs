use glam::Vec3;

use super::{
    Hit, Indices, MeshError, Primitives, Probe, Proximity, Quads, Sides, Span, Surface, faces::Faces, quad_mesh,
};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, Axis, Lattice, PreparedRay, Ray, Triangle, intersect_triangle},
};

/// Words before the vertices of a section: how many there are, and the frame.
const HEADER_WORDS: usize = 7;

/// Triangles over borrowed vertices on a lattice, 6 bytes each: half of a [`Mesh`](super::Mesh)'s.
///
/// A vertex is the three numbers of the planes that meet in it, of a [`Lattice`] over a *frame*, and stands for the `f32`
/// position that [`Lattice::position`] gives. The triangles are those over these positions, and everything that holds of a
/// mesh holds of them: vertices that are shared stay shared, so nothing leaks.
///
/// Structures take the frame as their bounds, so the planes of a [`DualSplit`](crate::DualSplit) tree are those of the
/// vertices. The last plane may lie a little outside the frame: vertices that use it make the bounds larger.
///
/// `bake::lattice` puts the vertices of a mesh on a lattice and says how far that moves them.
///
/// ```
/// use hitscan::{LatticeMesh, List, Ray, Scene, geometry::Aabb, glam::Vec3};
/// let frame = Aabb::new(Vec3::ZERO, Vec3::splat(65_535.0));
/// let vertices = [[0, 0, 0], [60_000, 0, 0], [0, 60_000, 0]];
/// let mesh = LatticeMesh::new(&frame, &vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::new(20.0, 20.0, -1.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.primitive), (1.0, 0));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LatticeMesh<'a> {
    frame: Aabb,
    lattice: Lattice,
    vertices: &'a [[u16; 3]],
    faces: Faces<'a>,
}

impl<'a> LatticeMesh<'a> {
    /// The number of the last plane along each axis.
    pub const LAST: u32 = 0xffff;

    /// The mesh of these triangles, hit from both sides, seen by all rays.
    ///
    /// # Errors
    ///
    /// [`MeshError::Frame`] if the box is not valid; otherwise it names the first triangle with a missing vertex, or one
    /// that lies beyond all coordinates.
    pub fn new(frame: &Aabb, vertices: &'a [[u16; 3]], indices: impl Into<Indices<'a>>) -> Result<Self, MeshError> {
        let indices = indices.into();
        if !frame.is_valid() {
            return Err(MeshError::Frame);
        }
        let lattice = Lattice::over(frame, [Self::LAST; 3]);
        indices.check(vertices.len(), |vertex| Some(decode(&lattice, vertices.get(vertex as usize)?)))?;
        Ok(Self { frame: *frame, lattice, vertices, faces: Faces::new(indices) })
    }

    /// The same mesh, hit from `sides` only.
    #[must_use]
    pub const fn with_sides(self, sides: Sides) -> Self {
        Self { faces: Faces { sides, ..self.faces }, ..self }
    }

    /// The same mesh, each triangle seen only by rays that share a bit with its mask.
    ///
    /// # Errors
    ///
    /// [`MeshError::Masks`] if there is not one mask per triangle.
    pub fn with_masks(self, masks: &'a [u32]) -> Result<Self, MeshError> {
        Ok(Self { faces: self.faces.with_masks(masks)?, ..self })
    }

    /// The box that the lattice is over.
    #[must_use]
    pub const fn frame(&self) -> &Aabb {
        &self.frame
    }

    /// The planes that the vertices' numbers name.
    #[must_use]
    pub const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The vertices, by the numbers of their planes.
    #[must_use]
    pub const fn vertices(&self) -> &'a [[u16; 3]] {
        self.vertices
    }

    /// Where the vertices are.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = Vec3> + use<'a> {
        let lattice = self.lattice;
        self.vertices.iter().map(move |vertex| decode(&lattice, vertex))
    }

    /// The corners of the triangles.
    #[must_use]
    pub const fn indices(&self) -> Indices<'a> {
        self.faces.indices
    }

    /// The sides from which the triangles can be hit.
    #[must_use]
    pub const fn sides(&self) -> Sides {
        self.faces.sides
    }

    /// The triangle of this number; one without area if there is none.
    #[must_use]
    pub fn triangle(&self, index: u32) -> Triangle {
        let [a, b, c] = self.corners(index).unwrap_or([&[0; 3]; 3]).map(|vertex| decode(&self.lattice, vertex));
        Triangle::new(a, b, c)
    }

    /// The vertices of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, index: u32) -> Option<[&'a [u16; 3]; 3]> {
        let [a, b, c] = self.faces.indices.get(index)?;
        let vertex = |number: u32| self.vertices.get(number as usize);
        Some([vertex(a)?, vertex(b)?, vertex(c)?])
    }
}

/// Where a vertex is.
fn decode(lattice: &Lattice, &[x, y, z]: &[u16; 3]) -> Vec3 {
    let along = |axis, number: u16| lattice.position(axis, u32::from(number));
    Vec3::new(along(Axis::X, x), along(Axis::Y, y), along(Axis::Z, z))
}

impl<'a> From<&LatticeMesh<'a>> for Indices<'a> {
    fn from(mesh: &LatticeMesh<'a>) -> Self {
        mesh.faces.indices
    }
}

impl Primitives for LatticeMesh<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.faces.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.triangle(index).bounds()
    }

    fn frame(&self) -> Option<Aabb> {
        Some(self.frame)
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let corners = self.corners(index)?.map(|vertex| (&self.lattice, vertex));
        let crossing = intersect_triangle(corners, ray, || (span.t_min(), span.t_max()))?;
        self.faces.sides.see(&crossing, span, index)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Surface::of_triangle(&self.triangle(hit.primitive), ray, hit)
    }

    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        self.faces.mask(index)
    }

    #[inline(always)]
    fn is_certified(&self, _index: u32) -> bool {
        true
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.triangle(index).clip(cell)
    }

    #[inline(always)]
    fn outline(&self, index: u32) -> Option<Triangle> {
        Some(self.triangle(index))
    }
}

impl Quads for LatticeMesh<'_> {
    #[inline(always)]
    fn quads(&self) -> Option<u32> {
        self.faces.indices.quads()
    }

    #[inline(always)]
    fn intersect_quad(&self, quad: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let [a, b, c, d] = self.faces.indices.quad(quad)?;
        let corner = |number: u32| Some((&self.lattice, self.vertices.get(number as usize)?));
        quad_mesh::intersect(self, [corner(a)?, corner(b)?, corner(c)?, corner(d)?], quad, ray, span)
    }
}

impl Proximity for LatticeMesh<'_> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        self.faces.indices.get(number)?;
        Some(self.triangle(number).closest_point(point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        self.faces.indices.get(index)?;
        probe.accept(self.triangle(index).distance(probe.point()), index)
    }
}

/// The sections of vertices on a lattice and of indices.
impl<'a> Stored<'a> for LatticeMesh<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::LatticeVertices)?;
        let error = AssetError::Shape { kind: Kind::LatticeVertices, words: words.len() };
        let (header, words) = words.split_first_chunk::<HEADER_WORDS>().ok_or(error)?;
        let &[count, x0, y0, z0, x1, y1, z1] = header;
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let frame = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        let halves: &[u16] = bytemuck::try_cast_slice(words).map_err(|_| error)?;
        let used = (count as usize).checked_mul(3).ok_or(error)?;
        // An odd number of them is padded to a word.
        if used.div_ceil(2) != words.len() {
            return Err(error.into());
        }
        let vertices = bytemuck::try_cast_slice(halves.get(..used).ok_or(error)?).map_err(|_| error)?;
        Ok(Self::new(&frame, vertices, asset.read::<Indices<'_>>()?)?)
    }
}
