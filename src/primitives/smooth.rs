use glam::Vec3;

use super::{Hit, Mesh, Normals, Primitives, Quads, Span, Surface, unit};
use crate::{
    asset::{Asset, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle},
};

/// The least cosine between a mirrored ray and the surface it leaves.
const GRAZING: f32 = 0.02;

/// The least cosine between a triangle's normal and that of its corners, 35 degrees: beyond, it is part of an edge that is
/// meant.
const CREASE: f32 = 0.82;

/// A mesh that is shaded as if it were curved: a decorator that blends the normals of a triangle's corners.
///
/// Phong, *Illumination for computer generated pictures*, 1975. What is hit, and where, stays the mesh's. Normals take 12
/// bytes a vertex in memory, and 2 in an [asset](Normals): `asset.scene::<KdTree, Smooth>()`.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, primitives::Smooth};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let normals = [Vec3::Z, Vec3::new(0.3, 0.0, 1.0).normalize(), Vec3::Z];
/// let scene = Scene::new(List::new(&mesh)?, Smooth::new(mesh, &normals))?;
/// let ray = Ray::new(Vec3::new(0.5, 0.2, 1.0), Vec3::NEG_Z);
/// let surface = scene.surface(&ray, &scene.closest_hit(&ray).unwrap());
/// assert!(surface.geometric_normal == Vec3::Z && surface.shading_normal.x > 0.1);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Smooth<'a> {
    mesh: Mesh<'a>,
    normals: Source<'a>,
}

/// Where normals are.
#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Plain(&'a [Vec3]),
    Packed(Normals<'a>),
}

impl Source<'_> {
    fn get(&self, vertex: u32) -> Vec3 {
        match self {
            Self::Plain(normals) => normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO),
            Self::Packed(normals) => normals.get(vertex),
        }
    }
}

impl<'a> Smooth<'a> {
    /// The mesh with a normal of length 1 for each vertex; a missing or zero normal leaves the triangles around it flat, and
    /// so does one that is more than 35 degrees from theirs.
    #[must_use]
    pub const fn new(mesh: Mesh<'a>, normals: &'a [Vec3]) -> Self {
        Self { mesh, normals: Source::Plain(normals) }
    }

    /// The mesh with normals of an asset.
    #[must_use]
    pub const fn packed(mesh: Mesh<'a>, normals: Normals<'a>) -> Self {
        Self { mesh, normals: Source::Packed(normals) }
    }

    /// The mesh without them.
    #[must_use]
    pub const fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    /// The blended normal, if the triangle is to look curved.
    fn normal(&self, surface: &Surface, triangle: u32) -> Option<Vec3> {
        let corners = self.mesh.indices().get(triangle)?;
        let [a, b, c] = corners.map(|vertex| self.normals.get(vertex));
        if [a, b, c].into_iter().any(|normal| normal.dot(surface.geometric_normal) < CREASE) {
            return None;
        }
        let (v, w) = (surface.uv.x, surface.uv.y);
        (a * (1.0 - v - w) + b * v + c * w).try_normalize()
    }
}

impl Primitives for Smooth<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.mesh.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.mesh.bounds(index)
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.mesh.intersect(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let surface = self.mesh.surface(ray, hit);
        match self.normal(&surface, hit.primitive) {
            Some(normal) => Surface { shading_normal: above(&surface, unit(ray.direction), normal), ..surface },
            None => surface,
        }
    }

    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        self.mesh.mask(index)
    }

    #[inline(always)]
    fn is_certified(&self, index: u32) -> bool {
        self.mesh.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.mesh.clip(index, cell)
    }

    #[inline]
    fn outline(&self, index: u32) -> Option<Triangle> {
        self.mesh.outline(index)
    }
}

impl Quads for Smooth<'_> {
    #[inline(always)]
    fn quads(&self) -> Option<u32> {
        self.mesh.quads()
    }

    #[inline(always)]
    fn intersect_quad(&self, quad: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.mesh.intersect_quad(quad, ray, span)
    }
}

/// The sections of a mesh and of its normals.
impl<'a> Stored<'a> for Smooth<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::packed(asset.read()?, asset.read()?))
    }
}

/// The shading normal, bent so far that what it mirrors leaves the real surface instead of entering it.
fn above(surface: &Surface, direction: Vec3, normal: Vec3) -> Vec3 {
    let side = if surface.front { 1.0 } else { -1.0 };
    let (geometric, normal) = (surface.normal_towards_ray(), normal * side);
    let mirrored = direction - normal * (2.0 * direction.dot(normal));
    let height = mirrored.dot(geometric);
    if height >= GRAZING {
        return normal * side;
    }
    // The half vector between the way in and a mirrored way lifted above the surface.
    let lifted = (mirrored + geometric * (GRAZING - height)).normalize_or_zero();
    (lifted - direction).try_normalize().unwrap_or(geometric) * side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_any_length_see_the_same() {
        let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let normals = [Vec3::Z, Vec3::new(0.5, 0.0, 1.0).normalize(), Vec3::Z];
        let seen = [1.0, 1.0e-25, 1.0e25].map(|length| {
            let ray = Ray::new(Vec3::new(0.5, 0.2, 1.0), Vec3::NEG_Z * length);
            Smooth::new(mesh, &normals).surface(&ray, &Hit { t: 1.0 / length, primitive: 0 }).shading_normal
        });
        assert!(seen[0].x > 0.1);
        assert_eq!(seen, [seen[0]; 3]);
    }
}
