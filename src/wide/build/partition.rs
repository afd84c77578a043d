//! Items brought to either side of a cut, in the order in which they stood.

use rayon::prelude::*;
use std::vec::Vec;

use super::{bins::Cut, item::Item};

/// Items that a thread takes at a time.
pub(super) const CHUNK: usize = 16_384;

/// Puts the items before the cut first; how many they are.
pub(super) fn partition(items: &mut [Item], spare: &mut [Item], cut: &Cut) -> usize {
    let (mut left, mut right) = (0, 0);
    for index in 0..items.len() {
        let item = items[index];
        let is_left = cut.is_left(&item);
        // Both places are free: without a branch that nothing could predict.
        items[left] = item;
        spare[right] = item;
        left += usize::from(is_left);
        right += usize::from(!is_left);
    }
    items[left..].copy_from_slice(&spare[..right]);
    left
}

/// As [`partition`], on all threads, from `items` into `spare`.
pub(super) fn partition_parallel(items: &[Item], spare: &mut [Item], cut: &Cut) -> usize {
    let chunks = items.par_chunks(CHUNK);
    let counts: Vec<usize> = chunks.map(|chunk| chunk.iter().filter(|item| cut.is_left(item)).count()).collect();
    let total = counts.iter().sum();
    let (mut lefts, mut rights) = spare.split_at_mut(total);
    let mut places = Vec::with_capacity(counts.len());
    for (chunk, &count) in items.chunks(CHUNK).zip(&counts) {
        let (left, rest) = lefts.split_at_mut(count);
        let (right, others) = rights.split_at_mut(chunk.len() - count);
        (lefts, rights) = (rest, others);
        places.push((chunk, left, right));
    }
    places.into_par_iter().for_each(|(chunk, left, right)| {
        let (mut left, mut right) = (left.iter_mut(), right.iter_mut());
        for item in chunk {
            let place = if cut.is_left(item) { left.next() } else { right.next() };
            if let Some(place) = place {
                *place = *item;
            }
        }
    });
    total
}
