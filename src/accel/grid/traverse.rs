use super::{Grid, cells::Cells};
use crate::{
    accel::{Leaf, Step, Traversal, leaf::References},
    geometry::{Axis, AxisView, Lattice, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through a [`Grid`]: from plane to plane, the nearest first, after Amanatides and Woo, *A fast voxel
/// traversal algorithm for ray tracing*, 1987, but exact.
///
/// It visits all cells whose three intervals, from the entry of the near plane to the widened exit of the far one, have a
/// point in common with each other and with the ray's. Such a cell is visited when the last of its near planes is
/// crossed: it is then the cell that the crossing leads to or, if other planes crossed before are not left behind yet,
/// one on their other side (a tie). So no cell is visited twice, and none before one that the ray enters earlier.
#[derive(Clone, Debug)]
pub struct GridTraversal<'a> {
    cells: Cells<'a>,
    references: References<'a>,
    lattice: Lattice,
    slack: f32,
    /// Where the ray leaves the bounds.
    exit: f32,
    /// Where its interval within them begins.
    enter: f32,
    /// Where it has left all cells before the one that the last crossing led to.
    left: f32,
    /// Where the walk is along each axis.
    lines: [Line; 3],
    /// The number of the cell that the last crossing led to.
    at: u32,
    /// Whether the first cells are still to be found.
    begins: bool,
    /// Whether the cell at hand was not looked at yet.
    is_new: bool,
    /// Whether there may be more cells behind the same crossing.
    is_tied: bool,
    tie: Tie,
}

/// A place along an axis, counted along the ray.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// Where the ray enters the next cell; never if there is none.
    next: f32,
    /// Where it leaves this cell.
    exit: f32,
    /// The number of the cell's far plane, and what is added to come to the next.
    plane: f32,
    turn: f32,
    /// What is added to the number of the cell.
    stride: u32,
    /// Cells behind this one.
    behind: u32,
}

/// Cells that are visited at the same crossing: all combinations of going back by up to so many along each axis.
#[derive(Clone, Copy, Debug, Default)]
struct Tie {
    /// The most cells back.
    most: [u32; 3],
    /// How many the cell at hand is back.
    back: [u32; 3],
}

impl Line {
    /// No cells.
    const NOWHERE: Self = Self { next: f32::INFINITY, exit: 0.0, plane: 0.0, turn: 0.0, stride: 0, behind: 0 };

    /// Where the ray enters the half-space behind a plane, and where it leaves that before it.
    #[inline(always)]
    fn cross(plane: f32, (origin, step): (f32, f32), view: &AxisView, slack: f32) -> (f32, f32) {
        let distance = origin + plane * step - view.origin;
        (distance * view.entry, distance * view.exit + slack)
    }

    /// To the next cell, of which there is one.
    #[inline(always)]
    fn forward(&mut self, planes: (f32, f32), view: &AxisView, slack: f32) {
        self.behind -= 1;
        self.plane += self.turn;
        (self.next, self.exit) = Self::cross(self.plane, planes, view, slack);
        if self.behind == 0 {
            self.next = f32::INFINITY;
        }
    }

    /// Goes to the last cell along an axis that the ray enters up to `enter`: its number, and where the ray leaves the
    /// cell before.
    fn find(
        &mut self,
        lattice: &Lattice,
        axis: Axis,
        stride: u32,
        enter: f32,
        ray: &PreparedRay,
        slack: f32,
    ) -> (u32, f32) {
        let view = &ray.views[axis as usize];
        let (planes, count) = (lattice.along(axis as u32), lattice.last(axis));
        let (origin, step) = planes;
        // Where it should be; roundings do not matter.
        let point = axis.of(ray.ray().origin) + enter * axis.of(ray.ray().direction);
        let guess = (((point - origin) / step) as u32).min(count.saturating_sub(1));
        let (plane, turn, stride, behind) = if view.ascends() {
            (guess, 1.0, stride, count - guess)
        } else {
            (guess + 1, -1.0, stride.wrapping_neg(), guess + 1)
        };
        // On the near plane, before the cell.
        *self = Self { next: 0.0, exit: 0.0, plane: plane as i32 as f32, turn, stride, behind };
        (self.next, self.exit) = Self::cross(self.plane, planes, view, slack);
        while self.behind < count && self.next > enter {
            self.behind += 1;
            self.plane -= turn;
            (self.next, self.exit) = Self::cross(self.plane, planes, view, slack);
        }
        loop {
            // Written so that NaN, the ray in the plane, is never left and goes on.
            let left = if self.exit < f32::INFINITY { self.exit } else { f32::INFINITY };
            let left = if self.behind == count { f32::NEG_INFINITY } else { left };
            self.forward(planes, view, slack);
            if self.behind == 0 || self.next > enter {
                return (if turn > 0.0 { count - 1 - self.behind } else { self.behind }, left);
            }
        }
    }

    /// How many cells back the ray has not left at `t`.
    fn back(&self, t: f32, lattice: &Lattice, axis: Axis, ray: &PreparedRay, slack: f32) -> u32 {
        let (planes, view) = (lattice.along(axis as u32), &ray.views[axis as usize]);
        let before = lattice.last(axis) - 1 - self.behind;
        let (mut back, mut plane) = (0, self.plane - self.turn);
        while back < before && !(Self::cross(plane, planes, view, slack).1 < t) {
            back += 1;
            plane -= self.turn;
        }
        back
    }
}

