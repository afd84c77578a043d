//! A grid's planes as sweeps want them.

use crate::{
    geometry::{Aabb, Axis, Lattice},
    math::greatest,
};

/// Planes of an axis, equally far apart up to roundings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spacing {
    /// As rays see them that ascend, and that descend.
    pub(super) sides: [Side; 2],
    /// The distance from one to the next, and one over that.
    pub(super) width: f32,
    pub(super) inverse: f32,
    /// The distance from the first to the last.
    pub(super) extent: f32,
}

/// What rays meet first along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// The first plane.
    pub(super) plane: f32,
    /// What the number of the cell behind it has from this axis, and what is added for the next cell.
    pub(super) number: u32,
    pub(super) stride: u32,
    /// The octants in the first half of a cell.
    pub(super) near: u32,
}

/// A grid's planes as sweeps want them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) axes: [Spacing; 3],
    /// The error of a parameter relative to itself, of as many sums as there are cells along an axis, beside twice the
    /// widening of exits.
    pub(super) relative: f32,
    /// The error of a plane's place.
    pub(super) absolute: f32,
}

impl Course {
    pub(super) fn new(lattice: &Lattice, bounds: &Aabb) -> Self {
        let [nx, ny, nz] = Axis::ALL.map(|axis| lattice.last(axis) / 2);
        let spacing = |axis: Axis, count: u32, stride: u32, lower: u32| {
            let (plane, step) = lattice.along(axis as u32);
            let ascending = Side { plane, number: 0, stride, near: lower };
            let descending = Side {
                plane: lattice.position(axis, lattice.last(axis)),
                number: count.wrapping_sub(1).wrapping_mul(stride),
                stride: stride.wrapping_neg(),
                near: 0xff ^ lower,
            };
            let (width, inverse) = (2.0 * step, 0.5 / step);
            Spacing { sides: [ascending, descending], width, inverse, extent: lattice.extent(axis) }
        };
        let axes = [
            spacing(Axis::X, nx, ny.wrapping_mul(nz), 0x0f),
            spacing(Axis::Y, ny, nz, 0x33),
            spacing(Axis::Z, nz, 1, 0x55),
        ];
        let steps = nx.max(ny).max(nz) as f32;
        let farthest = greatest(bounds.min.abs().max_element(), bounds.max.abs().max_element());
        Self {
            axes,
            relative: 1.0 / 32_768.0 + steps * (1.0 / 2_097_152.0),
            absolute: farthest * (1.0 / 262_144.0) + f32::MIN_POSITIVE,
        }
    }

    /// How much later a crossing must be than another for their order to be certain: of a ray that is in the bounds from `enter`
    /// to `exit`, if these are the sum of its reciprocals.
    #[inline(always)]
    pub(super) fn margin(&self, enter: f32, exit: f32, reciprocals: f32, t_min: f32) -> f32 {
        greatest(exit, -enter) * self.relative
            + reciprocals * self.absolute
            + ((t_min.abs() - t_min) * (1.0 / 4096.0) + 4.0 * f32::MIN_POSITIVE)
    }
}
