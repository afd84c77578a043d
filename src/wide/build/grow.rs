//! From the top down: a set is divided where the surface area heuristic expects the least work.

use rayon::prelude::*;
use std::mem;

use super::{
    Options,
    bins::{Bins, Grid, Rules},
    item::{Extent, Item},
    node::Node,
    partition::{CHUNK, partition, partition_parallel},
    progress::Monitor,
    sweep,
};

/// Sets of more items are divided by all threads together.
const SHARED: usize = 4 * CHUNK;

/// Sets of fewer items are left to one thread.
const ALONE: usize = 4096;

/// A set of items and the place for its hierarchy.
pub(super) struct Task<'t> {
    pub(super) items: &'t mut [Item],
    /// As long as the items.
    pub(super) spare: &'t mut [Item],
    /// As long as the items.
    pub(super) references: &'t mut [u32],
    /// For all nodes below: two less than twice the items; of a task that is split, the children are taken out.
    pub(super) nodes: &'t mut [Node],
    /// The numbers of the first reference and node.
    pub(super) first: u32,
    pub(super) base: u32,
    pub(super) extent: Extent,
    /// How often it may be divided.
    pub(super) levels: u32,
}

impl<'t> Task<'t> {
    /// Its parts; the first `left` items are in the first.
    fn split(self, left: usize) -> [Self; 2] {
        let (items, others) = self.items.split_at_mut(left);
        let extents = match self.references.len() > SHARED {
            true => [extent_parallel(items), extent_parallel(others)],
            false => [Extent::of(items), Extent::of(others)],
        };
        let spare = self.spare.split_at_mut(left);
        let references = self.references.split_at_mut(left);
        let nodes = self.nodes.split_at_mut(2 * left - 2);
        let levels = self.levels - 1;
        let base = self.base + 2;
        [
            Self { items, spare: spare.0, references: references.0, nodes: nodes.0, extent: extents[0], levels, base, ..self },
            Self {
                items: others,
                spare: spare.1,
                references: references.1,
                nodes: nodes.1,
                extent: extents[1],
                levels,
                first: self.first + left as u32,
                base: base + 2 * left as u32 - 2,
            },
        ]
    }
}

/// The extent of many items.
pub(super) fn extent_parallel(items: &[Item]) -> Extent {
    items.par_chunks(CHUNK).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union)
}

/// What all tasks share.
pub(super) struct Grower<'g> {
    pub(super) options: &'g Options,
    pub(super) block: u32,
    pub(super) monitor: &'g Monitor<'g>,
}

impl Grower<'_> {
    /// Builds the hierarchy of a set; its root.
    pub(super) fn grow(&self, task: Task<'_>) -> Node {
        let count = task.items.len();
        if count <= ALONE {
            let node = self.grow_alone(task);
            self.monitor.advance(count as u32);
            return node;
        }
        if self.monitor.is_stopped() {
            return Node::leaf(task.extent.hull, task.first, 0);
        }
        self.inner(task, |[left, right]| rayon::join(|| self.grow(left), || self.grow(right)))
    }

    /// As [`grow`](Self::grow), on one thread.
    fn grow_alone(&self, task: Task<'_>) -> Node {
        self.inner(task, |[left, right]| (self.grow_alone(left), self.grow_alone(right)))
    }

    /// A node, its children made by `both`; or a leaf.
    fn inner(&self, mut task: Task<'_>, both: impl FnOnce([Task<'_>; 2]) -> (Node, Node)) -> Node {
        let (hull, first, base) = (task.extent.hull, task.first, task.base);
        let Some(left) = self.divide(&mut task) else {
            for (reference, item) in task.references.iter_mut().zip(&*task.items) {
                *reference = item.number();
            }
            return Node::leaf(hull, first, task.items.len() as u32);
        };
        let (place, nodes) = mem::take(&mut task.nodes).split_at_mut(2);
        task.nodes = nodes;
        let (left, right) = both(task.split(left));
        place.copy_from_slice(&[left, right]);
        Node::inner(hull, base)
    }

    /// Puts the items of the left part first; how many they are. None if the set is to be a leaf.
    #[inline(never)]
    fn divide(&self, task: &mut Task<'_>) -> Option<usize> {
        let count = task.items.len();
        let block = 1 << self.block;
        if count <= 1 || (count <= block && self.options.sorted == 0) {
            return None;
        }
        let scale = task.extent.hull.scale();
        let most = u32::try_from((block as u64) << (task.levels - 1).min(32)).unwrap_or(u32::MAX);
        let rules = Rules { scale, block: self.block, most };
        let whole = task.extent.hull.weight(scale);
        let pays = |cost: f32| count > block || cost + whole * self.options.step_cost < whole;
        if count <= (self.options.sorted as usize).min(sweep::MOST) {
            return match sweep::divide(task.items, task.spare, &rules) {
                Some((left, cost)) => pays(cost).then_some(left),
                None => (count > block).then_some(count / 2),
            };
        }
        let grid = Grid::new(task.extent.middles, (4 + count / 16).min(self.options.bins as usize));
        let bins = match count > SHARED {
            true => {
                let chunks = task.items.par_chunks(CHUNK).map(|chunk| Bins::of(chunk, &grid));
                chunks.reduce_with(|bins, other| bins.merge(&other))?
            }
            false => Bins::of(task.items, &grid),
        };
        match bins.cheapest(&grid, &rules) {
            Some(cut) if pays(cut.cost) => Some(if count > SHARED {
                let left = partition_parallel(task.items, task.spare, &cut);
                mem::swap(&mut task.items, &mut task.spare);
                left
            } else {
                partition(task.items, task.spare, &cut)
            }),
            None if count > block => Some(count / 2),
            _ => None,
        }
    }
}
