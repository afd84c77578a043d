use core::fmt;

use glam::Vec3;

use super::{Hit, Indices, Primitives, Probe, Proximity, Quads, Span, Surface, faces::Faces, quad_mesh};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, Crossing, PreparedRay, Ray, Triangle, intersect_triangle},
};

/// The sides from which triangles can be hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Sides {
    /// Both.
    #[default]
    Both,
    /// The front only, where the corners run counter-clockwise.
    Front,
}

impl Sides {
    /// The hit where a ray crosses the triangle of this number, if it is seen from there and wanted.
    #[inline(always)]
    pub(super) fn see(self, crossing: &Crossing, span: &Span, number: u32) -> Option<Hit> {
        if self == Self::Front && !crossing.front { None } else { span.accept(crossing.t, number) }
    }
}

/// Why a mesh was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MeshError {
    /// A corner names a vertex that does not exist.
    Index {
        /// The triangle.
        triangle: u32,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: u32,
    },
    /// A coordinate is not finite or exceeds [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
    Vertex {
        /// The triangle that uses the vertex.
        triangle: u32,
        /// The vertex's number among all; of a [`Soup`](super::Soup), which has none, the triangle's corner: 0, 1 or 2.
        vertex: u32,
    },
    /// More than 2^32 - 2 triangles.
    TooMany,
    /// The box of a lattice is empty, not finite or beyond [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
    Frame,
    /// Not one mask per triangle.
    Masks {
        /// How many masks were given.
        masks: usize,
        /// How many triangles there are.
        triangles: u32,
    },
    /// Not one first vertex for each [`Meshlets::SIZE`](super::Meshlets::SIZE) triangles.
    Meshlets {
        /// How many first vertices were given.
        meshlets: usize,
        /// How many triangles there are.
        triangles: usize,
    },
    /// The triangles do not stand in pairs that share an edge: see [`Indices::Quads`](super::Indices::Quads).
    Quads,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { triangle, vertex, vertices } => {
                write!(f, "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices")
            }
            Self::Vertex { triangle, vertex } => {
                write!(f, "vertex {vertex} of triangle {triangle} is not finite or beyond 2^126")
            }
            Self::Frame => write!(f, "the box of the lattice is empty, not finite or beyond 2^126"),
            Self::TooMany => write!(f, "a mesh holds at most 2^32 - 2 triangles"),
            Self::Masks { masks, triangles } => write!(f, "{masks} masks were given for {triangles} triangles"),
            Self::Quads => write!(f, "the triangles do not stand in pairs that share an edge"),
            Self::Meshlets { meshlets, triangles } => {
                write!(f, "{meshlets} first vertices were given for {triangles} triangles, not one for each 64")
            }
        }
    }
}

impl core::error::Error for MeshError {}

/// Triangles over borrowed vertices: a view of some words, whatever the mesh.
///
/// Checked once when made: every index names a vertex and every vertex used is finite. Triangles without area are
/// allowed and never hit.
///
/// ```
/// use hitscan::{Mesh, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// assert!(Mesh::new(&vertices, &[[0_u16, 1, 3]]).is_err());
/// # Ok::<(), hitscan::primitives::MeshError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    vertices: &'a [Vec3],
    faces: Faces<'a>,
}

impl<'a> Mesh<'a> {
    /// The mesh of these triangles, hit from both sides, seen by all rays.
    ///
    /// # Errors
    ///
    /// [`MeshError`] names the first triangle with a missing or non-finite vertex.
    pub fn new(vertices: &'a [Vec3], indices: impl Into<Indices<'a>>) -> Result<Self, MeshError> {
        let indices = indices.into();
        indices.check(vertices.len(), |vertex| vertices.get(vertex as usize).copied())?;
        Ok(Self { vertices, faces: Faces::new(indices) })
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

    /// The vertices.
    #[must_use]
    pub const fn vertices(&self) -> &'a [Vec3] {
        self.vertices
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
    #[inline(always)]
    #[must_use]
    pub fn triangle(&self, index: u32) -> Triangle {
        // Cannot fail for a valid index, see `new`; written so that no panic is linked in.
        let corner = |vertex: u32| self.vertices.get(vertex as usize).copied().unwrap_or(Vec3::ZERO);
        let [a, b, c] = self.faces.indices.get(index).unwrap_or_default();
        Triangle::new(corner(a), corner(b), corner(c))
    }
}

impl Mesh<'_> {
    /// [`triangle`](Self::triangle) out of line, where it is a small part of the work: four kinds of indices are many instructions.
    #[inline(never)]
    fn aside(&self, index: u32) -> Triangle {
        self.triangle(index)
    }
}

