use super::{Grid, cells::Cells, met::Met};
use crate::{
    accel::{Step, Traversal, leaf::References},
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
    octants: &'a [u32],
    lattice: Lattice,
    slack: f32,
    /// No plane crossed at `t` is left behind later than this after it.
    margin: f32,
    /// Where the ray leaves the bounds.
    exit: f32,
    /// Where it entered the cell that the last crossing led to.
    enter: f32,
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
    /// The number of the cell's far plane, and what is added to come to the next: there is one in the middle of each.
    plane: f32,
    turn: f32,
    /// What is added to the number of the cell.
    stride: u32,
    /// Cells behind this one.
    behind: u32,
    /// The octants in the half of a cell that the ray enters first.
    near: u32,
}

/// Cells that are visited at the same crossing: all combinations of going back by up to so many along each axis.
#[derive(Clone, Copy, Debug, Default)]
struct Tie {
    /// The most cells back.
    most: [u32; 3],
    /// How many the cell at hand is back.
    back: [u32; 3],
}

/// Where the ray enters the half-space behind a plane of a lattice.
#[inline(always)]
fn entry((origin, step): (f32, f32), plane: f32, view: &AxisView) -> f32 {
    (origin + plane * step - view.origin) * view.entry
}

/// Where it leaves that before the plane.
#[inline(always)]
fn exit((origin, step): (f32, f32), plane: f32, view: &AxisView, slack: f32) -> f32 {
    (origin + plane * step - view.origin) * view.exit + slack
}

impl Line {
    /// No cells.
    const NOWHERE: Self = Self { next: f32::INFINITY, plane: 0.0, turn: 0.0, stride: 0, behind: 0, near: 0 };

    /// To the next cell, of which there is one.
    #[inline(always)]
    fn forward(&mut self, planes: (f32, f32), view: &AxisView) {
        self.behind = self.behind.wrapping_sub(1);
        self.plane += self.turn;
        self.next = entry(planes, self.plane, view);
        if self.behind == 0 {
            self.next = f32::INFINITY;
        }
    }

    /// Where the ray enters the far half of the cell.
    #[inline(always)]
    fn middle(&self, planes: (f32, f32), view: &AxisView) -> f32 {
        entry(planes, self.plane - 0.5 * self.turn, view)
    }

    /// Goes to the last cell along an axis that the ray enters up to `enter`; its number.
    #[inline(always)]
    fn find(&mut self, lattice: &Lattice, axis: Axis, stride: u32, enter: f32, ray: &PreparedRay) -> u32 {
        let view = &ray.views[axis as usize];
        let (planes, count) = (lattice.along(axis as u32), lattice.last(axis) / 2);
        let (origin, step) = planes;
        // Where it should be; roundings do not matter.
        let point = axis.of(ray.ray().origin) + enter * axis.of(ray.ray().direction);
        let guess = (((point - origin) / (step * 2.0)) as u32).min(count.saturating_sub(1));
        let lower = [0x0f, 0x33, 0x55][axis as usize];
        // On the near plane, before the cell.
        *self = if view.ascends() {
            let plane = (guess * 2) as i32 as f32;
            Self { next: 0.0, plane, turn: 2.0, stride, behind: count - guess, near: lower }
        } else {
            let plane = (guess * 2 + 2) as i32 as f32;
            let stride = stride.wrapping_neg();
            Self { next: 0.0, plane, turn: -2.0, stride, behind: guess + 1, near: 0xff ^ lower }
        };
        self.next = entry(planes, self.plane, view);
        while self.behind < count && self.next > enter {
            self.behind += 1;
            self.plane -= self.turn;
            self.next = entry(planes, self.plane, view);
        }
        loop {
            self.forward(planes, view);
            if self.behind == 0 || self.next > enter {
                return if self.turn > 0.0 { count - 1 - self.behind } else { self.behind };
            }
        }
    }

