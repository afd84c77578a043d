use std::mem;

use rayon::prelude::*;

use super::{
    item::{Extent, Item},
    partition::CHUNK,
};

/// Sets of more items are divided by all threads together.
pub(super) const SHARED: usize = 4 * CHUNK;

/// A set of items.
pub(super) struct Task<'t> {
    /// The items, and room for those that cuts add.
    pub(super) items: &'t mut [Item],
    pub(super) count: usize,
    /// As long.
    pub(super) spare: &'t mut [Item],
    pub(super) extent: Extent,
    /// How often it may be divided.
    pub(super) levels: u32,
}

/// How the items of a task were divided: the left ones stand at the beginning, the right ones at [`Task::border`] of the
/// spare places.
pub(super) struct Parts {
    pub(super) counts: [usize; 2],
    /// Whether the left ones, too, stand in the spare places.
    pub(super) is_moved: bool,
    /// The extents, if they are known.
    pub(super) extents: Option<[Extent; 2]>,
}

impl<'t> Task<'t> {
    /// Where the right part of so many items gets its places: each part has a share of the room.
    pub(super) fn border(&self, [left, right]: [usize; 2]) -> usize {
        let room = self.items.len() - (left + right);
        left + (room as u64 * left as u64 / (left + right) as u64) as usize
    }

    /// The parts.
    pub(super) fn split(mut self, parts: &Parts) -> [Self; 2] {
        let [left, right] = parts.counts;
        let border = self.border(parts.counts);
        if parts.is_moved {
            mem::swap(&mut self.items, &mut self.spare);
        }
        let (items, others) = self.items.split_at_mut(border);
        let (spare, rights) = self.spare.split_at_mut(border);
        let (others, rights) = if parts.is_moved { (others, rights) } else { (rights, others) };
        let extents = parts.extents.unwrap_or_else(|| [extent(&items[..left]), extent(&others[..right])]);
        let levels = self.levels.saturating_sub(1);
        [
            Self { items, count: left, spare, extent: extents[0], levels },
            Self { items: others, count: right, spare: rights, extent: extents[1], levels },
        ]
    }
}

/// The extent of items, on all threads if they are many.
pub(super) fn extent(items: &[Item]) -> Extent {
    if items.len() <= SHARED {
        return Extent::of(items);
    }
    items.par_chunks(CHUNK).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union)
}
