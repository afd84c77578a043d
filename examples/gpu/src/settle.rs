use hitscan::{Hit, Ray};
use rayon::prelude::*;

use crate::{Answer, Query, World};

/// How a batch was answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays in all.
    pub rays: usize,
    /// Rays that the library cast again, because the shader was not certain.
    pub finished: usize,
    /// Answers that were certain and wrong: none, or there is an error in the argument or the GPU.
    pub refuted: usize,
    /// Nodes that shaders looked at.
    pub nodes: u64,
    /// Primitives that shaders tested.
    pub tests: u64,
}

impl Tally {
    fn and(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            finished: self.finished + other.finished,
            refuted: self.refuted + other.refuted,
            nodes: self.nodes + other.nodes,
            tests: self.tests + other.tests,
        }
    }
}

/// The library's hits, from what shaders say; for [`Query::Any`], of a ray that hits something, the hit that all have: 0 at 0.
#[must_use]
pub fn settle(world: &World<'_, '_>, rays: &[Ray], answers: &[Answer], query: Query) -> (Vec<Option<Hit>>, Tally) {
    let mut hits = vec![None; rays.len()];
    let one = |((hit, ray), answer): ((&mut Option<Hit>, &Ray), &Answer)| {
        let (found, finished, refuted) = settle_one(world, ray, *answer, query);
        *hit = found;
        let (nodes, tests) = (answer.nodes().into(), answer.tests().into());
        Tally { rays: 1, finished: finished.into(), refuted: refuted.into(), nodes, tests }
    };
    let each = hits.par_iter_mut().zip(rays).zip(answers).with_min_len(256);
    let tally = each.map(one).reduce(Tally::default, Tally::and);
    (hits, tally)
}

/// The hit, whether the library cast the ray, and whether the shader was wrong.
fn settle_one(world: &World<'_, '_>, ray: &Ray, answer: Answer, query: Query) -> (Option<Hit>, bool, bool) {
    let caster = world.as_caster();
    let found = match query {
        Query::Closest => answer.place().map(|place| world.hit_with(ray, place)),
        Query::Any => answer.place().map(|_| Some(Hit { t: 0.0, primitive: 0 })),
    };
    match found {
        Some(Some(hit)) => (Some(hit), false, false),
        None if answer.is_certain() => (None, false, false),
        // Not certain; or so certain that the library, which hits nothing there, has the last word.
        refuted => {
            let hit = match query {
                Query::Closest => caster.closest_hit(ray, 0),
                Query::Any => caster.any_hit(ray, 0).then_some(Hit { t: 0.0, primitive: 0 }),
            };
            (hit, true, refuted.is_some())
        }
    }
}
