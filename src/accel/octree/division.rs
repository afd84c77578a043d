use super::node::{Point, behind};
use crate::geometry::{Aabb, Axis};

/// A point that divides a cell, and on which sides of its planes items in these go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Division {
    pub(super) point: Point,
    pub(super) flat_before: [bool; 3],
}

impl Division {
    /// No division: everything is before the point.
    pub(super) const NONE: Self = Self { point: Point([f32::INFINITY; 3]), flat_before: [true; 3] };

    /// Which sides of the plane across an axis an item has part in: 1 before, 2 behind.
    #[inline(always)]
    pub(super) fn sides(&self, axis: Axis, bounds: &Aabb) -> u32 {
        let (min, max, plane) = (axis.of(bounds.min), axis.of(bounds.max), self.point.along(axis));
        if min == plane && max == plane {
            if self.flat_before.get(axis as usize) == Some(&false) { 2 } else { 1 }
        } else if max <= plane {
            1
        } else if min >= plane {
            2
        } else {
            3
        }
    }

    /// The octants that an item has part in.
    #[inline(always)]
    pub(super) fn octants(&self, bounds: &Aabb) -> u32 {
        let mut octants = 255;
        for axis in Axis::ALL {
            let sides = self.sides(axis, bounds);
            octants &= if sides & 1 != 0 { 255 } else { behind(axis) };
            octants &= if sides & 2 != 0 { 255 } else { !behind(axis) };
        }
        octants
    }
}
