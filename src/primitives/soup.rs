use glam::Vec3;

use super::{Hit, MeshError, OrderError, Primitives, Probe, Proximity, Sides, Span, Surface};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle, in_range, intersect_triangle},
};

/// A triangle as it stands in a [`Soup`]: its corners and its owner's number for it, 40 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Facet {
    /// The corners, counter-clockwise seen from the front.
    pub corners: [[f32; 3]; 3],
    /// The number that hits carry.
    pub number: u32,
}

impl Facet {
    /// The same triangle.
    #[inline]
    fn triangle(&self) -> Triangle {
        let [a, b, c] = self.corners.map(Vec3::from_array);
        Triangle::new(a, b, c)
    }
}

/// Triangles whose corners lie where a structure's leaves want them: for the fewest instructions, where bytes do not count.
///
/// A leaf is a range of it, and a triangle stands in as many places as leaves name it: a test loads nine numbers in a row,
/// and neither a reference nor indices. Hits carry the owner's numbers, and so are bit for bit those of the mesh that it was made from.
/// `bake::gathered` makes it and its structure; an asset holds both.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, primitives::{Facet, Soup}};
/// let at = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
/// let (near, far) = (Facet { corners: at(1.0), number: 1 }, Facet { corners: at(2.0), number: 0 });
/// // The triangle 0 stands at the places 0 and 2, the triangle 1 at place 1.
/// let facets = [far, near, far];
/// let soup = Soup::new(&facets, &[2, 1])?;
/// let scene = Scene::new(List::new(&soup)?, soup)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.primitive), (1.0, 1));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Soup<'a> {
    facets: &'a [Facet],
    /// By number: one of the places where the triangle stands.
    places: &'a [u32],
    sides: Sides,
}

impl<'a> Soup<'a> {
    /// The soup of these facets, hit from both sides; `places` says of each number where its triangle stands.
    ///
    /// # Errors
    ///
    /// [`MeshError::Vertex`] names the place and the corner that is not finite or beyond the range of coordinates,
    /// [`OrderError`] the place whose number is none, or where another triangle stands than the number says.
    pub fn new(facets: &'a [Facet], places: &'a [u32]) -> Result<Self, Error> {
        let count = u32::try_from(facets.len()).ok().filter(|&n| n < u32::MAX).ok_or(MeshError::TooMany)?;
        for (place, facet) in (0..count).zip(facets) {
            let is_out = |corner: &[f32; 3]| !in_range(Vec3::from_array(*corner));
            if let Some(corner) = facet.corners.iter().position(is_out) {
                return Err(MeshError::Vertex { triangle: place, vertex: corner as u32 }.into());
            }
            if facet.number as usize >= places.len() {
                return Err(OrderError { place }.into());
            }
        }
        for (number, &place) in (0..).zip(places) {
            let there = facets.get(place as usize).map(|facet| facet.number);
            if there != Some(number) {
                return Err(OrderError { place }.into());
            }
        }
        Ok(Self { facets, places, sides: Sides::Both })
    }

    /// The same soup, hit from `sides` only.
    #[must_use]
    pub const fn with_sides(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// The triangles by place.
    #[must_use]
    pub const fn facets(&self) -> &'a [Facet] {
        self.facets
    }

    /// The triangle of a number; none if there is none.
    fn numbered(&self, number: u32) -> Option<Triangle> {
        let &place = self.places.get(number as usize)?;
        self.facets.get(place as usize).map(Facet::triangle)
    }

    /// The triangle at a place; one without area if there is none.
    fn at(&self, place: u32) -> Triangle {
        let nothing = Triangle::new(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        self.facets.get(place as usize).map_or(nothing, Facet::triangle)
    }
}

/// By place, as a structure's leaves name them; hits by number.
impl Primitives for Soup<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.facets.len() as u32
    }

    fn numbers(&self) -> u32 {
        self.places.len() as u32
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.at(index).bounds()
    }

    #[inline(always)]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let facet = self.facets.get(index as usize)?;
        let crossing = intersect_triangle(facet.corners.each_ref(), ray, || (span.t_min(), span.t_max()))?;
        self.sides.see(&crossing, span, facet.number)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.numbered(hit.primitive) {
            Some(triangle) => Surface::of_triangle(&triangle, ray, hit),
            None => Surface::facing(ray, hit.t),
        }
    }

    #[inline(always)]
    fn is_certified(&self, _index: u32) -> bool {
        true
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.at(index).clip(cell)
    }

    #[inline]
    fn outline(&self, index: u32) -> Option<Triangle> {
        Some(self.at(index))
    }
}

impl Proximity for Soup<'_> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        Some(self.numbered(number)?.closest_point(point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        let facet = self.facets.get(index as usize)?;
        probe.accept(facet.triangle().distance(probe.point()), facet.number)
    }
}

/// The section of a soup: how many numbers, the place of each, then the facets.
impl<'a> Stored<'a> for Soup<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Soup)?;
        let error = AssetError::Shape { kind: Kind::Soup, words: words.len() };
        let (&count, words) = words.split_first().ok_or(error)?;
        let (places, facets) = words.split_at_checked(count as usize).ok_or(error)?;
        Self::new(bytemuck::try_cast_slice(facets).map_err(|_| error)?, places)
    }
}
