use std::cell::Cell;

use hitscan::{Accelerator, Primitives, Ray, Scene, accel, primitives, render::Caster};

use crate::{failure::Failure, scene::broken};

/// What the decorators of a scene count.
#[derive(Debug, Default)]
pub struct Counts {
    nodes: Cell<u64>,
    tests: Cell<u64>,
}

/// What a ray takes, on average.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Nodes visited.
    pub nodes: f64,
    /// Primitives tested.
    pub tests: f64,
}

impl Work {
    /// What the closest hits of `rays` take in a scene that adds to `counts`.
    pub fn of<'r>(scene: &dyn Caster, counts: &Counts, rays: impl Iterator<Item = &'r Ray>) -> Self {
        counts.nodes.set(0);
        counts.tests.set(0);
        let mut number = 0_u32;
        for ray in rays {
            scene.closest_hit(ray, 0);
            number += 1;
        }
        let per_ray = |count: &Cell<u64>| count.get() as f64 / f64::from(number.max(1));
        Self { nodes: per_ray(&counts.nodes), tests: per_ray(&counts.tests) }
    }

    /// The same in tests, each node taking `node_cost` of one.
    pub fn in_tests(self, node_cost: f64) -> f64 {
        self.tests + self.nodes * node_cost
    }
}

/// The scene of `primitives` under `accelerator`, which adds to `counts` if there are any.
pub fn scene<'a, A: Accelerator + 'a, P: Primitives + 'a>(
    accelerator: A,
    primitives: P,
    counts: Option<&'a Counts>,
) -> Result<Box<dyn Caster + 'a>, Failure> {
    Ok(match counts {
        None => Box::new(Scene::new(accelerator, primitives).map_err(broken)?),
        Some(Counts { nodes, tests }) => {
            let (nodes, tests) = (accel::Counted::new(accelerator, nodes), primitives::Counted::new(primitives, tests));
            Box::new(Scene::new(nodes, tests).map_err(broken)?)
        }
    })
}
