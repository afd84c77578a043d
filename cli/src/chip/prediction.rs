use std::fmt;

use hitscan::Primitives;

use super::{Arithmetic, Chip, Costs};
use crate::{
    failure::Failure,
    scene::{Built, Shape},
    trial::{Counts, Rays, Work, scene},
    units::{count, hundreds},
};

/// What a scene will cost on a chip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    chip: Chip,
    arithmetic: Arithmetic,
    costs: Costs,
    /// Instructions of a closest hit on average, over camera and bounce rays.
    pub typical: f64,
    /// Those of the dearest of these rays.
    dearest: f64,
    /// Those that no ray exceeds: every node is visited once, and every reference tested.
    bound: f64,
}

impl Prediction {
    /// That of `primitives` under a structure, from what `rays` visit, in the numbers in which it is quicker; `None` if its
    /// kind was not measured.
    pub fn new<P: Primitives>(chip: Chip, built: &Built, primitives: &P, rays: &Rays) -> Result<Option<Self>, Failure> {
        let structure = built.structure(primitives)?;
        let kind = structure.kind();
        // Only pairs have more numbers than shapes, and only what stands on a lattice has a frame.
        let in_pairs = primitives.numbers() > primitives.len();
        let costs = |arithmetic| Costs::of(chip, kind, arithmetic, in_pairs);
        let Some(floats) = costs(Arithmetic::Floats) else { return Ok(None) };
        let integers = primitives.frame().and_then(|_| costs(Arithmetic::Integers));
        let counts = Counts::default();
        let scene = scene(structure, primitives, Some(&counts))?;
        let rays = rays.primary.iter().chain(&rays.bounce);
        let work: Vec<Work> = rays.map(|ray| Work::of(&*scene, &counts, [ray].into_iter())).collect();
        let each =
            |costs: &Costs| work.iter().map(|work| costs.instructions(work.nodes, work.tests)).collect::<Vec<_>>();
        let sum = |costs: &Costs| each(costs).iter().sum::<f64>();
        let (arithmetic, costs) = match integers {
            Some(integers) if sum(&integers) < sum(&floats) => (Arithmetic::Integers, integers),
            _ => (Arithmetic::Floats, floats),
        };
        let bound = match kind {
            None => costs.instructions(0.0, f64::from(primitives.len())),
            Some(_) => {
                let Shape { nodes, references, .. } = Shape::of(&structure);
                costs.instructions(nodes as f64, references as f64)
            }
        };
        let typical = sum(&costs) / work.len().max(1) as f64;
        let dearest = each(&costs).into_iter().fold(0.0, f64::max);
        Ok(Some(Self { chip, arithmetic, costs, typical, dearest, bound }))
    }

    /// Flash, RAM and instructions, for an asset of so many bytes.
    pub fn rows(&self, asset: usize) -> [(&'static str, String); 5] {
        let Costs { stack, code, .. } = self.costs;
        let (typical, dearest, bound) = (hundreds(self.typical), hundreds(self.dearest), hundreds(self.bound));
        let numbers = match self.arithmetic {
            Arithmetic::Floats => "floating point, `Scene`",
            Arithmetic::Integers => "whole numbers, `LatticeScene`",
        };
        [
            ("answers in", numbers.to_owned()),
            ("flash", format!("{} bytes: the asset, and about {} of code", count(asset + code), count(code))),
            ("RAM", format!("none but {} bytes of stack", count(stack))),
            ("a ray", format!("{typical} instructions on average, {dearest} at most of those tried")),
            ("worst case", format!("{bound} instructions, if all nodes are visited and all references tested")),
        ]
    }
}

impl fmt::Display for Prediction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "about {} instructions a ray on {}", hundreds(self.typical), self.chip.phrase())
    }
}
