use glam::Vec3;

use super::{Hit, MeshError, Primitives, Probe, Proximity, Sides, Span, Surface, Triangles};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle, in_range, intersect_triangle},
};

/// Triangles that each have corners of their own: for the fewest instructions, where bytes do not count.
///
/// A test loads nine numbers in a row in place of three indices and three vertices far apart, for 36 bytes a triangle in place
/// of about 12. Under any structure; an asset holds both.
///
/// ```
/// use hitscan::{List, Ray, Scene, glam::{Vec3, vec3}, primitives::Soup};
/// let at = |z: f32| [vec3(0.0, 0.0, z), vec3(1.0, 0.0, z), vec3(0.0, 1.0, z)];
/// let triangles = [at(2.0), at(1.0)];
/// let soup = Soup::new(&triangles)?;
/// let scene = Scene::new(List::new(&soup)?, soup)?;
/// let hit = scene.closest_hit(&Ray::new(vec3(0.2, 0.2, 0.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.primitive), (1.0, 1));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Soup<'a> {
    triangles: &'a [[Vec3; 3]],
    sides: Sides,
}

impl<'a> Soup<'a> {
    /// The soup of these triangles, hit from both sides; their corners stand counter-clockwise seen from the front.
    ///
    /// # Errors
    ///
    /// [`MeshError::Vertex`] names the triangle and the corner that is not finite or beyond the range of coordinates.
    pub fn new(triangles: &'a [[Vec3; 3]]) -> Result<Self, MeshError> {
        let count = u32::try_from(triangles.len()).ok().filter(|&n| n < u32::MAX).ok_or(MeshError::TooMany)?;
        for (triangle, corners) in (0..count).zip(triangles) {
            if let Some(corner) = corners.iter().position(|&corner| !in_range(corner)) {
                return Err(MeshError::Vertex { triangle, vertex: corner as u32 });
            }
        }
        Ok(Self { triangles, sides: Sides::Both })
    }

    /// The same soup, hit from `sides` only.
    #[must_use]
    pub const fn with_sides(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// The corners of the triangles.
    #[must_use]
    pub const fn triangles(&self) -> &'a [[Vec3; 3]] {
        self.triangles
    }
}

impl Triangles for Soup<'_> {
    fn triangle(&self, index: u32) -> Triangle {
        let [a, b, c] = self.triangles.get(index as usize).copied().unwrap_or_default();
        Triangle::new(a, b, c)
    }

    fn sides(&self) -> Sides {
        self.sides
    }
}

impl Primitives for Soup<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.triangles.len() as u32
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.triangle(index).bounds()
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let corners = self.triangles.get(index as usize)?.each_ref().map(AsRef::<[f32; 3]>::as_ref);
        let crossing = intersect_triangle(corners, ray, || (span.t_min(), span.t_max()))?;
        self.sides.see(&crossing, span, index)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Surface::of_triangle(&self.triangle(hit.primitive), ray, hit)
    }

    #[inline(always)]
    fn is_certified(&self, _index: u32) -> bool {
        true
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.triangle(index).clip(cell)
    }

    #[inline]
    fn outline(&self, index: u32) -> Option<Triangle> {
        Some(self.triangle(index))
    }
}

impl Proximity for Soup<'_> {
    fn closest_point(&self, index: u32, point: Vec3) -> Option<Vec3> {
        self.triangles.get(index as usize)?;
        Some(self.triangle(index).closest_point(point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        self.triangles.get(index as usize)?;
        probe.accept(self.triangle(index).distance(probe.point()), index)
    }
}

/// The section of a soup: nine words a triangle.
impl<'a> Stored<'a> for Soup<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Soup)?;
        let error = AssetError::Shape { kind: Kind::Soup, words: words.len() };
        Ok(Self::new(bytemuck::try_cast_slice(words).map_err(|_| error)?)?)
    }
}
