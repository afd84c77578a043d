//! Sets divided at the borders of bins: Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007.

use glam::Vec4;

use super::{LEAF, item::Item};
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

/// What has its middle in each of at most `N` bins, by axis.
#[derive(Clone)]
pub(super) struct Bins<const N: usize> {
    hulls: [[Hull; 3]; N],
    counts: [[u32; 4]; N],
}

impl<const N: usize> Bins<N> {
    /// Of nothing.
    pub(super) const EMPTY: Self = Self { hulls: [[Hull::EMPTY; 3]; N], counts: [[0; 4]; N] };

    /// Of `items`, in the bins of `grid`.
    #[inline]
    pub(super) fn of(items: &[Item], grid: &Grid) -> Self {
        let mut bins = Self::EMPTY;
        for item in items {
            let places: [u32; 4] = bytemuck::must_cast(grid.rounded(item));
            for (axis, place) in places.into_iter().enumerate().take(3) {
                let place = place as usize % N;
                let hull = &mut bins.hulls[place][axis];
                *hull = hull.union(item.hull());
                bins.counts[place][axis] += 1;
            }
        }
        bins
    }

    /// Of both sets, in the same bins.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for bin in 0..N {
            unite(&mut self.hulls[bin], &other.hulls[bin]);
            add(&mut self.counts[bin], &other.counts[bin]);
        }
        self
    }

    /// How many items are before a border.
    pub(super) fn before(&self, cut: &Cut) -> u32 {
        self.counts.iter().take(cut.bins()).map(|counts| counts[cut.axis]).sum()
    }

    /// The boxes before and behind a border.
    pub(super) fn parts(&self, cut: &Cut) -> [Hull; 2] {
        let (before, behind) = self.hulls.split_at(cut.bins());
        [before, behind].map(|hulls| hulls.iter().fold(Hull::EMPTY, |all, hulls| all.union(hulls[cut.axis])))
    }

    /// The border at which dividing costs least; the axes stand in lanes.
    #[inline]
    pub(super) fn cheapest(&self, grid: &Grid, rules: &Rules) -> Option<Cut> {
        let last = grid.count.min(N);
        // What the parts behind each border cost; then the parts before it.
        let mut behind = [Vec4::ZERO; N];
        let (mut hulls, mut counts) = ([Hull::EMPTY; 3], [0; 4]);
        for bin in (1..last).rev() {
            unite(&mut hulls, &self.hulls[bin % N]);
            add(&mut counts, &self.counts[bin % N]);
            behind[bin % N] = rules.costs(&hulls, &counts);
        }
        let (mut least, mut borders) = (Vec4::INFINITY, Vec4::ZERO);
        (hulls, counts) = ([Hull::EMPTY; 3], [0; 4]);
        for border in 1..last {
            unite(&mut hulls, &self.hulls[(border - 1) % N]);
            add(&mut counts, &self.counts[(border - 1) % N]);
            let cost = rules.costs(&hulls, &counts) + behind[border % N];
            // Never where a part is empty: its cost is not a number.
            let is_less = cost.cmplt(least);
            least = Vec4::select(is_less, cost, least);
            borders = Vec4::select(is_less, Vec4::splat(ROUND + border as f32), borders);
        }
        let [x, y, z, _] = least.to_array();
        let axis = if x <= y && x <= z { 0 } else { 1 + usize::from(z < y) };
        let cut = Cut { grid: *grid, axis, left: 0, border: borders[axis], cost: least[axis] };
        (cut.cost < f32::INFINITY).then(|| Cut { left: self.before(&cut), ..cut })
    }
}

/// Enlarges boxes by others.
#[inline(always)]
fn unite(hulls: &mut [Hull; 3], others: &[Hull; 3]) {
    for (hull, other) in hulls.iter_mut().zip(others) {
        *hull = hull.union(*other);
    }
}

/// Adds counts to counts.
#[inline(always)]
fn add(counts: &mut [u32; 4], others: &[u32; 4]) {
    for (count, other) in counts.iter_mut().zip(others) {
        *count += other;
    }
}

/// What divisions of a set cost, and which are allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// What makes the set's longest edge a length of 1.
    pub(super) scale: f32,
    /// The most items that a part may have, so that it can be divided further within the depth.
    pub(super) most: u32,
}

impl Rules {
    /// Of a leaf with so many items in `hull`: one test for each full leaf.
    #[inline(always)]
    pub(super) fn cost(&self, hull: Hull, count: u32) -> f32 {
        hull.weight(self.scale) * Self::tests(count)
    }

    /// As [`cost`](Self::cost), of three parts; no number if there are no items, and infinite if there are too many.
    #[inline(always)]
    fn costs(&self, hulls: &[Hull; 3], counts: &[u32; 4]) -> Vec4 {
        let tests = counts.map(|count| if count > self.most { f32::INFINITY } else { Self::tests(count) });
        Hull::weights(hulls, self.scale) * Vec4::from_array(tests)
    }

    /// How many full leaves there are at least.
    #[inline(always)]
    fn tests(count: u32) -> f32 {
        // As a signed number, which all machines convert at once.
        count.div_ceil(LEAF) as i32 as f32
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
    /// How many bins are before it.
    fn bins(&self) -> usize {
        (self.border - ROUND) as usize
    }

    /// Whether an item goes before it.
    #[inline(always)]
    pub(super) fn is_left(&self, item: &Item) -> bool {
        let mask = self.grid.rounded(item).cmplt(Vec4::splat(self.border)).bitmask();
        mask >> self.axis & 1 != 0
    }
}
