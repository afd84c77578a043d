//! Which cells a primitive is in.

use core::ops::Range;

use super::cells::index;
use crate::{
    geometry::{Aabb, Axis, Lattice},
    primitives::Primitives,
};

/// The cells of a grid that is being built.
pub(super) struct Frame {
    pub(super) resolution: [u32; 3],
    pub(super) lattice: Lattice,
}

impl Frame {
    pub(super) fn new(bounds: &Aabb, resolution: [u32; 3]) -> Self {
        Self { resolution, lattice: Lattice::over(bounds, resolution) }
    }

    /// How many cells there are.
    pub(super) const fn cells(&self) -> usize {
        let [nx, ny, nz] = self.resolution;
        (nx as usize).saturating_mul(ny as usize).saturating_mul(nz as usize)
    }

    /// The cells along an axis whose union contains all from `min` to `max`: at least one, and no more than that takes.
    fn range(&self, axis: Axis, bounds: &Aabb) -> Range<u32> {
        let last = self.lattice.last(axis);
        let first = self.lattice.below(axis, axis.of(bounds.min)).min(last.saturating_sub(1));
        first..self.lattice.above(axis, axis.of(bounds.max)).max(first + 1)
    }

    /// The box of some cells along an axis, as wide as `bounds` along the others.
    fn slab(&self, axis: Axis, cell: u32, bounds: &Aabb) -> Aabb {
        let (low, high) = (self.lattice.position(axis, cell), self.lattice.position(axis, cell + 1));
        bounds.split(axis, low).1.split(axis, high).0
    }

    /// Gives all cells that a primitive is in to `visit`, as rows of consecutive numbers, until it returns false; whether
    /// it never did.
    ///
    /// A primitive with `clip` is in those cells only that its clipped parts need: it is cut into slabs and these into
    /// rows. A part is in one piece, so that all cells between its ends are needed.
    pub(super) fn cover<P: Primitives + ?Sized>(
        &self,
        primitives: &P,
        primitive: u32,
        clip: bool,
        mut visit: impl FnMut(Range<u32>) -> bool,
    ) -> bool {
        let bounds = primitives.bounds(primitive);
        let clip = clip && primitives.is_certified(primitive);
        let (xs, ys, zs) = (self.range(Axis::X, &bounds), self.range(Axis::Y, &bounds), self.range(Axis::Z, &bounds));
        // Along one axis alone, or in one cell, there is nothing to cut off.
        let manifold = |a: &Range<u32>, b: &Range<u32>| a.len() > 1 && b.len() > 1;
        let cut_slabs = clip && (manifold(&xs, &ys) || manifold(&xs, &zs));
        for x in xs {
            let (mut part, mut ys, mut zs) = (bounds, ys.clone(), zs.clone());
            if cut_slabs {
                let Some(clipped) = primitives.clip(primitive, &self.slab(Axis::X, x, &bounds)) else { continue };
                part = clipped;
                (ys, zs) = (self.range(Axis::Y, &part), self.range(Axis::Z, &part));
            }
            let cut_rows = clip && manifold(&ys, &zs);
            for y in ys {
                let mut zs = zs.clone();
                if cut_rows {
                    let row = self.slab(Axis::Y, y, &part);
                    let Some(clipped) = primitives.clip(primitive, &row) else { continue };
                    zs = self.range(Axis::Z, &clipped);
                }
                let first = index(self.resolution, [x, y, zs.start]);
                if !visit(first..first + zs.len() as u32) {
                    return false;
                }
            }
        }
        true
    }
}
