//! From the top down: a set is divided where the surface area heuristic expects the least work.

use rayon::prelude::*;
use std::mem;

use super::{
    Options,
    bins::{Bins, Grid, Rules},
    hull::Hull,
    item::{Extent, Item},
    node::Node,
    partition::{CHUNK, partition, partition_parallel},
    progress::Monitor,
    spatial::{Cells, Parts, Plane},
    sweep,
};
use crate::primitives::Primitives;

/// Sets of more items are divided by all threads together.
const SHARED: usize = 4 * CHUNK;

/// Sets of fewer items are left to one thread.
const ALONE: usize = 4096;

/// A set of items and the place for its hierarchy.
pub(super) struct Task<'t> {
    /// The items, and room for those that cuts add.
    pub(super) items: &'t mut [Item],
    pub(super) count: usize,
    /// As long.
    pub(super) spare: &'t mut [Item],
    /// As long.
    pub(super) references: &'t mut [u32],
    /// For all nodes below: two less than twice as many; of a task that is split, the children are taken out.
    pub(super) nodes: &'t mut [Node],
    /// The numbers of the first reference and node.
    pub(super) first: u32,
    pub(super) base: u32,
    pub(super) extent: Extent,
    /// How often it may be divided.
    pub(super) levels: u32,
}

impl<'t> Task<'t> {
    /// Its parts, of so many items, which stand one behind the other.
    fn split(self, [left, right]: [usize; 2]) -> [Self; 2] {
        // Each gets its share of the room.
        let room = self.items.len() - (left + right);
        let size = left + (room as u64 * left as u64 / (left + right) as u64) as usize;
        self.items.copy_within(left..left + right, size);
        let (items, others) = self.items.split_at_mut(size);
        let extents = match left + right > SHARED {
            true => [extent_parallel(&items[..left]), extent_parallel(&others[..right])],
            false => [Extent::of(&items[..left]), Extent::of(&others[..right])],
        };
        let spare = self.spare.split_at_mut(size);
        let references = self.references.split_at_mut(size);
        let nodes = self.nodes.split_at_mut(2 * size - 2);
        let (levels, base) = (self.levels - 1, self.base + 2);
        [
            Self {
                items,
                count: left,
                spare: spare.0,
                references: references.0,
                nodes: nodes.0,
                first: self.first,
                base,
                extent: extents[0],
                levels,
            },
            Self {
                items: others,
                count: right,
                spare: spare.1,
                references: references.1,
                nodes: nodes.1,
                first: self.first + size as u32,
                base: base + 2 * size as u32 - 2,
                extent: extents[1],
                levels,
            },
        ]
    }
}

/// The extent of many items.
pub(super) fn extent_parallel(items: &[Item]) -> Extent {
    items.par_chunks(CHUNK).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union)
}

/// What all tasks share.
pub(super) struct Grower<'g, P: ?Sized> {
    pub(super) primitives: &'g P,
    pub(super) options: &'g Options,
    /// Binary logarithm of the primitives that are tested at once.
    pub(super) block: u32,
    /// The box of everything.
    pub(super) whole: Hull,
    pub(super) monitor: &'g Monitor<'g>,
}

/// Parts whose boxes have less than this in common, of the weight of everything, are not worth a look at cuts.
const OVERLAP: f32 = 1.0e-5;

