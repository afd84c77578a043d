//! Sets divided in space, what lies on both sides cut in two: Stich, Friedrich and Dietrich, *Spatial splits in bounding
//! volume hierarchies*, 2009.

use glam::Vec4;

use super::{
    bins::{ROUND, Rules},
    item::Item,
};
use crate::{primitives::Primitives, wide::hull::Hull};

/// Bins per axis.
const BINS: usize = 16;

/// Where the bins of a set are.
#[derive(Clone, Copy)]
pub(super) struct Cells {
    origin: Vec4,
    /// Lengths of bins, and their reciprocals; 0 where there is no length.
    step: Vec4,
    scale: Vec4,
}

impl Cells {
    /// Bins over `hull`.
    pub(super) fn new(hull: Hull) -> Self {
        let scale = Vec4::splat(BINS as f32) / hull.size();
        let is_sound = scale.is_finite_mask() & scale.cmpgt(Vec4::ZERO);
        let step = hull.size() / BINS as f32;
        Self { origin: hull.low, step, scale: Vec4::select(is_sound, scale, Vec4::ZERO) }
    }

    /// By axis, the bin of a point.
    #[inline(always)]
    fn of(&self, point: Vec4) -> [usize; 4] {
        let rounded = (point - self.origin) * self.scale - Vec4::splat(0.5) + Vec4::splat(ROUND);
        let bits: [u32; 4] = bytemuck::must_cast(rounded);
        bits.map(|bits| (bits as usize % 32).min(BINS - 1))
    }

    /// The bins in which an item begins and ends; if it cannot be cut, where its middle is.
    #[inline(always)]
    fn span(&self, item: &Item, is_whole: bool) -> [[usize; 4]; 2] {
        let hull = item.hull();
        if is_whole {
            [self.of(hull.middle() * 0.5); 2]
        } else {
            [hull.low, Vec4::ZERO - hull.high].map(|point| self.of(point))
        }
    }

    /// Where a bin begins.
    fn border(&self, axis: usize, bin: usize) -> f32 {
        self.origin[axis] + self.step[axis] * bin as f32
    }
}

/// The parts of items in each of the bins, and how many items begin and end there.
#[derive(Clone)]
pub(super) struct Spread {
    hulls: [[Hull; BINS]; 3],
    begin: [[u32; BINS]; 3],
    end: [[u32; BINS]; 3],
}

impl Spread {
    /// Of `items`, of which some can be had in one piece only.
    ///
    /// Where an item is cut its box is, too: boxes of the cut triangles take ten times as long and lead to the same planes.
    #[inline(never)]
    pub(super) fn of(items: &[Item], cells: &Cells, is_whole: impl Fn(u32) -> bool) -> Self {
        let counts = [[0; BINS]; 3];
        let mut spread = Self { hulls: [[Hull::EMPTY; BINS]; 3], begin: counts, end: counts };
        for item in items {
            let [begin, end] = cells.span(item, is_whole(item.number()));
            for axis in 0..3 {
                let (begin, end) = (begin[axis], end[axis]);
                spread.begin[axis][begin] += 1;
                spread.end[axis][end] += 1;
                let hulls = &mut spread.hulls[axis];
                if begin >= end {
                    hulls[begin] = hulls[begin].union(item.hull());
                    continue;
                }
                for (bin, hull) in hulls.iter_mut().enumerate().take(end + 1).skip(begin) {
                    let mut part = item.hull();
                    if bin > begin {
                        part = part.above(axis, cells.border(axis, bin));
                    }
                    if bin < end {
                        part = part.below(axis, cells.border(axis, bin + 1));
                    }
                    *hull = hull.union(part);
                }
            }
        }
        spread
    }

