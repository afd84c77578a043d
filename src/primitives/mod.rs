//! What can be hit: the [`Primitives`] trait and its implementations.
//!
//! Structures know boxes and numbers; primitives know shapes. Implement [`Primitives`] for your own type and every
//! structure, query and renderer works on it; the data never carries a trace of the structure.

mod counted;
mod faces;
mod from_fn;
mod hit;
mod indices;
mod lattice_mesh;
mod lattice_triangles;
mod mapped;
mod mesh;
mod meshlets;
mod normals;
mod pair;
mod proximity;
mod quad_mesh;
mod reordered;
mod smooth;
mod soup;
mod spheres;
mod surface;
mod tex_coords;
mod triangles;

pub use counted::Counted;
pub use from_fn::{FromFn, from_fn};
pub use hit::{Hit, Span};
pub use indices::Indices;
pub use lattice_mesh::LatticeMesh;
pub use lattice_triangles::LatticeTriangles;
pub use mapped::Mapped;
pub use mesh::{Mesh, MeshError, Sides};
pub use meshlets::Meshlets;
pub use normals::Normals;
pub use proximity::{Nearest, Probe, Proximity};
pub use quad_mesh::{QuadMesh, Quads};
pub use reordered::{Order, OrderError, Renumbering, Reordered};
pub use smooth::Smooth;
pub use soup::Soup;
pub use spheres::{SphereError, Spheres};
pub use surface::Surface;
pub(crate) use surface::unit;
pub use tex_coords::TexCoords;
pub use triangles::Triangles;

use crate::geometry::{Aabb, PreparedRay, Ray, Triangle};

/// A numbered collection of shapes.
///
/// Three methods are required: how many there are, the box around one, and where a ray meets one.
///
/// ```
/// use hitscan::{Hit, List, PreparedRay, Primitives, Ray, Scene, Span, geometry::Aabb, glam::Vec3};
///
/// /// Horizontal unit squares, one above the other.
/// struct Shelves(u32);
///
/// impl Primitives for Shelves {
///     fn len(&self) -> u32 {
///         self.0
///     }
///     fn bounds(&self, index: u32) -> Aabb {
///         let y = index as f32;
///         Aabb::new(Vec3::new(0.0, y, 0.0), Vec3::new(1.0, y, 1.0))
///     }
///     fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
///         let t = (index as f32 - ray.ray().origin.y) / ray.ray().direction.y;
///         let p = ray.ray().at(t);
///         let inside = (0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.z);
///         if inside { span.accept(t, index) } else { None }
///     }
/// }
///
/// let shelves = Shelves(4);
/// let scene = Scene::new(List::new(&shelves)?, &shelves)?;
/// let up = Ray::new(Vec3::new(0.5, 1.5, 0.5), Vec3::Y);
/// assert_eq!(scene.closest_hit(&up), Some(Hit { t: 0.5, primitive: 2 }));
/// # Ok::<(), hitscan::Error>(())
/// ```
pub trait Primitives {
    /// How many there are; their indices are below this.
    fn len(&self) -> u32;

    /// One above the greatest number that a hit can carry; more than [`len`](Self::len) where a shape is made of many, as
    /// a placed scene is.
    fn numbers(&self) -> u32 {
        self.len()
    }

    /// A box around the shape `index`, in coordinates of at most [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
    ///
    /// It may be larger than the shape, never smaller, and must be the same at every call.
    fn bounds(&self, index: u32) -> Aabb;

    /// A box for structures to take as that of everything, if not the least one: the frame of shapes on a lattice.
    ///
    /// What of the shapes lies outside, a structure's box contains all the same.
    fn frame(&self) -> Option<Aabb> {
        None
    }

    /// The first point in `span` where `ray` meets the shape `index`.
    ///
    /// Offer the parameters at which the ray meets it to [`Span::accept`], the least first, and return its first answer.
    /// A parameter must be a pure function of shape and ray. An index out of range is a miss.
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit>;

    /// The surface at a hit of `ray`, for shading and for rays that start there.
    ///
    /// The default knows only the point: a surface that faces the ray.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Surface::facing(ray, hit.t)
    }

    /// Which rays see the shape `index`: those whose mask shares a bit with this one.
    fn mask(&self, _index: u32) -> u32 {
        u32::MAX
    }

    /// Whether [`intersect`](Self::intersect) is certified for the shape `index`: what it returns lies within 2^-17 of the
    /// real parameter at which the ray meets the shape.
    ///
    /// Certified shapes may be referenced by their clipped parts. All others are referenced by their whole bounds, and
    /// their parameters are clamped into the interval that the ray has in common with these (ARCHITECTURE.md, R5).
    fn is_certified(&self, _index: u32) -> bool {
        false
    }

    /// A box around the part of the certified shape `index` inside `cell`, rounded outward; `None` if there is none.
    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        let part = self.bounds(index).intersection(cell);
        (!part.is_empty()).then_some(part)
    }

    /// A triangle that the certified shape `index` lies in: by it, rays that certainly miss are told many at a time.
    fn outline(&self, _index: u32) -> Option<Triangle> {
        None
    }

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<P: Primitives + ?Sized> Primitives for &P {
    #[inline(always)]
    fn len(&self) -> u32 {
        (**self).len()
    }
    #[inline(always)]
    fn numbers(&self) -> u32 {
        (**self).numbers()
    }
    #[inline(always)]
    fn bounds(&self, index: u32) -> Aabb {
        (**self).bounds(index)
    }
    #[inline(always)]
    fn frame(&self) -> Option<Aabb> {
        (**self).frame()
    }
    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        (**self).intersect(index, ray, span)
    }
    #[inline(always)]
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        (**self).surface(ray, hit)
    }
    #[inline(always)]
    fn mask(&self, index: u32) -> u32 {
        (**self).mask(index)
    }
    #[inline(always)]
    fn is_certified(&self, index: u32) -> bool {
        (**self).is_certified(index)
    }
    #[inline(always)]
    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        (**self).clip(index, cell)
    }
    #[inline(always)]
    fn outline(&self, index: u32) -> Option<Triangle> {
        (**self).outline(index)
    }
}

/// The box around all of `primitives` and their frame, or the first whose bounds are not valid.
pub(crate) fn bounds_of<P: Primitives + ?Sized>(primitives: &P) -> Result<Aabb, u32> {
    let mut all = Aabb::EMPTY;
    for index in 0..primitives.len() {
        let bounds = primitives.bounds(index);
        if !bounds.is_valid() {
            return Err(index);
        }
        all = all.union(&bounds);
    }
    let is_framed = !all.is_empty();
    Ok(primitives.frame().filter(|frame| is_framed && frame.is_valid()).map_or(all, |frame| all.union(&frame)))
}
