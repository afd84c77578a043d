use core::cell::Cell;

use super::{Hit, Primitives, Span, Surface};
use crate::geometry::{Aabb, PreparedRay, Ray, Triangle};

/// Primitives that count how often one is tested against a ray: a decorator, so that nobody else pays.
///
/// ```
/// use core::cell::Cell;
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, primitives::Counted};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [2, 1, 0]])?;
///
/// let tests = Cell::new(0);
/// let counted = Counted::new(&mesh, &tests);
/// let scene = Scene::new(List::new(&counted)?, counted)?;
/// assert!(scene.closest_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)).is_some());
/// assert_eq!(tests.get(), 2);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Counted<'c, P> {
    primitives: P,
    tests: &'c Cell<u64>,
}

impl<'c, P> Counted<'c, P> {
    /// `primitives`, each call of [`intersect`](Primitives::intersect) added to `tests`.
    pub const fn new(primitives: P, tests: &'c Cell<u64>) -> Self {
        Self { primitives, tests }
    }
}

impl<P: Primitives> Primitives for Counted<'_, P> {
    fn len(&self) -> u32 {
        self.primitives.len()
    }

    fn numbers(&self) -> u32 {
        self.primitives.numbers()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.primitives.bounds(index)
    }

    fn frame(&self) -> Option<Aabb> {
        self.primitives.frame()
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.tests.set(self.tests.get().saturating_add(1));
        self.primitives.intersect(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.primitives.surface(ray, hit)
    }

    fn mask(&self, index: u32) -> u32 {
        self.primitives.mask(index)
    }

    fn is_certified(&self, index: u32) -> bool {
        self.primitives.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.primitives.clip(index, cell)
    }

    fn outline(&self, index: u32) -> Option<Triangle> {
        self.primitives.outline(index)
    }
}
