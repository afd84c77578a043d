use super::{bins::Rules, item::Item};
use crate::wide::hull::Hull;

/// The most items for which all ways are tried.
pub(super) const MOST: usize = 6;

/// The best of all ways to divide a small set.
pub(super) struct Few {
    /// A bit for each item that goes to the left.
    lefts: usize,
    /// What both parts cost.
    pub(super) cost: f32,
    /// Their boxes.
    pub(super) hulls: [Hull; 2],
}

impl Few {
    /// Of at most [`MOST`] items.
    pub(super) fn best(items: &[Item], rules: &Rules) -> Option<Self> {
        match items.len() {
            ..=2 => Self::of::<2, 4>(items, rules),
            3 => Self::of::<3, 8>(items, rules),
            4 => Self::of::<4, 16>(items, rules),
            5 => Self::of::<5, 32>(items, rules),
            _ => Self::of::<MOST, { 1 << MOST }>(items, rules),
        }
    }

    /// Of `N` items, of which there are `SETS` sets.
    fn of<const N: usize, const SETS: usize>(items: &[Item], rules: &Rules) -> Option<Self> {
        let items: &[Item; N] = items.try_into().ok()?;
        let (mut hulls, mut costs) = ([Hull::EMPTY; SETS], [0.0; SETS]);
        for set in 1..SETS {
            let last = set.ilog2() as usize;
            hulls[set] = hulls[set ^ 1 << last].union(items[last].hull());
            costs[set] = rules.cost(hulls[set], set.count_ones());
        }
        let mut best = None;
        let mut least = f32::INFINITY;
        // The last item is always on the right.
        for lefts in 1..SETS / 2 {
            let rights = SETS - 1 - lefts;
            let cost = costs[lefts] + costs[rights];
            if cost < least && rules.allow(lefts.count_ones(), rights.count_ones()) {
                least = cost;
                best = Some(Self { lefts, cost, hulls: [hulls[lefts], hulls[rights]] });
            }
        }
        best
    }

    /// How many items go to the left.
    pub(super) const fn left(&self) -> usize {
        self.lefts.count_ones() as usize
    }

    /// Puts the left items first, the right ones into `rights`.
    pub(super) fn place(&self, items: &mut [Item], rights: &mut [Item]) {
        let (mut left, mut rights) = (0, rights.iter_mut());
        for index in 0..items.len() {
            if self.lefts >> index & 1 != 0 {
                items[left] = items[index];
                left += 1;
            } else if let Some(place) = rights.next() {
                *place = items[index];
            }
        }
    }
}