impl<P: Primitives + Sync + ?Sized> Grower<'_, P> {
    /// Builds the hierarchy of a set; its root.
    pub(super) fn grow(&self, task: Task<'_>) -> Node {
        let size = task.items.len();
        if size <= ALONE {
            let node = self.grow_alone(task);
            self.monitor.advance(size as u32);
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
        let Some(counts) = self.divide(&mut task) else {
            for (reference, item) in task.references.iter_mut().zip(&task.items[..task.count]) {
                *reference = item.number();
            }
            return Node::leaf(hull, first, task.count as u32);
        };
        let (place, nodes) = mem::take(&mut task.nodes).split_at_mut(2);
        task.nodes = nodes;
        let (left, right) = both(task.split(counts));
        place.copy_from_slice(&[left, right]);
        Node::inner(hull, base)
    }

    /// Brings the items of the left part before those of the right; how many they are. None if the set is to be a leaf.
    #[inline(never)]
    fn divide(&self, task: &mut Task<'_>) -> Option<[usize; 2]> {
        let count = task.count;
        let block = 1 << self.block;
        let sorted = (self.options.sorted as usize).min(sweep::MOST);
        if count <= 1 || (count <= block && sorted == 0) {
            return None;
        }
        let scale = task.extent.hull.scale();
        let most = u32::try_from((block as u64) << (task.levels - 1).min(32)).unwrap_or(u32::MAX);
        let rules = Rules { scale, block: self.block, most };
        let whole = task.extent.hull.weight(scale);
        let pays = |cost: f32| count > block || cost + whole * self.options.step_cost < whole;
        let halves = [count / 2, count - count / 2];
        let (cost, parts, cut) = if count <= sorted {
            match sweep::divide(&mut task.items[..count], task.spare, &rules) {
                Some((left, cost)) => {
                    let (items, others) = task.items[..count].split_at(left);
                    (cost, [Extent::of(items).hull, Extent::of(others).hull], Err(left))
                }
                None => return (count > block).then_some(halves),
            }
        } else {
            let items = &task.items[..count];
            let grid = Grid::new(task.extent.middles, (4 + count / 16).min(self.options.bins as usize));
            let bins = match count > SHARED {
                true => {
                    let chunks = items.par_chunks(CHUNK).map(|chunk| Bins::of(chunk, &grid));
                    chunks.reduce_with(|bins, other| bins.merge(&other))?
                }
                false => Bins::of(items, &grid),
            };
            match bins.cheapest(&grid, &rules) {
                Some(cut) => (cut.cost, bins.parts(&cut), Ok(cut)),
                None => return (count > block).then_some(halves),
            }
        };
        if let Some(plane) = self.plane(task, &rules, parts, cost)
            && pays(plane.cost)
        {
            let parts = plane.divide(task.items, task.spare, count, (self.primitives, &rules));
            if parts[0] > 0 && parts[1] > 0 && parts[0] as u32 <= most && parts[1] as u32 <= most {
                return Some(parts);
            }
            return Some([(parts[0] + parts[1]) / 2, (parts[0] + parts[1]).div_ceil(2)]);
        }
        if !pays(cost) {
            return None;
        }
        let (items, spare) = (&mut task.items[..count], &mut task.spare[..count]);
        let left = match cut {
            Err(left) => left,
            Ok(cut) if count > SHARED => {
                let left = partition_parallel(items, spare, &cut);
                mem::swap(&mut task.items, &mut task.spare);
                left
            }
            Ok(cut) => partition(items, spare, &cut),
        };
        Some([left, count - left])
    }

    /// A plane that divides a set for less than `least`, if there is room to cut and its `parts` would overlap otherwise.
    fn plane(&self, task: &Task<'_>, rules: &Rules, parts: [Hull; 2], least: f32) -> Option<Plane> {
        let room = (task.items.len() - task.count) as u32;
        let common = parts[0].intersection(parts[1]);
        let scale = self.whole.scale();
        if room == 0 || common.is_empty() || common.weight(scale) < super::tune(1) * self.whole.weight(scale) {
            return None;
        }
        if task.count as f32 > super::tune(3) || (task.count as f32) < super::tune(4) { return None; }
        let items = &task.items[..task.count];
        let cells = Cells::new(task.extent.hull);
        let parts = match items.len() > SHARED {
            true => {
                let chunks = items.par_chunks(CHUNK).map(|chunk| Parts::of(chunk, &cells, self.primitives));
                chunks.reduce_with(|parts, other| parts.merge(&other))?
            }
            false => Parts::of(items, &cells, self.primitives),
        };
        parts.cheapest(&cells, rules, least * super::tune(2), items.len() as u32, room)
    }
}
