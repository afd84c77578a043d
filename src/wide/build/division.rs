use std::vec::Vec;

use super::{
    bins::{self, Bins, Cut, Rules},
    few::Few,
    partition::{partition, partition_parallel},
    spatial::Plane,
    task::{Parts, Task},
};
use crate::primitives::Primitives;

/// How to divide a set.
pub(super) enum Division {
    /// At a border between bins; and what is in them by chunk, if the set is large.
    Cut(Cut, Vec<Bins<{ bins::MOST }>>),
    /// As is best, because they are few.
    Few(Few),
    /// At a plane, which cuts what lies on both sides.
    Plane(Plane, Rules),
    /// As it stands, because nothing tells the items apart.
    Halves,
}

impl Division {
    /// Brings the items of `task` where they belong.
    pub(super) fn place<P: Primitives + ?Sized>(&self, task: &mut Task<'_>, primitives: &P) -> Parts {
        let count = task.count;
        let halves = |count: usize| [count / 2, count - count / 2];
        let mut parts = Parts { counts: halves(count), is_moved: false, extents: None };
        match self {
            Self::Cut(cut, _) => parts.counts = [cut.left as usize, count - cut.left as usize],
            Self::Few(few) => parts.counts = [few.left(), count - few.left()],
            Self::Plane(plane, rules) => {
                let counts = plane.divide(task.items, task.spare, count, (primitives, rules));
                let [left, right] = counts;
                if rules.allow(left as u32, right as u32) {
                    parts.counts = counts;
                    task.spare.copy_within(..right, task.border(counts));
                    return parts;
                }
                // Cuts may leave other numbers than expected.
                task.items[left..left + right].copy_from_slice(&task.spare[..right]);
                parts.counts = halves(left + right);
            }
            Self::Halves => {}
        }
        let [left, right] = parts.counts;
        let border = task.border(parts.counts);
        let (items, others) = (&mut task.items[..left + right], &mut task.spare[border..border + right]);
        match self {
            Self::Cut(cut, bins) if bins.is_empty() => partition(items, others, cut),
            Self::Cut(cut, bins) => {
                let counts: Vec<u32> = bins.iter().map(|bins| bins.before(cut)).collect();
                let (lefts, rights) = task.spare.split_at_mut(border);
                let sides = [&mut lefts[..left], &mut rights[..right]];
                parts.extents = Some(partition_parallel(items, sides, &counts, cut));
                parts.is_moved = true;
            }
            Self::Few(few) => few.place(items, others),
            Self::Plane(..) | Self::Halves => others.copy_from_slice(&items[left..]),
        }
        parts
    }
}