impl<'a> GridTraversal<'a> {
    /// The walk along `ray`, before its beginning.
    #[inline]
    pub(super) fn new(grid: &Grid<'a>, ray: &PreparedRay) -> Self {
        // The first cells are found where this is when it is walked: it need not be moved then.
        let mut traversal = Self {
            cells: grid.cells,
            references: grid.references,
            lattice: grid.lattice,
            slack: 0.0,
            enter: 0.0,
            exit: 0.0,
            left: f32::NEG_INFINITY,
            lines: [Line::NOWHERE; 3],
            at: 0,
            begins: false,
            is_new: false,
            is_tied: false,
            tie: Tie { most: [0; 3], back: [0; 3] },
        };
        if let Some((enter, exit)) = grid.bounds.interval(ray) {
            traversal.enter = greatest(enter, ray.ray().t_min);
            traversal.exit = least(exit, beyond(ray.ray().t_max));
            traversal.begins = grid.primitives > 0 && !(traversal.enter > traversal.exit);
        }
        traversal
    }

    /// Finds the first cells.
    #[inline(never)]
    fn begin(&mut self, ray: &PreparedRay) {
        (self.begins, self.is_new) = (false, true);
        (self.slack, self.at) = (slack(self.enter), 0);
        let mut stride = 1;
        for axis in [Axis::Z, Axis::Y, Axis::X] {
            let line = &mut self.lines[axis as usize];
            let (number, left) = line.find(&self.lattice, axis, stride, self.enter, ray, self.slack);
            self.left = greatest(left, self.left);
            self.at = self.at.wrapping_add(number.wrapping_mul(stride));
            stride = stride.wrapping_mul(self.lattice.last(axis));
        }
        if !(self.left < self.enter) {
            self.tie(ray, self.enter, None);
        }
    }

    /// Notes the cells that the ray has not left at `t`, when it crosses a plane of the axis given.
    #[inline(never)]
    fn tie(&mut self, ray: &PreparedRay, t: f32, crossed: Option<usize>) {
        self.tie = Tie::default();
        for ((axis, most), line) in Axis::ALL.into_iter().zip(&mut self.tie.most).zip(&self.lines) {
            if Some(axis as usize) != crossed {
                *most = line.back(t, &self.lattice, axis, ray, self.slack);
            }
        }
        self.is_tied = true;
    }

    /// Goes to the next cell of the same crossing, if there is one.
    #[inline(never)]
    fn next_tied(&mut self) -> bool {
        for (back, most) in self.tie.back.iter_mut().zip(self.tie.most) {
            if *back < most {
                *back += 1;
                return true;
            }
            *back = 0;
        }
        self.is_tied = false;
        false
    }

    /// The number of the cell at hand.
    #[inline(always)]
    fn cell(&self) -> u32 {
        if !self.is_tied {
            return self.at;
        }
        let places = self.lines.iter().zip(self.tie.back);
        places.fold(self.at, |at, (line, back)| at.wrapping_sub(line.stride.wrapping_mul(back)))
    }

    /// The axis along which to go on where no plane is crossed at a time that is a number.
    #[inline(never)]
    fn any_axis(&self) -> Option<usize> {
        self.lines.iter().position(|line| line.behind > 0)
    }

    /// On to the next cell that holds primitives.
    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let limit = least(beyond(t_max), self.exit);
        let finite = least(limit, f32::MAX);
        if self.begins {
            self.begin(ray);
        }
        let (slack, mut at, mut left) = (self.slack, self.at, self.left);
        let mut is_new = self.is_new;
        loop {
            if is_new {
                if BOUNDED {
                    if *budget == 0 {
                        (self.at, self.left, self.is_new) = (at, left, true);
                        return Step::Paused;
                    }
                    *budget -= 1;
                }
                let cell = if self.is_tied { self.cell() } else { at };
                if let Some((first, count)) = self.cells.of(cell) {
                    (self.at, self.left, self.is_new) = (at, left, false);
                    return Step::Leaf(Leaf::of(self.references, first, count));
                }
            }
            is_new = true;
            if self.is_tied && self.next_tied() {
                continue;
            }
            // Across the nearest plane.
            let [x, y, z] = &self.lines;
            let (mut axis, mut t) = (0, x.next);
            if y.next < t {
                (axis, t) = (1, y.next);
            }
            if z.next < t {
                (axis, t) = (2, z.next);
            }
            if t > finite {
                match self.any_axis() {
                    Some(other) if !(t > limit) => axis = other,
                    _ => {
                        (self.at, self.left, self.is_new) = (at, left, false);
                        return Step::Done;
                    }
                }
            }
            let Some(line) = self.lines.get_mut(axis) else { return Step::Done };
            let exit = line.exit;
            line.forward(self.lattice.along(axis as u32), &ray.views[axis & 3], slack);
            at = at.wrapping_add(line.stride);
            // Written so that NaN, the ray in a plane, is a tie.
            if !(left < t) {
                self.at = at;
                self.tie(ray, t, Some(axis));
            }
            left = greatest(exit, left);
        }
    }
}

impl<'a> Traversal for GridTraversal<'a> {
    type Leaf = Leaf<'a>;

    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<Leaf<'a>> {
        match self.advance::<false>(ray, t_max, &mut 0) {
            Step::Leaf(leaf) => Some(leaf),
            Step::Paused | Step::Done => None,
        }
    }

    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        self.advance::<true>(ray, t_max, budget)
    }
}
