use core::fmt;

use glam::{Vec2, Vec3};

use super::{Hit, Primitives, Probe, Proximity, Span, Surface, unit};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Sphere},
};

/// A sphere's centre is not finite, its radius is not above 0, or its bounds exceed
/// [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SphereError {
    /// The sphere.
    pub sphere: u32,
    /// Its radius.
    pub radius: f32,
}

impl fmt::Display for SphereError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sphere {} (radius {}) needs a finite centre and a radius above 0", self.sphere, self.radius)
    }
}

impl core::error::Error for SphereError {}

/// Borrowed spheres, hit where a ray enters and where it leaves.
///
/// ```
/// use hitscan::{geometry::Sphere, glam::Vec3, primitives::Spheres};
/// let list = [Sphere::new(Vec3::ZERO, 1.0)];
/// let spheres = Spheres::new(&list)?;
/// assert!(Spheres::new(&[Sphere::new(Vec3::ZERO, -1.0)]).is_err());
/// # Ok::<(), hitscan::primitives::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Spheres<'a> {
    list: &'a [Sphere],
}

impl<'a> Spheres<'a> {
    /// These spheres.
    ///
    /// # Errors
    ///
    /// [`SphereError`] names the first that is none.
    pub fn new(list: &'a [Sphere]) -> Result<Self, SphereError> {
        for (index, sphere) in list.iter().enumerate() {
            if !(sphere.radius > 0.0 && sphere.bounds().is_valid()) {
                return Err(SphereError { sphere: index as u32, radius: sphere.radius });
            }
        }
        Ok(Self { list })
    }
}

impl Primitives for Spheres<'_> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.list.len() as u32
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.list.get(index as usize).map_or(Aabb::EMPTY, Sphere::bounds)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let [enter, leave] = self.list.get(index as usize)?.intersect(ray)?;
        span.accept(enter, index).or_else(|| span.accept(leave, index))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let Some(sphere) = self.list.get(hit.primitive as usize) else { return Surface::facing(ray, hit.t) };
        let normal = unit(ray.at(hit.t) - sphere.center);
        // Put back onto the surface, so that the error is the sphere's and not the distance's.
        let point = sphere.center + normal * sphere.radius;
        let magnitude = sphere.center.abs() + Vec3::splat(sphere.radius);
        Surface {
            point,
            geometric_normal: normal,
            shading_normal: normal,
            uv: Vec2::ZERO,
            front: ray.direction.dot(normal) < 0.0,
            error: magnitude.max_element() * (16.0 / 16_777_216.0),
        }
    }
}

/// The closest point of the surface, also from within.
impl Proximity for Spheres<'_> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        Some(self.list.get(number as usize)?.closest_point(point))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        probe.accept(self.list.get(index as usize)?.distance(probe.point()), index)
    }
}

/// The section of spheres.
impl<'a> Stored<'a> for Spheres<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Spheres)?;
        let error = AssetError::Shape { kind: Kind::Spheres, words: words.len() };
        Ok(Self::new(bytemuck::try_cast_slice(words).map_err(|_| error)?)?)
    }
}