impl<'a> From<&Mesh<'a>> for Indices<'a> {
    fn from(mesh: &Mesh<'a>) -> Self {
        mesh.faces.indices
    }
}

impl Primitives for Mesh<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.faces.len()
    }

    #[inline(always)]
    fn bounds(&self, index: u32) -> Aabb {
        self.triangle(index).bounds()
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let [a, b, c] = self.faces.indices.get(index)?;
        let corner = |vertex: u32| self.vertices.get(vertex as usize).map(AsRef::<[f32; 3]>::as_ref);
        let limits = || (span.t_min(), span.t_max());
        let crossing = intersect_triangle([corner(a)?, corner(b)?, corner(c)?], ray, limits)?;
        self.faces.sides.see(&crossing, span, index)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Surface::of_triangle(&self.aside(hit.primitive), ray, hit)
    }

    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        self.faces.mask(index)
    }

    #[inline(always)]
    fn is_certified(&self, _index: u32) -> bool {
        true
    }

    #[inline(always)]
    fn outline(&self, index: u32) -> Option<Triangle> {
        Some(self.triangle(index))
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.aside(index).clip(cell)
    }
}

impl Quads for Mesh<'_> {
    #[inline(always)]
    fn quads(&self) -> Option<u32> {
        self.faces.indices.quads()
    }

    #[inline(always)]
    fn intersect_quad(&self, quad: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let [a, b, c, d] = self.faces.indices.quad(quad)?;
        let corner = |vertex: u32| self.vertices.get(vertex as usize).map(AsRef::<[f32; 3]>::as_ref);
        quad_mesh::intersect(self, [corner(a)?, corner(b)?, corner(c)?, corner(d)?], quad, ray, span)
    }
}

impl Proximity for Mesh<'_> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        self.faces.indices.get(number)?;
        Some(self.aside(number).closest_point(point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        self.faces.indices.get(index)?;
        probe.accept(self.aside(index).distance(probe.point()), index)
    }
}

/// The sections of vertices and of indices.
impl<'a> Stored<'a> for Mesh<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Vertices)?;
        let error = AssetError::Shape { kind: Kind::Vertices, words: words.len() };
        let vertices: &[Vec3] = bytemuck::try_cast_slice(words).map_err(|_| error)?;
        Ok(Self::new(vertices, asset.read::<Indices<'_>>()?)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERTICES: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN];

    #[test]
    fn bad_corners_are_named() {
        let index = Mesh::new(&VERTICES, &[[0_u32, 1, 2], [0, 9, 1]]).unwrap_err();
        assert_eq!(index, MeshError::Index { triangle: 1, vertex: 9, vertices: 4 });
        let vertex = Mesh::new(&VERTICES, &[[0_u16, 1, 2], [0, 1, 3]]).unwrap_err();
        assert_eq!(vertex, MeshError::Vertex { triangle: 1, vertex: 3 });
        assert!(Mesh::new(&VERTICES, &[[0_u16, 1, 2]]).unwrap().with_masks(&[1, 2]).is_err());
    }

    #[test]
    fn single_sided_triangles_are_seen_from_the_front_only() {
        let mesh = Mesh::new(&VERTICES, &[[0_u16, 1, 2]]).unwrap().with_sides(Sides::Front);
        let span = Span::new(Hit { t: 0.0, primitive: 0 }, Hit { t: 9.0, primitive: u32::MAX });
        let hit = |z: f32| {
            let ray = Ray::new(Vec3::new(0.25, 0.25, z), Vec3::Z * -z).prepare().unwrap();
            mesh.intersect(0, &ray, &span)
        };
        assert!(hit(1.0).is_some() && hit(-1.0).is_none());
    }

    #[test]
    fn secondary_rays_leave_their_triangle() {
        let vertices = [Vec3::new(1.0e5, 3.0, 7.0), Vec3::new(1.0e5 + 3.0, -5.0, 7.1), Vec3::new(1.0e5, 4.0, 11.0)];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let everything = Span::new(Hit { t: 0.0, primitive: 0 }, Hit { t: f32::MAX, primitive: u32::MAX });
        for side in [1.0, -1.0] {
            let target = (vertices[0] + vertices[1] + vertices[2]) / 3.0;
            let ray = Ray::new(target + mesh.triangle(0).normal() * side, mesh.triangle(0).normal() * -side);
            let hit = mesh.intersect(0, &ray.prepare().unwrap(), &everything).unwrap();
            let surface = mesh.surface(&ray, &hit);
            assert_eq!(surface.front, side > 0.0);
            let back = -ray.direction;
            let away = Ray::new(surface.start_towards(back), back).prepare().unwrap();
            assert!(mesh.intersect(0, &away, &everything).is_none());
        }
    }
}
