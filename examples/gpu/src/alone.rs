//! One primitive for itself: `t` is a pure function of ray and primitive, so that the library finds for one of a scene what
//! it finds for it among all.

use hitscan::{
    Accelerator, Hit, Instance, Instances, List, Primitives, Ray, Scene,
    geometry::{Aabb, PreparedRay},
    primitives::Span,
};

/// The closest hit of a ray with what has one primitive.
fn hit(one: &impl Primitives, ray: &Ray) -> Option<Hit> {
    Scene::new(List::new(one).ok()?, one).ok()?.closest_hit(ray)
}

/// A primitive of a collection.
pub(crate) struct Alone<'p, P> {
    primitives: &'p P,
    index: u32,
}

impl<'p, P: Primitives> Alone<'p, P> {
    pub(crate) const fn new(primitives: &'p P, index: u32) -> Self {
        Self { primitives, index }
    }

    pub(crate) fn hit(&self, ray: &Ray) -> Option<Hit> {
        hit(self, ray)
    }
}

impl<P: Primitives> Primitives for Alone<'_, P> {
    fn len(&self) -> u32 {
        1
    }

    fn numbers(&self) -> u32 {
        self.primitives.numbers()
    }

    fn bounds(&self, _index: u32) -> Aabb {
        self.primitives.bounds(self.index)
    }

    fn intersect(&self, _index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.primitives.intersect(self.index, ray, span)
    }

    fn is_certified(&self, _index: u32) -> bool {
        self.primitives.is_certified(self.index)
    }
}

/// A primitive of a placed scene, at its place: as [`Instances`] would offer it, clamped to the bounds of the instance.
pub(crate) struct PlacedAlone<'p, P> {
    instance: &'p Instance,
    bounds: Aabb,
    primitives: &'p P,
    index: u32,
}

impl<'p, P: Primitives> PlacedAlone<'p, P> {
    /// The primitive with this number among those of all instances.
    pub(crate) fn new<A: Accelerator>(instances: &Instances<'p, A, P>, number: u32) -> Option<Self> {
        let (place, index) = instances.locate(number)?;
        let instance = instances.placed().get(place as usize)?;
        let primitives = instances.scenes().get(instance.scene() as usize)?.primitives();
        Some(Self { instance, bounds: instances.bounds(place), primitives, index })
    }

    pub(crate) fn hit(&self, ray: &Ray) -> Option<Hit> {
        hit(self, ray)
    }
}

impl<P: Primitives> Primitives for PlacedAlone<'_, P> {
    fn len(&self) -> u32 {
        1
    }

    fn numbers(&self) -> u32 {
        u32::MAX
    }

    fn bounds(&self, _index: u32) -> Aabb {
        self.bounds
    }

    fn intersect(&self, _index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let line = self.instance.transform().ray_back(ray.ray()).starting_at(f32::NEG_INFINITY).up_to(f32::INFINITY);
        let hit = self.primitives.intersect(self.index, &line.prepare()?, span)?;
        Some(Hit { primitive: hit.primitive + self.instance.first(), ..hit })
    }
}
