//! Where to divide a range of blocks, and what empty space to cut off: integers per block, floats per axis.

use super::block::{Block, Face};
use crate::{
    accel::sort::sort,
    geometry::{Aabb, Axis},
};

/// What is to be known of a range of blocks before it is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Survey {
    /// The block around all.
    pub(super) tight: Block,
    /// The least of all [middles](Block::middle) by axis.
    low: [u32; 3],
    /// The greatest of all middles by axis.
    high: [u32; 3],
}

impl Survey {
    /// Of all of `blocks`.
    pub(super) fn of(blocks: &[Block]) -> Self {
        let mut survey = Self { tight: Block::EMPTY, low: [u32::MAX; 3], high: [0; 3] };
        for block in blocks {
            survey.tight = survey.tight.union(block);
            for axis in Axis::ALL {
                let (low, high) = (&mut survey.low[axis as usize], &mut survey.high[axis as usize]);
                let middle = block.middle(axis);
                *low = middle.min(*low);
                *high = middle.max(*high);
            }
        }
        survey
    }
}

/// What the surface area heuristic weighs by: how likely a ray is to meet a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric {
    /// The length of a step by axis, the largest side of the lattice being 1. Along none it is nothing, so that blocks
    /// without surface have chances, too.
    step: [f32; 3],
    /// The surface that a primitive is worth because rays begin there.
    begin: f32,
    /// What testing a primitive costs, in steps through a node.
    pub(super) intersection_cost: f32,
}

/// Rays that begin at a surface within the lattice, over those that come from outside.
const BEGIN: f32 = 0.1;

impl Metric {
    /// Over so many primitives in a valid box.
    pub(super) fn new(bounds: &Aabb, primitives: u32, intersection_cost: f32) -> Self {
        let size = bounds.size();
        let largest = Axis::of_largest(size).of(size);
        let largest = if largest > f32::MIN_POSITIVE { largest } else { f32::MIN_POSITIVE };
        let step = Axis::ALL.map(|axis| (axis.of(size) / largest + 1.0e-6) / Block::LAST as f32);
        let metric = Self { step, begin: 0.0, intersection_cost };
        Self { begin: BEGIN * metric.half_area(&Block::WHOLE) / primitives as f32, ..metric }
    }

    /// So many steps along an axis.
    #[inline(always)]
    fn length(&self, steps: u32, axis: Axis) -> f32 {
        steps as i32 as f32 * self.step[axis as usize]
    }

    /// Half the surface of a block.
    pub(super) fn half_area(&self, block: &Block) -> f32 {
        half_area(Axis::ALL.map(|axis| self.length(block.length(axis), axis)))
    }

    /// Half the surface of a block, in two parts: that of the faces across an axis, and that of the others.
    pub(super) fn sides(&self, block: &Block, axis: Axis) -> (f32, f32) {
        let [x, y, z] = Axis::ALL.map(|axis| self.length(block.length(axis), axis));
        match axis {
            Axis::X => (y * z, x * (y + z)),
            Axis::Y => (z * x, y * (z + x)),
            Axis::Z => (x * y, z * (x + y)),
        }
    }

    /// What is left of half the surface of `implied` if a carve cuts off what is outside of `tight` at two faces, and these.
    fn carved(&self, implied: &Block, tight: &Block) -> (f32, [Face; 2]) {
        // By axis: the length as it is, without the longer of two gaps, and without both.
        let [x, y, z] = Axis::ALL.map(|axis| {
            let low = tight.min(axis).saturating_sub(implied.min(axis));
            let high = implied.max(axis).saturating_sub(tight.max(axis));
            let whole = implied.length(axis);
            let lengths = [whole, whole.saturating_sub(low.max(high)), whole.saturating_sub(low + high)];
            (lengths.map(|steps| self.length(steps, axis)), Face { axis, upper: high > low })
        });
        let ([x, x_one, x_both], x_face) = x;
        let ([y, y_one, y_both], y_face) = y;
        let ([z, z_one, z_both], z_face) = z;
        let both = |axis| [Face { axis, upper: true }, Face { axis, upper: false }];
        let ways = [
            ([x_both, y, z], both(Axis::X)),
            ([x, y_both, z], both(Axis::Y)),
            ([x, y, z_both], both(Axis::Z)),
            ([x_one, y_one, z], [x_face, y_face]),
            ([x, y_one, z_one], [y_face, z_face]),
            ([x_one, y, z_one], [x_face, z_face]),
        ];
        let mut best = (f32::INFINITY, both(Axis::X));
        for (size, faces) in ways {
            let area = half_area(size);
            if area < best.0 {
                best = (area, faces);
            }
        }
        best
    }

    /// How much work `count` primitives within `tight` are expected to be as a child, carved if that pays.
    fn work(&self, implied: &Block, tight: &Block, count: u32) -> f32 {
        let area = self.half_area(implied);
        let (carved, _) = self.carved(implied, tight);
        let (tests, node) = (count as i32 as f32, 1.0 / self.intersection_cost);
        let (plain, carved) = (area * tests, area * node + carved * tests);
        (if carved < plain { carved } else { plain }) + self.begin * tests * tests
    }
}

/// Half the surface of a box of this size.
#[inline(always)]
fn half_area([x, y, z]: [f32; 3]) -> f32 {
    x * y + (x + y) * z
}

