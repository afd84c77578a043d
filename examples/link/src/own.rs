//! Shapes as a user writes them.

use core::hint::black_box;

use hitscan::{
    Hit, PreparedRay, Primitives, Span,
    geometry::Aabb,
    glam::Vec3,
    primitives::{Probe, Proximity},
};

use crate::input::{aabb, float, vector, word};

/// Shapes of which nothing is known.
pub struct Own;

impl Primitives for Own {
    fn len(&self) -> u32 {
        word()
    }

    fn bounds(&self, _index: u32) -> Aabb {
        aabb()
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        black_box((ray.ray().at(span.t_min()), span.t_max()));
        span.accept(float(), index)
    }
}

impl Proximity for Own {
    fn closest_point(&self, _number: u32, _point: Vec3) -> Option<Vec3> {
        Some(vector())
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        probe.accept(probe.point().x, index)
    }
}

/// Asks primitives of any kind for everything.
pub fn asked<P: Proximity>(primitives: &P) {
    black_box((primitives.len(), primitives.numbers(), primitives.is_empty(), primitives.frame()));
    black_box(primitives.outline(word()));
    black_box((primitives.bounds(word()), primitives.mask(word()), primitives.is_certified(word())));
    black_box((primitives.clip(word(), &aabb()), primitives.closest_point(word(), vector())));
}
