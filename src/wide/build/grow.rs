//! From the top down: a set is divided where the surface area heuristic expects the least work.

use std::{boxed::Box, ops::ControlFlow, vec::Vec};

use bytemuck::Zeroable;
use rayon::prelude::*;

use super::{
    LEAF, MAX_DEPTH, Options,
    bins::{self, Bins, Grid, Rules},
    branch::Branch,
    division::Division,
    few::{self, Few},
    item::Item,
    partition::CHUNK,
    progress::Monitor,
    spatial::{Cells, Plane, Spread},
    task::{Parts, SHARED, Task},
};
use crate::{
    primitives::Primitives,
    wide::{
        binary::{Binary, BinaryNode},
        hull::Hull,
    },
};

/// Sets of fewer items are left to one thread.
const ALONE: usize = 4096;

/// Parts whose boxes have less than this in common, of the weight of everything, are not worth a look at cuts.
const OVERLAP: f32 = 1.0e-3;

/// What all tasks share.
pub(super) struct Grower<'g, P: ?Sized, B> {
    pub(super) primitives: &'g P,
    pub(super) options: &'g Options,
    /// The box of everything.
    pub(super) whole: Hull,
    pub(super) monitor: &'g Monitor<'g, B>,
}

impl<P: Primitives + Sync + ?Sized, B: Send> Grower<'_, P, B> {
    /// Builds the hierarchy of a set.
    pub(super) fn grow(&self, mut task: Task<'_>) -> ControlFlow<B, Branch> {
        let size = task.items.len();
        let divided = if size > ALONE { self.divide(&mut task) } else { None };
        let Some(parts) = divided else {
            let mut part = Binary { nodes: Vec::with_capacity(2 * size), references: Vec::with_capacity(size) };
            part.nodes.push(BinaryNode::zeroed());
            self.grow_alone(task, 0, &mut part);
            self.monitor.advance(size as u32)?;
            return ControlFlow::Continue(Branch::Part(part));
        };
        self.monitor.advance(0)?;
        let hull = task.extent.hull;
        let [left, right] = task.split(&parts);
        let (left, right) = rayon::join(|| self.grow(left), || self.grow(right));
        ControlFlow::Continue(Branch::Pair(hull, Box::new([left?, right?])))
    }

    /// As [`grow`](Self::grow), on one thread and without a word; the root gets its `place` among the nodes.
    fn grow_alone(&self, mut task: Task<'_>, place: usize, part: &mut Binary) {
        let hull = task.extent.hull;
        let Some(parts) = self.divide(&mut task) else {
            part.nodes[place] = BinaryNode::leaf(hull, part.references.len(), task.count);
            part.references.extend(task.items[..task.count].iter().map(Item::number));
            return;
        };
        let first = part.nodes.len();
        part.nodes[place] = BinaryNode::inner(hull, first);
        part.nodes.extend([BinaryNode::zeroed(); 2]);
        for (place, task) in (first..).zip(task.split(&parts)) {
            self.grow_alone(task, place, part);
        }
    }

    /// Divides a set; none if it is to be a leaf. Not inlined, so that what it needs is not on the stack of all above.
    #[inline(never)]
    fn divide(&self, task: &mut Task<'_>) -> Option<Parts> {
        Some(self.best(task)?.place(task, self.primitives))
    }

    /// How to divide a set at the least cost; none if it is to be a leaf.
    fn best(&self, task: &Task<'_>) -> Option<Division> {
        let must = task.count > LEAF as usize;
        if task.count <= 1 || (!must && (self.options.step_cost == f32::INFINITY || task.levels == 0)) {
            return None;
        }
        let scale = task.extent.hull.scale();
        let below = u32::try_from(u64::from(LEAF) << task.levels.saturating_sub(1).min(32)).unwrap_or(u32::MAX);
        let rules = Rules { scale, most: below };
        let whole = task.extent.hull.weight(scale);
        let pays = |cost: f32| must || cost + whole * self.options.step_cost < whole;
        let Some((cost, parts, division)) = self.whole_items(task, &rules) else {
            return must.then_some(Division::Halves);
        };
        match self.plane(task, &rules, parts, cost) {
            Some(plane) if pays(plane.cost) => Some(Division::Plane(plane, rules)),
            _ => pays(cost).then_some(division),
        }
    }

    /// The best way to divide a set without cuts, what both parts cost and their boxes.
    fn whole_items(&self, task: &Task<'_>, rules: &Rules) -> Option<(f32, [Hull; 2], Division)> {
        let items = &task.items[..task.count];
        if items.len() <= (self.options.few as usize).clamp(2, few::MOST) {
            let few = Few::best(items, rules)?;
            return Some((few.cost, few.hulls, Division::Few(few)));
        }
        let count = (4 + items.len() / 16).min(self.options.bins as usize);
        let grid = Grid::new(task.extent.middles, count);
        // Small sets do without clearing many bins.
        match items.len() {
            0..=64 => return cut::<8>(items, &grid, rules),
            65..=192 => return cut::<16>(items, &grid, rules),
            193..=SHARED => return cut::<{ bins::MOST }>(items, &grid, rules),
            _ => {}
        }
        let chunks: Vec<Bins<{ bins::MOST }>> = items.par_chunks(CHUNK).map(|chunk| Bins::of(chunk, &grid)).collect();
        let bins = chunks.iter().fold(Bins::EMPTY, Bins::merge);
        let cut = bins.cheapest(&grid, rules)?;
        Some((cut.cost, bins.parts(&cut), Division::Cut(cut, chunks)))
    }

    /// A plane that divides a set for less than `least`, if there is room to cut and its `parts` would overlap otherwise.
    fn plane(&self, task: &Task<'_>, rules: &Rules, parts: [Hull; 2], least: f32) -> Option<Plane> {
        let room = (task.items.len() - task.count) as u32;
        let common = parts[0].intersection(parts[1]);
        let scale = self.whole.scale();
        // Cuts may leave more items than the levels left can part, so none are made far down.
        if room == 0
            || task.levels <= MAX_DEPTH / 2
            || common.is_empty()
            || common.weight(scale) < OVERLAP * self.whole.weight(scale)
        {
            return None;
        }
        let items = &task.items[..task.count];
        let cells = Cells::new(task.extent.hull);
        let is_whole = |number| !self.primitives.is_certified(number);
        let spread = match items.len() > SHARED {
            true => {
                let chunks = items.par_chunks(CHUNK).map(|chunk| Spread::of(chunk, &cells, is_whole));
                chunks.reduce_with(|spread, other| spread.merge(&other))?
            }
            false => Spread::of(items, &cells, is_whole),
        };
        spread.cheapest(&cells, rules, least, items.len() as u32, room)
    }
}

/// The best border between `N` bins.
fn cut<const N: usize>(items: &[Item], grid: &Grid, rules: &Rules) -> Option<(f32, [Hull; 2], Division)> {
    let bins = Bins::<N>::of(items, grid);
    let cut = bins.cheapest(grid, rules)?;
    Some((cut.cost, bins.parts(&cut), Division::Cut(cut, Vec::new())))
}
