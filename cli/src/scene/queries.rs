use hitscan::{Accelerator, Hit, Primitives, Ray, Scene, render::Caster};

/// A scene of any structure and any primitives, asked from several threads: one virtual call per ray, none within.
pub trait Queries: Caster + Sync {
    /// The first hit of the ray and the number of all of them.
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32);
}

impl<A: Accelerator + Sync, P: Primitives + Sync> Queries for Scene<A, P> {
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32) {
        let mut hits = self.hits(ray);
        let first = hits.next();
        let rest = hits.count() as u32;
        (first, u32::from(first.is_some()) + rest)
    }
}
