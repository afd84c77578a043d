use hitscan::{Accelerator, Hit, Primitives, Ray, Scene, render::Caster};

/// A scene of any structure and any primitives, asked from several threads: one virtual call per ray, none within.
pub trait Queries: Caster + Sync {
    /// The first hit of the ray and the number of all of them.
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32);

    /// The first hits of all rays: some structures are faster when they are asked together.
    fn first_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        rays.iter().map(|ray| self.closest_hit(ray, 0)).collect()
    }

    /// Whether there is anything on each of the rays.
    fn any_hits(&self, rays: &[Ray]) -> Vec<bool> {
        rays.iter().map(|ray| self.any_hit(ray, 0)).collect()
    }
}

impl<A: Accelerator + Sync, P: Primitives + Sync> Queries for Scene<A, P> {
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32) {
        let mut hits = self.hits(ray);
        let first = hits.next();
        let rest = hits.count() as u32;
        (first, u32::from(first.is_some()) + rest)
    }
}