    /// Of both sets, in the same bins.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.hulls[axis][bin] = self.hulls[axis][bin].union(other.hulls[axis][bin]);
                self.begin[axis][bin] += other.begin[axis][bin];
                self.end[axis][bin] += other.end[axis][bin];
            }
        }
        self
    }

    /// The plane at which dividing `count` items costs least, and less than `least`, with at most `room` of them cut.
    pub(super) fn cheapest(
        &self,
        cells: &Cells,
        rules: &Rules,
        mut least: f32,
        count: u32,
        room: u32,
    ) -> Option<Plane> {
        let mut best = None;
        for axis in 0..3 {
            if cells.scale[axis] == 0.0 {
                continue;
            }
            let (hulls, begin, end) = (&self.hulls[axis], &self.begin[axis], &self.end[axis]);
            let mut behind = [(Hull::EMPTY, 0); BINS];
            let (mut hull, mut items) = (Hull::EMPTY, 0);
            for bin in (1..BINS).rev() {
                hull = hull.union(hulls[bin]);
                items += end[bin];
                behind[bin] = (hull, items);
            }
            let (mut hull, mut items) = (Hull::EMPTY, 0);
            for border in 1..BINS {
                hull = hull.union(hulls[border - 1]);
                items += begin[border - 1];
                let (other, others) = behind[border];
                let cost = rules.cost(hull, items) + rules.cost(other, others);
                let parts = items < count && others < count && items + others <= count + room;
                if cost < least && parts && rules.allow(items, others) {
                    least = cost;
                    let position = cells.border(axis, border);
                    best = Some(Plane { axis, position, cost, hulls: [hull, other], counts: [items, others] });
                }
            }
        }
        best
    }
}

/// A plane that divides a set, and what is expected of its parts.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    axis: usize,
    position: f32,
    /// What both parts cost.
    pub(super) cost: f32,
    hulls: [Hull; 2],
    counts: [u32; 2],
}

/// Where an item goes.
enum Side {
    Left(Item),
    Right(Item),
    Both(Item, Item),
}

impl Plane {
    /// Divides the first `count` of `items`, with at most as many cuts as there are places behind them: the left ones are put
    /// first, the right ones to the front of `spare`; how many there are.
    #[inline(never)]
    pub(super) fn divide<P: Primitives + ?Sized>(
        &self,
        items: &mut [Item],
        spare: &mut [Item],
        count: usize,
        (primitives, rules): (&P, &Rules),
    ) -> [usize; 2] {
        let (mut left, mut right) = (0, 0);
        let mut room = items.len() - count;
        for index in 0..count {
            let side = self.side(&items[index], primitives, rules, room > 0);
            if let Side::Left(item) | Side::Both(item, _) = side {
                items[left] = item;
                left += 1;
            }
            if let Side::Right(item) | Side::Both(_, item) = side {
                spare[right] = item;
                right += 1;
            }
            room -= usize::from(matches!(side, Side::Both(..)));
        }
        [left, right]
    }

    /// Where an item goes; in one piece unless `may_cut`.
    fn side<P: Primitives + ?Sized>(&self, item: &Item, primitives: &P, rules: &Rules, may_cut: bool) -> Side {
        let hull = item.hull();
        let (min, max) = (hull.low[self.axis], 0.0 - hull.high[self.axis]);
        if max <= self.position {
            return Side::Left(*item);
        }
        if min >= self.position {
            return Side::Right(*item);
        }
        let number = item.number();
        if !may_cut || !primitives.is_certified(number) {
            return if min * 0.5 + max * 0.5 < self.position { Side::Left(*item) } else { Side::Right(*item) };
        }
        let part = |cell: Hull| primitives.clip(number, &cell.bounds()).map(|part| Item::new(&part, number));
        let parts = (part(hull.below(self.axis, self.position)), part(hull.above(self.axis, self.position)));
        match parts {
            (Some(left), Some(right)) => {
                // In one piece, if what that adds to a side costs less than a second reference.
                let ([a, b], [n, m]) = (self.hulls, self.counts);
                let both = rules.linear(a, n) + rules.linear(b, m);
                let only_left = rules.linear(a.union(hull), n) + rules.linear(b, m.saturating_sub(1));
                let only_right = rules.linear(a, n.saturating_sub(1)) + rules.linear(b.union(hull), m);
                if only_left <= both && only_left <= only_right {
                    Side::Left(*item)
                } else if only_right <= both {
                    Side::Right(*item)
                } else {
                    Side::Both(left, right)
                }
            }
            (Some(left), None) => Side::Left(left),
            (None, Some(right)) => Side::Right(right),
            // There is nothing of it to be hit here, but no reference may be lost.
            (None, None) => Side::Left(*item),
        }
    }
}