    /// How many cells back the ray has not left at `t`.
    fn back(&self, t: f32, lattice: &Lattice, axis: Axis, ray: &PreparedRay, slack: f32) -> u32 {
        let (planes, view) = (lattice.along(axis as u32), &ray.views[axis as usize]);
        let before = (lattice.last(axis) / 2).wrapping_sub(1).wrapping_sub(self.behind);
        let (mut back, mut plane) = (0, self.plane - self.turn);
        while back < before && !(exit(planes, plane, view, slack) < t) {
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
            octants: grid.octants,
            lattice: grid.lattice,
            slack: 0.0,
            margin: 0.0,
            enter: 0.0,
            exit: 0.0,
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
        // Twice the widening of exits.
        let farthest = greatest(self.enter.abs(), self.exit.abs());
        self.margin = farthest * (1.0 / 32768.0) + 2.0 * self.slack;
        let mut is_tied = false;
        let mut stride = 1;
        for axis in [Axis::Z, Axis::Y, Axis::X] {
            let line = &mut self.lines[axis as usize];
            let number = line.find(&self.lattice, axis, stride, self.enter, ray);
            self.at = self.at.wrapping_add(number.wrapping_mul(stride));
            let count = self.lattice.last(axis) / 2;
            stride = stride.wrapping_mul(count);

            let view = &ray.views[axis as usize];
            let left = exit(self.lattice.along(axis as u32), line.plane - line.turn, view, self.slack);
            // Written so that NaN, the ray in the plane, is never left.
            is_tied |= line.behind + 1 < count && !(left < self.enter);
            // A ray along the planes has left one behind or will never. Other exits that are no numbers are too late.
            if !(view.exit.abs() < f32::INFINITY) && !(left < f32::MIN && view.entry.abs() > f32::MAX) {
                self.margin = f32::INFINITY;
            }
        }
        if is_tied {
            self.tie(self.lines, ray, self.enter, None);
        }
    }

    /// Notes the cells that the ray has not left at `t`, when it crosses a plane of the axis given.
    #[inline(never)]
    fn tie(&mut self, lines: [Line; 3], ray: &PreparedRay, t: f32, crossed: Option<usize>) {
        self.tie = Tie::default();
        for ((axis, most), line) in Axis::ALL.into_iter().zip(&mut self.tie.most).zip(&lines) {
            if Some(axis as usize) != crossed {
                *most = line.back(t, &self.lattice, axis, ray, self.slack);
            }
        }
        self.is_tied = self.tie.most != [0; 3];
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

    /// The number of the cell at hand, at a tie.
    #[inline(never)]
    fn tied_cell(&self, at: u32, lines: [Line; 3]) -> u32 {
        let places = lines.iter().zip(self.tie.back);
        places.fold(at, |at, (line, back)| at.wrapping_sub(line.stride.wrapping_mul(back)))
    }

    /// The octants of the cell at hand whose three intervals have a point in common with each other and with the ray's,
    /// and perhaps more.
    #[inline(always)]
    fn octants(&self, [x, y, z]: [&Line; 3], ray: &PreparedRay, enter: f32, limit: f32) -> u32 {
        let margin = self.margin;
        let exit = least(least(least(x.next, y.next), z.next), limit) + margin;
        let middle = |axis: Axis, line: &Line| {
            let entry = line.middle(self.lattice.along(axis as u32), &ray.views[axis as usize]);
            (entry, entry + margin, line.near)
        };
        let (x, y, z) = (middle(Axis::X, x), middle(Axis::Y, y), middle(Axis::Z, z));
        let mut octants = 0xff;
        // Each is left out for a reason; NaN is none.
        for (entry, left, near) in [x, y, z] {
            if left < enter {
                octants &= !near;
            }
            if entry > exit {
                octants &= near;
            }
        }
        for ((a_entry, a_left, a_near), (b_entry, b_left, b_near)) in [(x, y), (y, z), (z, x)] {
            if a_entry > b_left {
                octants &= !(b_near & !a_near);
            }
            if b_entry > a_left {
                octants &= !(a_near & !b_near);
            }
        }
        octants
    }

    /// On to the next cell that holds primitives.
    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Met<'a>> {
        if self.begins {
            self.begin(ray);
        }
        let limit = least(beyond(t_max), self.exit);
        let finite = least(limit, f32::MAX);
        let [mut x, mut y, mut z] = self.lines;
        let (margin, mut at, mut enter) = (self.margin, self.at, self.enter);
        let [x_planes, y_planes, z_planes] = [0, 1, 2].map(|axis| self.lattice.along(axis));
        let [x_view, y_view, z_view, _] = &ray.views;
        let (mut is_new, mut is_tied) = (self.is_new, self.is_tied);
        let step = loop {
            if is_new {
                if BOUNDED {
                    if *budget == 0 {
                        break Step::Paused;
                    }
                    *budget -= 1;
                }
                let cell = if is_tied { self.tied_cell(at, [x, y, z]) } else { at };
                if let Some((first, count)) = self.cells.of(cell) {
                    is_new = false;
                    let octants = if is_tied { 0xff } else { self.octants([&x, &y, &z], ray, enter, limit) };
                    break Step::Leaf(Met::of(self.references, self.octants, first, count, octants));
                }
            }
            is_new = true;
            if is_tied {
                is_tied = self.next_tied();
                if is_tied {
                    continue;
                }
            }
            // Across the nearest plane.
            let (mut axis, mut t) = (0, x.next);
            if y.next < t {
                (axis, t) = (1, y.next);
            }
            if z.next < t {
                (axis, t) = (2, z.next);
            }
            if t > finite {
                // The axis along which to go on where no plane is crossed at a time that is a number.
                match [x.behind, y.behind, z.behind].iter().position(|&behind| behind > 0) {
                    Some(other) if !(t > limit) => axis = other,
                    _ => {
                        is_new = false;
                        break Step::Done;
                    }
                }
            }
            match axis {
                0 => {
                    x.forward(x_planes, x_view);
                    at = at.wrapping_add(x.stride);
                }
                1 => {
                    y.forward(y_planes, y_view);
                    at = at.wrapping_add(y.stride);
                }
                _ => {
                    z.forward(z_planes, z_view);
                    at = at.wrapping_add(z.stride);
                }
            }
            // Written so that NaN, the ray in a plane, is a tie.
            if !(enter + margin < t) {
                self.tie([x, y, z], ray, t, Some(axis));
                is_tied = self.is_tied;
            }
            enter = t;
        };
        (self.lines, self.at, self.enter) = ([x, y, z], at, enter);
        (self.is_new, self.is_tied) = (is_new, is_tied);
        step
    }
}

impl<'a> Traversal for GridTraversal<'a> {
    type Leaf = Met<'a>;

    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<Met<'a>> {
        match self.advance::<false>(ray, t_max, &mut 0) {
            Step::Leaf(leaf) => Some(leaf),
            Step::Paused | Step::Done => None,
        }
    }

    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Met<'a>> {
        self.advance::<true>(ray, t_max, budget)
    }
}
