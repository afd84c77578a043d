//! Which cells a primitive is in, and in which of their octants.

use core::ops::Range;

use super::cells::index;
use crate::{
    geometry::{Aabb, Axis, Lattice},
    primitives::Primitives,
};

/// The cells of a grid that is being built.
pub(super) struct Frame {
    pub(super) resolution: [u32; 3],
    /// Two planes per cell: one before it and one through its middle.
    pub(super) lattice: Lattice,
}

/// A part of a primitive, between two planes: its bounds and the halves of cells along y and z that they are in.
#[derive(Clone)]
struct Part {
    bounds: Aabb,
    ys: Range<u32>,
    zs: Range<u32>,
}

impl Frame {
    pub(super) fn new(bounds: &Aabb, resolution: [u32; 3]) -> Self {
        Self { resolution, lattice: Lattice::over(bounds, resolution.map(|count| count.saturating_mul(2))) }
    }

    /// How many cells there are.
    pub(super) const fn cells(&self) -> usize {
        let [nx, ny, nz] = self.resolution;
        (nx as usize).saturating_mul(ny as usize).saturating_mul(nz as usize)
    }

    /// The halves along an axis whose union contains all from `min` to `max`: at least one, and no more than that takes.
    fn range(&self, axis: Axis, bounds: &Aabb) -> Range<u32> {
        let last = self.lattice.last(axis);
        let first = self.lattice.below(axis, axis.of(bounds.min)).min(last.saturating_sub(1));
        first..self.lattice.above(axis, axis.of(bounds.max)).max(first + 1)
    }

    /// The box of a half of a cell along an axis, as wide as `bounds` along the others.
    fn slab(&self, axis: Axis, half: u32, bounds: &Aabb) -> Aabb {
        let (low, high) = (self.lattice.position(axis, half), self.lattice.position(axis, half + 1));
        bounds.split(axis, low).1.split(axis, high).0
    }

    /// About how many cells a primitive with these bounds is in: all of them or, if it is cut, as many as half a diagonal
    /// plane would be.
    pub(super) fn estimate(&self, bounds: &Aabb, clip: bool) -> usize {
        let [x, y, z] = Axis::ALL.map(|axis| cells(&self.range(axis, bounds)).len());
        let all = x.saturating_mul(y).saturating_mul(z);
        if clip { all.min((x * y + y * z + z * x) / 2 + 1) } else { all }
    }

    /// Gives all cells that a primitive is in to `visit`, with a bit per octant that it is in, until it returns false;
    /// whether it never did.
    ///
    /// A primitive with `clip` is in those octants only that its clipped parts need: it is cut into slabs and these into
    /// rows. A part is in one piece, so that all octants between its ends are needed.
    pub(super) fn cover<P: Primitives + ?Sized>(
        &self,
        primitives: &P,
        primitive: u32,
        clip: bool,
        mut visit: impl FnMut(u32, u32) -> bool,
    ) -> bool {
        let bounds = primitives.bounds(primitive);
        let clip = clip && primitives.is_certified(primitive);
        let xs = self.range(Axis::X, &bounds);
        let whole = Part { bounds, ys: self.range(Axis::Y, &bounds), zs: self.range(Axis::Z, &bounds) };
        // Along one axis alone, or in one half, there is nothing to cut off.
        let manifold = |a: &Range<u32>, b: &Range<u32>| a.len() > 1 && b.len() > 1;
        let cut_slabs = clip && (manifold(&xs, &whole.ys) || manifold(&xs, &whole.zs));
        if !(cut_slabs || clip && manifold(&whole.ys, &whole.zs)) {
            return self.fill([&xs, &whole.ys, &whole.zs], visit);
        }
        for x in cells(&xs) {
            let parts = halves(x).map(|x| match xs.contains(&x) {
                true if cut_slabs => {
                    let bounds = primitives.clip(primitive, &self.slab(Axis::X, x, &whole.bounds))?;
                    Some(Part { bounds, ys: self.range(Axis::Y, &bounds), zs: self.range(Axis::Z, &bounds) })
                }
                true => Some(whole.clone()),
                false => None,
            });
            for y in cells(&union(parts.iter().flatten().map(|part| &part.ys))) {
                let rows = parts.each_ref().map(|part| {
                    halves(y).map(|y| {
                        let part = part.as_ref().filter(|part| part.ys.contains(&y))?;
                        if !(clip && manifold(&part.ys, &part.zs)) {
                            return Some(part.zs.clone());
                        }
                        let row = primitives.clip(primitive, &self.slab(Axis::Y, y, &part.bounds))?;
                        Some(self.range(Axis::Z, &row))
                    })
                });
                for z in cells(&union(rows.iter().flatten().flatten())) {
                    let mut octants = 0;
                    for (row, zs) in rows.iter().flatten().enumerate() {
                        for (half, z) in halves(z).into_iter().enumerate() {
                            let is_in = zs.as_ref().is_some_and(|zs| zs.contains(&z));
                            octants |= u32::from(is_in) << (row * 2 + half);
                        }
                    }
                    if octants != 0 && !visit(index(self.resolution, [x, y, z]), octants) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// Gives all cells of a block to `visit`.
    #[inline(always)]
    fn fill(&self, [xs, ys, zs]: [&Range<u32>; 3], mut visit: impl FnMut(u32, u32) -> bool) -> bool {
        for x in cells(xs) {
            let of_x = within(x, xs, 0x0f);
            for y in cells(ys) {
                let of_y = of_x & within(y, ys, 0x33);
                for z in cells(zs) {
                    if !visit(index(self.resolution, [x, y, z]), of_y & within(z, zs, 0x55)) {
                        return false;
                    }
                }
            }
        }
        true
    }
}

/// The octants of a cell that is in a range of halves, if those in its lower half are `lower`.
#[inline(always)]
fn within(cell: u32, range: &Range<u32>, lower: u32) -> u32 {
    let first = if range.start > cell * 2 { 0 } else { lower };
    let second = if range.end < cell * 2 + 2 { 0 } else { 0xff ^ lower };
    first | second
}

/// The numbers of the two halves of a cell.
fn halves(cell: u32) -> [u32; 2] {
    [cell * 2, cell * 2 + 1]
}

/// The cells that some halves are in.
fn cells(halves: &Range<u32>) -> Range<u32> {
    halves.start / 2..halves.end.div_ceil(2)
}

/// The least range that contains all of these.
fn union<'r>(ranges: impl Iterator<Item = &'r Range<u32>>) -> Range<u32> {
    let both = ranges.cloned().reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
    both.unwrap_or(0..0)
}
