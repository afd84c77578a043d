use core::fmt;

use super::{Nearest, end_of, start_of};
use crate::{
    accel::Accelerator,
    geometry::{PreparedRay, Ray},
    primitives::{Hit, Primitives},
    scene::Scene,
};

/// Hits found per search.
const BATCH: usize = 8;

/// The hits of a ray in order of `(t, number)`: see [`Scene::hits`].
///
/// ```
/// # use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};
/// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 2]])?;
/// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
/// assert_eq!(scene.hits(&ray).count(), 2);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone)]
pub struct Hits<'s, A, P> {
    scene: &'s Scene<A, P>,
    ray: Option<PreparedRay>,
    /// The least hit not yet searched for; `None` when all were.
    from: Option<Hit>,
    found: heapless::Deque<Hit, BATCH>,
}

impl<'s, A, P> Hits<'s, A, P> {
    pub(crate) fn new(scene: &'s Scene<A, P>, ray: &Ray) -> Self {
        let ray = ray.prepare();
        Self { scene, from: ray.as_ref().map(start_of), ray, found: heapless::Deque::new() }
    }
}

impl<A: Accelerator, P: Primitives> Iterator for Hits<'_, A, P> {
    type Item = Hit;

    fn next(&mut self) -> Option<Hit> {
        if self.found.is_empty() {
            let (ray, from) = (self.ray.as_ref()?, self.from?);
            let mut batch: heapless::Vec<Hit, BATCH> = heapless::Vec::new();
            self.scene.search(ray, &mut Nearest::new(from, end_of(ray), &mut batch));
            self.from = match batch.last() {
                Some(last) if batch.is_full() => Some(Hit { t: last.t, primitive: last.primitive.saturating_add(1) }),
                _ => None,
            };
            for hit in batch {
                // As many as there is room for.
                let _ = self.found.push_back(hit);
            }
        }
        self.found.pop_front()
    }
}

impl<A, P> fmt::Debug for Hits<'_, A, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hits").field("ray", &self.ray).field("from", &self.from).finish_non_exhaustive()
    }
}
