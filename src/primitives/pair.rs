use glam::Vec3;

use super::{Hit, Primitives, Probe, Proximity, Span, Surface};
use crate::{
    asset::{Asset, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle},
};

/// Two collections as one: the numbers of the second follow those of the first.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, geometry::Sphere, glam::Vec3, primitives::Spheres};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let balls = [Sphere::new(Vec3::new(0.2, 0.2, 2.0), 0.5)];
/// let both = (Mesh::new(&vertices, &[[0_u16, 1, 2]])?, Spheres::new(&balls)?);
/// let scene = Scene::new(List::new(&both)?, &both)?;
/// let down = Ray::new(Vec3::new(0.2, 0.2, 5.0), Vec3::NEG_Z);
/// let hits: Vec<u32> = scene.hits(&down).map(|hit| hit.primitive).collect();
/// assert_eq!(hits, [1, 1, 0]); // into the ball, out of it, the triangle
/// # Ok::<(), hitscan::Error>(())
/// ```
impl<A: Primitives, B: Primitives> Primitives for (A, B) {
    fn len(&self) -> u32 {
        self.0.len().saturating_add(self.1.len())
    }

    fn numbers(&self) -> u32 {
        self.0.numbers().saturating_add(self.1.numbers())
    }

    fn bounds(&self, index: u32) -> Aabb {
        match index.checked_sub(self.0.len()) {
            None => self.0.bounds(index),
            Some(index) => self.1.bounds(index),
        }
    }

    #[inline]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        match index.checked_sub(self.0.len()) {
            None => self.0.intersect(index, ray, span),
            Some(second) => {
                let base = self.0.numbers();
                let hit = self.1.intersect(second, ray, &span.numbered_from(base))?;
                Some(Hit { primitive: hit.primitive.saturating_add(base), ..hit })
            }
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match hit.primitive.checked_sub(self.0.numbers()) {
            None => self.0.surface(ray, hit),
            Some(primitive) => self.1.surface(ray, &Hit { primitive, ..*hit }),
        }
    }

    fn mask(&self, index: u32) -> u32 {
        match index.checked_sub(self.0.len()) {
            None => self.0.mask(index),
            Some(index) => self.1.mask(index),
        }
    }

    #[inline]
    fn is_certified(&self, index: u32) -> bool {
        match index.checked_sub(self.0.len()) {
            None => self.0.is_certified(index),
            Some(index) => self.1.is_certified(index),
        }
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        match index.checked_sub(self.0.len()) {
            None => self.0.clip(index, cell),
            Some(index) => self.1.clip(index, cell),
        }
    }

    fn outline(&self, index: u32) -> Option<Triangle> {
        match index.checked_sub(self.0.len()) {
            None => self.0.outline(index),
            Some(index) => self.1.outline(index),
        }
    }
}

impl<A: Proximity, B: Proximity> Proximity for (A, B) {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        match number.checked_sub(self.0.numbers()) {
            None => self.0.closest_point(number, point),
            Some(number) => self.1.closest_point(number, point),
        }
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        match index.checked_sub(self.0.len()) {
            None => self.0.approach(index, probe),
            Some(second) => {
                let base = self.0.numbers();
                let hit = self.1.approach(second, &probe.numbered_from(base))?;
                Some(Hit { primitive: hit.primitive.saturating_add(base), ..hit })
            }
        }
    }
}

impl<'a, A: Stored<'a>, B: Stored<'a>> Stored<'a> for (A, B) {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok((A::read(asset)?, B::read(asset)?))
    }
}
