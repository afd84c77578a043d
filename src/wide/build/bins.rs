//! Sets divided at the borders of bins: Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007.

use glam::Vec4;

use super::item::Item;
use crate::wide::hull::Hull;

/// The most bins per axis.
pub(super) const MOST: usize = 32;

/// Added to a small number, rounds it to a whole one that stands in the last bits.
pub(super) const ROUND: f32 = 12_582_912.0; // 1.5 * 2^23

/// Where the bins of a set are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: Vec4,
    scale: Vec4,
    count: usize,
}

impl Grid {
    /// `count` bins per axis over twice the middles within `middles`; all in the first where it has no length.
    pub(super) fn new(middles: Hull, count: usize) -> Self {
        let count = count.clamp(2, MOST);
        let scale = Vec4::splat((count - 1) as f32) / middles.size();
        let is_sound = scale.is_finite_mask() & scale.cmpgt(Vec4::ZERO);
        Self { origin: middles.low, scale: Vec4::select(is_sound, scale, Vec4::ZERO), count }
    }

    /// By axis, the bin plus [`ROUND`].
    #[inline(always)]
    fn rounded(&self, item: &Item) -> Vec4 {
        (item.hull().middle() - self.origin) * self.scale + Vec4::splat(ROUND)
    }
}

/// What has its middle in each of at most `N` bins.
#[derive(Clone)]
pub(super) struct Bins<const N: usize> {
    hulls: [[Hull; N]; 3],
    counts: [[u32; N]; 3],
}

impl<const N: usize> Bins<N> {
    /// Of nothing.
    pub(super) const EMPTY: Self = Self { hulls: [[Hull::EMPTY; N]; 3], counts: [[0; N]; 3] };

    /// Of `items`, in the bins of `grid`.
    #[inline]
    pub(super) fn of(items: &[Item], grid: &Grid) -> Self {
        let mut bins = Self::EMPTY;
        for item in items {
            let places: [u32; 4] = bytemuck::must_cast(grid.rounded(item));
            for ((hulls, counts), place) in bins.hulls.iter_mut().zip(&mut bins.counts).zip(places) {
                let place = place as usize % N;
                hulls[place] = hulls[place].union(item.hull());
                counts[place] += 1;
            }
        }
        bins
    }

    /// Of both sets, in the same bins.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for (hull, other) in self.hulls[axis].iter_mut().zip(&other.hulls[axis]) {
                *hull = hull.union(*other);
            }
            for (count, other) in self.counts[axis].iter_mut().zip(&other.counts[axis]) {
                *count += other;
            }
        }
        self
    }

    /// How many items are before a border.
    pub(super) fn before(&self, cut: &Cut) -> u32 {
        self.counts[cut.axis].iter().take((cut.border - ROUND) as usize).sum()
    }

    /// The boxes before and behind a border.
    pub(super) fn parts(&self, cut: &Cut) -> [Hull; 2] {
        let (before, behind) = self.hulls[cut.axis].split_at((cut.border - ROUND) as usize);
        [before, behind].map(|hulls| hulls.iter().fold(Hull::EMPTY, |all, hull| all.union(*hull)))
    }

    /// The border at which dividing costs least.
    #[inline]
    pub(super) fn cheapest(&self, grid: &Grid, rules: &Rules) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        let mut least = f32::INFINITY;
        for axis in 0..3 {
            if grid.scale[axis] == 0.0 {
                continue;
            }
            let (hulls, counts) = (&self.hulls[axis], &self.counts[axis]);
            // What the parts behind each border cost; then the parts before it.
            let mut behind = [(0.0, 0); N];
            let (mut hull, mut count) = (Hull::EMPTY, 0);
            for bin in (1..grid.count.min(N)).rev() {
                hull = hull.union(hulls[bin % N]);
                count += counts[bin % N];
                behind[bin % N] = (rules.cost(hull, count), count);
            }
            let (mut hull, mut count) = (Hull::EMPTY, 0);
            for border in 1..grid.count.min(N) {
                hull = hull.union(hulls[(border - 1) % N]);
                count += counts[(border - 1) % N];
                let (other, right) = behind[border % N];
                let cost = rules.cost(hull, count) + other;
                if cost < least && rules.allow(count, right) {
                    least = cost;
                    best = Some(Cut { grid: *grid, axis, left: count, border: ROUND + border as f32, cost });
                }
            }
        }
        best
    }
}

/// What divisions of a set cost, and which are allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// What makes the set's longest edge a length of 1.
    pub(super) scale: f32,
    /// Binary logarithm of the items that are tested at once.
    pub(super) leaf: u32,
    /// The most items that a part may have, so that it can be divided further within the depth.
    pub(super) most: u32,
}

impl Rules {
    /// Of a leaf with so many items in `hull`: one test for each full leaf.
    #[inline(always)]
    pub(super) fn cost(&self, hull: Hull, count: u32) -> f32 {
        let tests = (count + (1 << self.leaf) - 1) >> self.leaf;
        hull.weight(self.scale) * tests as f32
    }

    /// The same, had each item its own test.
    #[inline(always)]
    pub(super) fn linear(&self, hull: Hull, count: u32) -> f32 {
        hull.weight(self.scale) * count as f32
    }

    /// Whether parts may have so many items.
    #[inline(always)]
    pub(super) fn allow(&self, left: u32, right: u32) -> bool {
        left > 0 && right > 0 && left <= self.most && right <= self.most
    }
}

/// A border between bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    grid: Grid,
    axis: usize,
    /// Items before it.
    pub(super) left: u32,
    /// The first bin behind it, plus [`ROUND`].
    border: f32,
    /// What both parts cost.
    pub(super) cost: f32,
}

impl Cut {
    /// Whether an item goes before it.
    #[inline(always)]
    pub(super) fn is_left(&self, item: &Item) -> bool {
        let mask = self.grid.rounded(item).cmplt(Vec4::splat(self.border)).bitmask();
        mask >> self.axis & 1 != 0
    }
}
