//! Items brought to either side of a cut, in the order in which they stood.

use std::vec::Vec;

use rayon::prelude::*;

use super::{
    bins::Cut,
    item::{Extent, Item},
};

/// Items that a thread takes at a time.
pub(super) const CHUNK: usize = 16_384;

/// Moves the items before the cut to the front, those behind it to the front of `rights`.
pub(super) fn partition(items: &mut [Item], rights: &mut [Item], cut: &Cut) {
    let (mut left, mut right) = (0, 0);
    for index in 0..items.len() {
        let item = items[index];
        let is_left = cut.is_left(&item);
        // The place on the left is free, and beyond the end of the right one nothing is lost: without a branch that
        // nothing could predict.
        items[left] = item;
        if let Some(place) = rights.get_mut(right) {
            *place = item;
        }
        left += usize::from(is_left);
        right += usize::from(!is_left);
    }
}

/// As [`partition`], on all threads and out of place, knowing how many of each chunk are before the cut; the extents of
/// both sides.
pub(super) fn partition_parallel(
    items: &[Item],
    [mut lefts, mut rights]: [&mut [Item]; 2],
    counts: &[u32],
    cut: &Cut,
) -> [Extent; 2] {
    let mut places = Vec::with_capacity(counts.len());
    for (chunk, &count) in items.chunks(CHUNK).zip(counts) {
        let (left, rest) = lefts.split_at_mut(count as usize);
        let (right, others) = rights.split_at_mut(chunk.len() - count as usize);
        (lefts, rights) = (rest, others);
        places.push((chunk, left, right));
    }
    let extents = places.into_par_iter().map(|(chunk, left, right)| {
        let (mut left_places, mut right_places) = (left.iter_mut(), right.iter_mut());
        for item in chunk {
            let place = if cut.is_left(item) { left_places.next() } else { right_places.next() };
            if let Some(place) = place {
                *place = *item;
            }
        }
        [Extent::of(left), Extent::of(right)]
    });
    extents.reduce(|| [Extent::EMPTY; 2], |[a, b], [c, d]| [a.union(c), b.union(d)])
}
