use super::super::{block::Block, split::Metric};
use crate::geometry::{Aabb, Axis, Lattice};

/// Bins per axis: three bits tell them apart.
const BINS: usize = 8;

/// What has its middle in a part of an axis: how many, and from where to where.
#[derive(Clone, Copy, Debug)]
struct Bin {
    count: u32,
    min: f32,
    max: f32,
}

impl Bin {
    const EMPTY: Self = Self { count: 0, min: f32::INFINITY, max: f32::NEG_INFINITY };

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        if other.min < self.min {
            self.min = other.min;
        }
        if other.max > self.max {
            self.max = other.max;
        }
    }
}

/// From the ends of a box to the bin of its middle.
#[derive(Clone, Copy, Debug)]
struct Scale {
    axis: Axis,
    /// Bins per length, halved.
    scale: f32,
    shift: f32,
}

impl Scale {
    /// Between the planes of a block.
    fn of(axis: Axis, block: &Block, lattice: &Lattice) -> Self {
        let (min, max) = (lattice.position(axis, block.min(axis)), lattice.position(axis, block.max(axis)));
        let scale = 0.5 * BINS as f32 / (max - min);
        Self { axis, scale, shift: -2.0 * min * scale }
    }

    /// Adds a box to its bin, whose number it tells.
    #[inline(always)]
    fn put(&self, bounds: &Aabb, bins: &mut [Bin; BINS]) -> u16 {
        let (min, max) = (self.axis.of(bounds.min), self.axis.of(bounds.max));
        // NaN, where the length is so small that it makes no difference, is the first.
        let number = (((min + max) * self.scale + self.shift) as u32).min(BINS as u32 - 1);
        bins[number as usize % BINS].add(&Bin { count: 1, min, max });
        number as u16
    }
}

/// How primitives are spread along all axes.
pub(super) struct Spread([[Bin; BINS]; 3]);

impl Spread {
    /// No primitives.
    pub(super) const NONE: Self = Self([[Bin::EMPTY; BINS]; 3]);

    /// Adds boxes whose middles are mostly in `block`. The code of a box says by three bits per axis in which bin it is.
    #[inline]
    pub(super) fn add(
        &mut self,
        boxes: impl Iterator<Item = Aabb>,
        codes: &mut [u16],
        block: &Block,
        lattice: &Lattice,
    ) {
        let [x, y, z] = &mut self.0;
        let [of_x, of_y, of_z] = Axis::ALL.map(|axis| Scale::of(axis, block, lattice));
        for (bounds, code) in boxes.zip(codes) {
            *code = of_x.put(&bounds, x) | of_y.put(&bounds, y) << 3 | of_z.put(&bounds, z) << 6;
        }
    }

    /// By axis and bin, all that is in it and behind it.
    pub(super) fn sums(&self) -> Sums<'_> {
        let mut sums = self.0;
        for bins in &mut sums {
            let mut all = Bin::EMPTY;
            for bin in bins.iter_mut().rev() {
                all.add(bin);
                *bin = all;
            }
        }
        Sums { spread: self, from: sums }
    }
}

/// A [`Spread`] with its sums.
pub(super) struct Sums<'s> {
    spread: &'s Spread,
    from: [[Bin; BINS]; 3],
}

impl Sums<'_> {
    /// The least block around all boxes.
    pub(super) fn tight(&self, lattice: &Lattice) -> Block {
        Axis::ALL.into_iter().zip(&self.from).fold(Block::WHOLE, |block, (axis, [all, ..])| {
            block.between(axis, lattice.below(axis, all.min), lattice.above(axis, all.max))
        })
    }

    /// The cheapest way to divide them within `implied` into two parts of at most `most`, if there is one.
    pub(super) fn cut(&self, implied: &Block, metric: &Metric, lattice: &Lattice, most: u32) -> Option<Cut> {
        let mut best = Cut { axis: Axis::X, border: 0, left: 0, planes: (0.0, 0.0), work: f32::INFINITY };
        for (axis, (bins, from_bin)) in Axis::ALL.into_iter().zip(self.spread.0.iter().zip(&self.from)) {
            let (from, to) = (lattice.position(axis, implied.min(axis)), lattice.position(axis, implied.max(axis)));
            // Half the surface of a part of this length.
            let (across, along) = metric.sides(implied, axis);
            let along = along / (to - from);
            let mut before = Bin::EMPTY;
            for (border, (bin, behind)) in (1..).zip(bins.iter().zip(from_bin.iter().skip(1))) {
                if behind.count == 0 {
                    break;
                }
                // Behind an empty bin it is as before it.
                if bin.count == 0 {
                    continue;
                }
                before.add(bin);
                if before.count > most || behind.count > most {
                    continue;
                }
                let left = (across + along * (before.max - from)) * before.count as i32 as f32;
                let right = (across + along * (to - behind.min)) * behind.count as i32 as f32;
                let work = left + right;
                if work < best.work {
                    best = Cut { axis, border, left: before.count, planes: (before.max, behind.min), work };
                }
            }
        }
        let work = best.work / metric.half_area(implied);
        (best.left > 0).then_some(Cut { work, ..best })
    }
}

/// A way to divide a range.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The axis along which it divides.
    pub(super) axis: Axis,
    /// The first bin that goes right.
    border: u16,
    /// How many go left.
    pub(super) left: u32,
    /// Where the left part ends, and where the right one begins.
    pub(super) planes: (f32, f32),
    /// How many primitives a ray through the block is expected to meet below.
    pub(super) work: f32,
}

impl Cut {
    /// Whether what has this code goes left.
    #[inline(always)]
    pub(super) const fn is_left(&self, code: u16) -> bool {
        code >> (3 * self.axis as u16) & 7 < self.border
    }
}
