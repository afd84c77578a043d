use glam::Vec3;

use super::{Hit, MeshError, Primitives, Probe, Proximity, Span, Surface, Triangles};
use crate::{
    asset::{Asset, Stored},
    error::Error,
    geometry::{Aabb, Corner, Crossing, Either, PreparedRay, Ray, intersect_quad},
};

/// Triangles of which each two share an edge: a mesh with [`Indices::Quads`](super::Indices::Quads).
pub trait Quads: Triangles {
    /// How many pairs there are; none if triangles are not paired.
    fn quads(&self) -> Option<u32>;

    /// The first point in `span` where `ray` meets the triangles `2 * quad` and `2 * quad + 1`: what
    /// [`Primitives::intersect`] finds for the two.
    fn intersect_quad(&self, quad: u32, ray: &PreparedRay, span: &Span) -> Option<Hit>;
}

/// A mesh as the quads that it is made of: structures refer to two triangles at a time, hits carry the triangle's number.
///
/// Two triangles that share an edge have four corners in place of six and are often missed together: they are tested at
/// once, each with the bits of [`Triangle::intersect`](crate::geometry::Triangle::intersect), so that the hits are those of the
/// mesh. A structure has half as many primitives to refer to: a grid is as fast in two thirds of the bytes. As Embree's quads
/// (Wald et al., *Embree*, 2014), though they need not be flat.
///
/// It goes around a [`Mesh`](super::Mesh), a [`LatticeMesh`](super::LatticeMesh) or a [`Smooth`](super::Smooth) one whose triangles
/// are [`Indices::Quads`](super::Indices::Quads), made by `bake::pairs` and `bake::quads` (feature `alloc`), and opens assets as they
/// do: `asset.scene::<Grid, QuadMesh<LatticeMesh>>()`. Rays of a tile are cast at it one by one.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, primitives::{Meshlets, QuadMesh}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
/// let mesh = Mesh::new(&vertices, Meshlets::new(&[0], &[[0_u8, 1, 2, 3]])?)?;
/// let scene = Scene::new(List::new(&QuadMesh::new(mesh)?)?, QuadMesh::new(mesh)?)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::new(0.2, 0.7, 1.0), Vec3::NEG_Z)).unwrap();
/// assert_eq!(hit.primitive, 1); // between corners 0, 2 and 3
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct QuadMesh<M>(M);

impl<M: Quads> QuadMesh<M> {
    /// The quads of a mesh.
    ///
    /// # Errors
    ///
    /// [`MeshError::Quads`] if its triangles are other [`Indices`](super::Indices).
    pub fn new(mesh: M) -> Result<Self, MeshError> {
        match mesh.quads() {
            Some(_) => Ok(Self(mesh)),
            None => Err(MeshError::Quads),
        }
    }

    /// The mesh.
    #[must_use]
    pub const fn mesh(&self) -> &M {
        &self.0
    }
}

/// [`Quads::intersect_quad`] for corners where they lie.
#[inline(always)]
pub(super) fn intersect<M: Triangles, C: Corner>(
    mesh: &M,
    corners: [C; 4],
    quad: u32,
    ray: &PreparedRay,
    span: &Span,
) -> Option<Hit> {
    let limits = || (span.t_min(), span.t_max());
    let see = |number: u32, crossing: &Crossing| {
        if mesh.mask(number) & ray.ray().mask == 0 { None } else { mesh.sides().see(crossing, span, number) }
    };
    match intersect_quad(corners, ray, limits, |second, front| certify(mesh, 2 * quad + second, ray, limits(), front)) {
        Either::Neither => None,
        Either::One(second, crossing) => see(2 * quad + second, &crossing),
        Either::Both => {
            let hit = both(mesh, quad, ray, span.from(), span.until(), span.clamp_to());
            (!hit.t.is_nan()).then_some(hit)
        }
    }
}

/// The slow tiers for a triangle: its corners are looked up once more, so that the test that most rays end with has nothing to
/// keep.
#[cold]
#[inline(never)]
fn certify<M: Triangles>(
    mesh: &M,
    triangle: u32,
    ray: &PreparedRay,
    limits: (f32, f32),
    front: Option<bool>,
) -> Option<Crossing> {
    mesh.triangle(triangle).certify(ray, limits, front)
}

/// The first hit of both triangles, NaN if there is none: what goes in and out fits into registers, so that rays that do not come
/// here need no room for it.
#[cold]
#[inline(never)]
fn both<M: Triangles>(mesh: &M, quad: u32, ray: &PreparedRay, from: Hit, until: Hit, clamp_to: (f32, f32)) -> Hit {
    let span = Span::new(from, until).clamped_to(clamp_to);
    let hits = triangles(quad)
        .map(|number| if mesh.mask(number) & ray.ray().mask == 0 { None } else { mesh.intersect(number, ray, &span) });
    first_of(hits).unwrap_or(Hit { t: f32::NAN, primitive: u32::MAX })
}

/// The numbers of a quad's triangles.
const fn triangles(quad: u32) -> [u32; 2] {
    let first = quad.saturating_mul(2);
    [first, first.saturating_add(1)]
}

fn first_of([first, second]: [Option<Hit>; 2]) -> Option<Hit> {
    match (first, second) {
        (Some(one), Some(other)) if other.precedes(&one) => second,
        _ => first.or(second),
    }
}

impl<M: Quads> Primitives for QuadMesh<M> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.0.quads().unwrap_or(0)
    }

    fn numbers(&self) -> u32 {
        self.0.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        let [first, second] = triangles(index).map(|number| self.0.bounds(number));
        first.union(&second)
    }

    fn frame(&self) -> Option<Aabb> {
        self.0.frame()
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.0.intersect_quad(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.0.surface(ray, hit)
    }

    #[inline(always)]
    fn is_certified(&self, _index: u32) -> bool {
        true
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        match triangles(index).map(|number| self.0.clip(number, cell)) {
            [Some(first), Some(second)] => Some(first.union(&second)),
            [first, second] => first.or(second),
        }
    }
}

impl<M: Quads + Proximity> Proximity for QuadMesh<M> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        self.0.closest_point(number, point)
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        first_of(triangles(index).map(|number| self.0.approach(number, probe)))
    }
}

/// The sections of the mesh.
impl<'a, M: Quads + Stored<'a>> Stored<'a> for QuadMesh<M> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::new(asset.read()?)?)
    }
}
