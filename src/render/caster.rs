use crate::{
    accel::Accelerator,
    geometry::{Aabb, Ray},
    primitives::{Hit, Primitives, Surface},
    scene::Scene,
};

/// What a renderer asks: every [`Scene`] answers.
///
/// Wrap one to count or time rays. `depth` is how often light was reflected on the way to the camera: 0 for the camera's
/// own rays and for shadows at what they hit.
pub trait Caster {
    /// The first hit of the ray.
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit>;

    /// Whether anything lies on the ray, a shadow ray.
    fn any_hit(&self, ray: &Ray, depth: u32) -> bool;

    /// The surface at a hit.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;

    /// The box around everything.
    fn bounds(&self) -> Aabb;
}

impl<A: Accelerator, P: Primitives> Caster for Scene<A, P> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        Self::closest_hit(self, ray)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        Self::any_hit(self, ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Self::surface(self, ray, hit)
    }

    fn bounds(&self) -> Aabb {
        Self::bounds(self)
    }
}
