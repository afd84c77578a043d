use core::fmt;

use crate::{
    accel::Hierarchy,
    geometry::Sphere,
    primitives::{Hit, Nearest, Probe, Proximity},
    scene::Scene,
};

/// Primitives found per search.
const BATCH: usize = 8;

/// The primitives that a sphere touches, in order of `(distance, number)`: see [`Scene::overlaps`].
#[derive(Clone)]
pub struct Overlaps<'s, A, P> {
    scene: &'s Scene<A, P>,
    probe: Option<Probe>,
    /// The least hit not yet searched for; `None` when all were.
    from: Option<Hit>,
    found: heapless::Deque<Hit, BATCH>,
}

impl<'s, A, P> Overlaps<'s, A, P> {
    pub(crate) fn new(scene: &'s Scene<A, P>, sphere: &Sphere) -> Self {
        let probe = Probe::new(sphere.center, sphere.radius);
        let from = probe.as_ref().map(|probe| probe.span().from());
        Self { scene, probe, from, found: heapless::Deque::new() }
    }
}

impl<A: Hierarchy, P: Proximity> Iterator for Overlaps<'_, A, P> {
    type Item = Nearest;

    fn next(&mut self) -> Option<Nearest> {
        let probe = self.probe.as_ref()?;
        if self.found.is_empty() {
            let mut batch: heapless::Vec<Hit, BATCH> = heapless::Vec::new();
            self.scene.nearest_touches(probe, self.from?, &mut batch);
            self.from = match batch.last() {
                Some(last) if batch.is_full() => Some(Hit { primitive: last.primitive.saturating_add(1), ..*last }),
                _ => None,
            };
            for hit in batch {
                // As many as there is room for.
                let _ = self.found.push_back(hit);
            }
        }
        self.scene.located(probe.point(), self.found.pop_front()?)
    }
}

impl<A, P> fmt::Debug for Overlaps<'_, A, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Overlaps").field("probe", &self.probe).field("from", &self.from).finish_non_exhaustive()
    }
}
