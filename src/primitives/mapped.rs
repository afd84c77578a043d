use super::{Hit, Indices, Primitives, Span, Surface, TexCoords};
use crate::{
    asset::{Asset, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle},
};

/// Triangles onto which a picture is mapped: a decorator that blends the texture coordinates of a triangle's corners.
///
/// Catmull, *A subdivision algorithm for computer display of curved surfaces*, 1974. What is hit, and where, stays as it
/// was; [`Surface::uv`] tells where in the picture that is. It goes around a [`Mesh`](super::Mesh), a
/// [`Smooth`](super::Smooth) one or a [`LatticeMesh`](super::LatticeMesh), and takes 4 bytes a vertex in an asset:
/// `asset.scene::<KdTree, Mapped<Mesh>>()`. The picture is a [`Texture`](crate::render::Texture).
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::{Vec2, Vec3}, primitives::{Mapped, TexCoords}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let corners = [Vec2::ZERO, Vec2::new(4.0, 0.0), Vec2::new(0.0, 2.0)];
/// let scene = Scene::new(List::new(&mesh)?, Mapped::new(mesh, &mesh, TexCoords::new(&corners)))?;
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 1.0), Vec3::NEG_Z);
/// assert_eq!(scene.surface(&ray, &scene.closest_hit(&ray).unwrap()).uv, Vec2::ONE);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Mapped<'a, P> {
    triangles: P,
    corners: Indices<'a>,
    coordinates: TexCoords<'a>,
}

impl<'a, P: Primitives> Mapped<'a, P> {
    /// Triangles between these corners, with the coordinates of vertices; a triangle of which a corner has none keeps
    /// its weights.
    #[must_use]
    pub fn new(triangles: P, corners: impl Into<Indices<'a>>, coordinates: TexCoords<'a>) -> Self {
        Self { triangles, corners: corners.into(), coordinates }
    }
}

impl<P: Primitives> Primitives for Mapped<'_, P> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.triangles.len()
    }

    fn numbers(&self) -> u32 {
        self.triangles.numbers()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.triangles.bounds(index)
    }

    fn frame(&self) -> Option<Aabb> {
        self.triangles.frame()
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.triangles.intersect(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let surface = self.triangles.surface(ray, hit);
        let (v, w) = (surface.uv.x, surface.uv.y);
        let blended = || {
            let [a, b, c] = self.corners.get(hit.primitive)?.map(|vertex| self.coordinates.get(vertex));
            Some(a? * (1.0 - v - w) + b? * v + c? * w)
        };
        Surface { uv: blended().unwrap_or(surface.uv), ..surface }
    }

    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        self.triangles.mask(index)
    }

    #[inline(always)]
    fn is_certified(&self, index: u32) -> bool {
        self.triangles.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.triangles.clip(index, cell)
    }

    #[inline]
    fn outline(&self, index: u32) -> Option<Triangle> {
        self.triangles.outline(index)
    }
}

/// The sections of the triangles, of their corners and of texture coordinates.
impl<'a, P: Primitives + Stored<'a>> Stored<'a> for Mapped<'a, P> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::new(asset.read()?, asset.read::<Indices<'_>>()?, asset.read()?))
    }
}