/// Bins along an axis; as many blocks or fewer have one each.
const BINS: usize = 64;

/// What fell into a bin.
#[derive(Clone, Copy, Debug)]
struct Bin {
    count: u32,
    /// The greatest middle.
    high: u32,
    /// The block around it.
    tight: Block,
}

impl Bin {
    const EMPTY: Self = Self { count: 0, high: 0, tight: Block::EMPTY };

    /// A single block.
    #[inline(always)]
    const fn of(block: &Block, axis: Axis) -> Self {
        Self { count: 1, high: block.middle(axis), tight: *block }
    }

    #[inline(always)]
    fn union(self, other: &Self) -> Self {
        let (count, high) = (self.count + other.count, self.high.max(other.high));
        Self { count, high, tight: self.tight.union(&other.tight) }
    }
}

/// Sorts blocks into bins by their middles, of which there are several.
fn fill(bins: &mut [Bin; BINS], blocks: &[Block], low: u32, range: u32, axis: Axis) {
    if blocks.len() <= BINS {
        let (mut keys, mut scratch) = ([0; BINS], [0; BINS]);
        for ((index, block), key) in (0..).zip(blocks).zip(&mut keys) {
            *key = block.middle(axis) * BINS as u32 + index;
        }
        let keys = keys.get_mut(..blocks.len()).unwrap_or_default();
        sort(keys, &mut scratch);
        for (key, bin) in keys.iter().zip(bins) {
            if let Some(block) = blocks.get(*key as usize % BINS) {
                *bin = Bin::of(block, axis);
            }
        }
    } else {
        // Rounded down, so that the greatest middle falls into the last bin at most.
        let scale = ((BINS as u32) << 16).checked_div(range + 1).unwrap_or(0);
        for block in blocks {
            let bin = (block.middle(axis).wrapping_sub(low).wrapping_mul(scale) >> 16) as usize;
            if let Some(bin) = bins.get_mut(bin) {
                *bin = bin.union(&Bin::of(block, axis));
            }
        }
    }
}

/// A way to divide a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// The axis along which it divides.
    pub(super) axis: Axis,
    /// The greatest middle that goes left.
    last: u32,
    /// How many go left.
    pub(super) left: u32,
    /// Where the left child ends.
    pub(super) left_max: u32,
    /// Where the right child begins.
    pub(super) right_min: u32,
    /// How many primitives a ray through the block is expected to meet below.
    pub(super) work: f32,
}

impl Cut {
    /// Whether a block of the range goes left.
    #[inline(always)]
    pub(super) fn is_left(&self, block: &Block) -> bool {
        block.middle(self.axis) <= self.last
    }
}

/// The cheapest way to divide `blocks` by their middles into two parts of at most `most`, if there is one.
pub(super) fn choose(blocks: &[Block], survey: &Survey, implied: &Block, metric: &Metric, most: u32) -> Option<Cut> {
    let mut best: Option<Cut> = None;
    for axis in Axis::ALL {
        let (low, high) = (survey.low[axis as usize], survey.high[axis as usize]);
        if low >= high {
            continue;
        }
        let mut bins = [Bin::EMPTY; BINS];
        fill(&mut bins, blocks, low, high - low, axis);
        // What lies in each bin and behind it.
        let mut behind = [Bin::EMPTY; BINS];
        let mut all = Bin::EMPTY;
        for (bin, behind) in bins.iter().zip(&mut behind).rev() {
            all = all.union(bin);
            *behind = all;
        }
        let mut before = Bin::EMPTY;
        for (index, bin) in bins.iter().enumerate() {
            // Behind an empty bin it is as before it, and equal middles stay together.
            let (Some(next), Some(behind)) = (bins.get(index + 1), behind.get(index + 1)) else { break };
            before = before.union(bin);
            let together = bin.count == 0 || behind.count == 0 || (next.count > 0 && next.high == bin.high);
            if together || before.count > most || behind.count > most {
                continue;
            }
            let (left_max, right_min) = (before.tight.max(axis), behind.tight.min(axis));
            let left = implied.between(axis, implied.min(axis), left_max);
            let right = implied.between(axis, right_min, implied.max(axis));
            let work =
                metric.work(&left, &before.tight, before.count) + metric.work(&right, &behind.tight, behind.count);
            if best.is_none_or(|best| work < best.work) {
                best = Some(Cut { axis, last: bin.high, left: before.count, left_max, right_min, work });
            }
        }
    }
    let whole = metric.half_area(implied);
    best.map(|best| Cut { work: best.work / whole, ..best })
}

/// The two faces at which to cut off empty space, and what is left, if that is worth a node.
///
/// `count` primitives are within `tight`; it must pay `threshold` times over.
pub(super) fn carve(
    tight: &Block,
    implied: &Block,
    metric: &Metric,
    count: u32,
    threshold: f32,
) -> Option<([Face; 2], Block)> {
    let before = metric.half_area(implied);
    let (after, faces) = metric.carved(implied, tight);
    // What a ray is spared that does not get through; below, most of a large range is not visited anyway.
    let spared = 1.0 + metric.intersection_cost * count.min(10) as f32;
    let carved = || faces.into_iter().fold(*implied, |block, face| block.cut(face, tight.plane(face)));
    ((before - after) * spared > threshold * before).then(|| (faces, carved()))
}
