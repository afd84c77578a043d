//! Triangles that remember their answers, so that a ray may be asked of many structures at the price of little more than one.

use std::cell::Cell;

use hitscan::{Hit, Mesh, PreparedRay, Primitives, Span, geometry::Aabb};

/// A mesh that tests each triangle against a ray once, whoever asks how often.
///
/// What a triangle answers is a pure function of the ray; a structure only chooses which triangles are asked, and within
/// which limits. What limits spare (rule R7) is not seen behind a memory, so that some scenes do without.
pub struct Memo<'a> {
    mesh: Mesh<'a>,
    /// The ray that crossed last, and where.
    crossings: Vec<Cell<(u32, f32)>>,
    /// The number of the ray at hand, from 1 on; 0 if nothing is to be remembered.
    ray: Cell<u32>,
}

impl<'a> Memo<'a> {
    pub fn new(mesh: Mesh<'a>, remembers: bool) -> Self {
        let crossings = vec![Cell::new((0, 0.0)); mesh.len() as usize];
        Self { mesh, crossings, ray: Cell::new(u32::from(remembers)) }
    }

    /// Forgets: another ray comes. To be called before each.
    pub fn forget(&self) {
        if self.ray.get() > 0 {
            self.ray.set(self.ray.get() + 1);
        }
    }
}

impl Primitives for Memo<'_> {
    fn len(&self) -> u32 {
        self.mesh.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.mesh.bounds(index)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let (now, Some(memory)) = (self.ray.get(), self.crossings.get(index as usize)) else { return None };
        if now == 0 {
            return self.mesh.intersect(index, ray, span);
        }
        let (then, mut t) = memory.get();
        if then != now {
            // Not a number where there is no crossing.
            t = self.mesh.triangle(index).intersect(ray, f32::MIN, f32::MAX).map_or(f32::NAN, |crossing| crossing.t);
            memory.set((now, t));
        }
        span.accept(t, index)
    }

    fn is_certified(&self, index: u32) -> bool {
        self.mesh.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.mesh.clip(index, cell)
    }
}
