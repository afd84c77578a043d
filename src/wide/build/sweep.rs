use super::{bins::Rules, item::Item};
use crate::wide::hull::Hull;

/// The most items that are sorted.
pub(super) const MOST: usize = 16;

/// Items by their middles along an axis.
type Order = [u64; MOST];

/// A division of a small set between two neighbours along an axis.
pub(super) struct Sorted {
    order: Order,
    /// How many items are before it.
    pub(super) left: usize,
    /// What both parts cost.
    pub(super) cost: f32,
    /// Their boxes.
    pub(super) hulls: [Hull; 2],
}

impl Sorted {
    /// The one that costs least, of at most [`MOST`] items.
    pub(super) fn best(items: &[Item], rules: &Rules) -> Option<Self> {
        let mut best: Option<Self> = None;
        let mut least = f32::INFINITY;
        for axis in 0..3 {
            let order = sort(items, axis);
            let item = |place: usize| items[(order[place] as u32) as usize].hull();
            // What the parts behind each place cost; then the parts before it.
            let mut behind = [(0.0, Hull::EMPTY); MOST];
            let mut hull = Hull::EMPTY;
            for place in (1..items.len()).rev() {
                hull = hull.union(item(place));
                behind[place] = (rules.cost(hull, (items.len() - place) as u32), hull);
            }
            let mut hull = Hull::EMPTY;
            let mut found = None;
            for (left, behind) in behind.iter().enumerate().take(items.len()).skip(1) {
                hull = hull.union(item(left - 1));
                let cost = rules.cost(hull, left as u32) + behind.0;
                if cost < least && rules.allow(left as u32, (items.len() - left) as u32) {
                    least = cost;
                    found = Some((left, hull));
                }
            }
            if let Some((left, hull)) = found {
                best = Some(Self { order, left, cost: least, hulls: [hull, behind[left].1] });
            }
        }
        best
    }

    /// Puts the left items first, the right ones into `rights`.
    pub(super) fn place(&self, items: &mut [Item], rights: &mut [Item]) {
        let mut old = [Item::NOTHING; MOST];
        old[..items.len()].copy_from_slice(items);
        let new = self.order.iter().map(|&key| old[(key as u32) as usize % MOST]);
        for (place, item) in items[..self.left].iter_mut().chain(rights).zip(new) {
            *place = item;
        }
    }
}

/// The order of the middles along an axis; equal ones as they stand.
fn sort(items: &[Item], axis: usize) -> Order {
    let mut order = [u64::MAX; MOST];
    for (index, (key, item)) in order.iter_mut().zip(items).enumerate() {
        let bits = item.hull().middle().to_array()[axis].to_bits();
        // As whole numbers, negative ones run backwards and above the others.
        let rank = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
        *key = u64::from(rank) << 32 | index as u64;
    }
    order[..items.len()].sort_unstable();
    order
}
