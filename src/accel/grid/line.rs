//! Where a walk is along one axis.

use crate::geometry::{AxisView, Lattice, PreparedRay};

/// A place along an axis, counted along the ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Where the ray enters the next cell; never if there is none.
    pub(super) next: f32,
    /// The number of the cell's far plane, and what is added to come to the next: there is one in the middle of each.
    pub(super) plane: f32,
    pub(super) turn: f32,
    /// Cells behind this one.
    pub(super) behind: u32,
    /// What is added to the number of the cell.
    pub(super) stride: u32,
    /// The octants in the half of a cell that the ray enters first.
    pub(super) near: u32,
}

/// The planes of an axis as a ray sees them.
#[derive(Clone, Copy)]
pub(super) struct Planes {
    /// The first, and the distance from one to the next.
    pub(super) first: f32,
    pub(super) step: f32,
    pub(super) view: AxisView,
}

impl Planes {
    #[inline(always)]
    pub(super) fn of(lattice: &Lattice, ray: &PreparedRay, axis: usize) -> Self {
        let (first, step) = lattice.along(axis as u32);
        Self { first, step, view: ray.views[axis & 3] }
    }

    /// How far a plane is from the ray's origin.
    #[inline(always)]
    pub(super) fn distance(&self, plane: f32) -> f32 {
        self.first + plane * self.step - self.view.origin
    }

    /// Where the ray enters the half-space behind a plane.
    #[inline(always)]
    pub(super) fn entry(&self, plane: f32) -> f32 {
        self.distance(plane) * self.view.entry
    }

    /// Where it leaves that before the plane.
    #[inline(always)]
    pub(super) fn exit(&self, plane: f32, slack: f32) -> f32 {
        self.distance(plane) * self.view.exit + slack
    }
}

impl Line {
    /// About the last of `count` cells that the ray enters up to where it is at `point`, and its number: roundings do not
    /// matter.
    #[inline(always)]
    pub(super) fn about(planes: &Planes, count: u32, point: f32, stride: u32, lower: u32) -> (Self, u32) {
        let cell = (((point - planes.first) * 0.5 / planes.step) as u32).min(count.wrapping_sub(1));
        let (plane, turn, stride, behind, near) = if planes.view.ascends() {
            (cell + 1, 2.0, stride, count.wrapping_sub(1).wrapping_sub(cell), lower)
        } else {
            (cell, -2.0, stride.wrapping_neg(), cell, 0xff ^ lower)
        };
        let plane = (plane * 2) as i32 as f32;
        let line = Self { next: 0.0, plane, turn, behind, stride, near };
        (Self { next: line.ahead(planes), ..line }, cell)
    }

    /// To the last cell that the ray enters up to `enter`, from wherever it is.
    pub(super) fn settle(&mut self, planes: &Planes, count: u32, enter: f32) {
        while self.before(count) > 0 && planes.entry(self.plane - self.turn) > enter {
            self.behind += 1;
            self.plane -= self.turn;
        }
        self.next = self.ahead(planes);
        // Written so that NaN, the ray in the plane, goes on.
        while self.behind > 0 && !(self.next > enter) {
            self.forward(planes);
        }
    }

    /// Cells of `count` before this one.
    #[inline(always)]
    pub(super) const fn before(&self, count: u32) -> u32 {
        count.wrapping_sub(1).wrapping_sub(self.behind)
    }

    /// The number of this one.
    #[inline(always)]
    pub(super) const fn number(&self, count: u32) -> u32 {
        if self.turn > 0.0 { self.before(count) } else { self.behind }
    }

    /// To the next cell, of which there is one.
    #[inline(always)]
    pub(super) fn forward(&mut self, planes: &Planes) {
        self.behind = self.behind.wrapping_sub(1);
        self.plane += self.turn;
        self.next = self.ahead(planes);
    }

    /// Where the ray enters the next cell.
    #[inline(always)]
    pub(super) fn ahead(&self, planes: &Planes) -> f32 {
        if self.behind == 0 { f32::INFINITY } else { planes.entry(self.plane) }
    }

    /// How many cells back the ray has not left at `t`.
    pub(super) fn back(&self, planes: &Planes, count: u32, t: f32, slack: f32) -> u32 {
        let (mut back, mut plane) = (0, self.plane - self.turn);
        while back < self.before(count) && !(planes.exit(plane, slack) < t) {
            back += 1;
            plane -= self.turn;
        }
        back
    }
}
