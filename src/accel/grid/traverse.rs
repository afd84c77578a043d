use super::{Grid, cells::Cells};
use crate::{
    accel::{Leaf, Step, Traversal, leaf::References},
    geometry::{Axis, AxisView, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through a [`Grid`]: slabs across one axis, rows across another in each slab, cells in each row.
///
/// It visits the cells whose three intervals have a point in common with each other and with the ray's interval. Along
/// each axis cells are met in order, so that where a row is left the next one begins: hardly ever is a cell looked at
/// in vain. The axis along which the ray meets most planes is the innermost.
///
/// (The steps of Amanatides and Woo, *A fast voxel traversal algorithm for ray tracing*, 1987, choose one of the cells
/// behind an edge; a hit within the roundings of it may be known to another only.)
#[derive(Clone, Debug)]
pub struct GridTraversal<'a> {
    cells: Cells<'a>,
    references: References<'a>,
    slack: f32,
    /// The interval that the ray has in common with the bounds, with the slab, and the end of that with the row.
    whole: (f32, f32),
    slab: (f32, f32),
    row_exit: f32,
    /// Where the walk is, from the outermost axis to the innermost.
    slabs: Line,
    rows: Line,
    line: Line,
    /// The number of the cell.
    at: u32,
    /// Whether it was not looked at yet.
    is_new: bool,
}

/// A place along an axis, counted along the ray.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    axis: usize,
    /// The first plane's position and the distance between planes.
    origin: f32,
    step: f32,
    /// The number of the cell's far plane, and what is added to come to the next.
    plane: f32,
    turn: f32,
    /// What is added to the number of the cell.
    stride: u32,
    /// Cells before and behind this one.
    before: u32,
    behind: u32,
    /// Where the ray leaves the cell before.
    left: f32,
    /// Where it enters the next cell.
    next: f32,
    /// Where it leaves this cell.
    exit: f32,
}

impl Line {
    /// Where the ray enters the half-space behind a plane, and where it leaves that before it.
    #[inline(always)]
    fn cross(&self, plane: f32, view: &AxisView, slack: f32) -> (f32, f32) {
        let distance = self.origin + plane * self.step - view.origin;
        (distance * view.entry, distance * view.exit + slack)
    }

    /// To the next cell.
    #[inline(always)]
    fn forward(&mut self, view: &AxisView, slack: f32) {
        self.before += 1;
        self.behind -= 1;
        self.plane += self.turn;
        self.left = self.exit;
        (self.next, self.exit) = self.cross(self.plane, view, slack);
    }

    /// To the cell before.
    fn back(&mut self, view: &AxisView, slack: f32) {
        self.before -= 1;
        self.behind += 1;
        self.plane -= self.turn;
        self.measure(view, slack);
    }

    /// Computes the parameters of the planes.
    fn measure(&mut self, view: &AxisView, slack: f32) {
        (_, self.left) = self.cross(self.plane - self.turn, view, slack);
        (self.next, self.exit) = self.cross(self.plane, view, slack);
    }

    /// To the first cell that the ray does not leave before `begin`.
    #[inline(always)]
    fn seek(&mut self, begin: f32, view: &AxisView, slack: f32, at: &mut u32) {
        while !(self.left < begin) && self.before > 0 {
            self.back(view, slack);
            *at = at.wrapping_sub(self.stride);
        }
        while self.exit < begin && self.behind > 0 {
            self.forward(view, slack);
            *at = at.wrapping_add(self.stride);
        }
    }
}

impl<'a> GridTraversal<'a> {
    #[inline]
    pub(super) fn new(grid: &Grid<'a>, ray: &PreparedRay) -> Self {
        let mut traversal = Self {
            cells: grid.cells,
            references: grid.references,
            slack: 0.0,
            whole: (0.0, 0.0),
            slab: (0.0, 0.0),
            row_exit: 0.0,
            slabs: Line::default(),
            rows: Line::default(),
            line: Line::default(),
            at: 0,
            is_new: false,
        };
        if let Some((enter, exit)) = grid.bounds.interval(ray).filter(|_| grid.primitives > 0) {
            let enter = greatest(enter, ray.ray().t_min);
            let exit = least(exit, beyond(ray.ray().t_max));
            if !(enter > exit) {
                traversal.begin(grid, ray, enter, exit);
            }
        }
        traversal
    }

    /// Finds the first cell.
    fn begin(&mut self, grid: &Grid<'a>, ray: &PreparedRay, enter: f32, exit: f32) {
        self.slack = slack(enter);
        self.whole = (enter, exit);
        let [nx, ny, nz] = grid.resolution;
        let mut x = self.place(grid, ray, Axis::X, nx, ny.wrapping_mul(nz));
        let mut y = self.place(grid, ray, Axis::Y, ny, nz);
        let mut z = self.place(grid, ray, Axis::Z, nz, 1);
        // The innermost axis is that with the planes closest to one another.
        if x.1 > y.1 {
            core::mem::swap(&mut x, &mut y);
        }
        if y.1 > z.1 {
            core::mem::swap(&mut y, &mut z);
        }
        if x.1 > y.1 {
            core::mem::swap(&mut x, &mut y);
        }
        (self.slabs, self.rows, self.line) = (x.0, y.0, z.0);
        self.slab = (enter, least(self.slabs.exit, exit));
        self.row_exit = least(self.rows.exit, self.slab.1);
        self.is_new = true;
    }

    /// The first cell along an axis, and how many planes the ray meets per unit of its parameter.
    #[inline(always)]
    fn place(&mut self, grid: &Grid<'a>, ray: &PreparedRay, axis: Axis, count: u32, stride: u32) -> (Line, f32) {
        let view = &ray.views[axis as usize];
        let (origin, step) = grid.lattice.along(axis as u32);
        let (o, d) = (axis.of(ray.ray().origin), axis.of(ray.ray().direction));
        let cell = (((o + self.whole.0 * d - origin) / step) as u32).min(count - 1);
        let ascends = view.ascends();
        let (before, plane, turn) = if ascends { (cell, cell + 1, 1.0) } else { (count - 1 - cell, cell, -1.0) };
        let stride = if ascends { stride } else { stride.wrapping_neg() };
        self.at = self.at.wrapping_add(if ascends { stride } else { stride.wrapping_neg() }.wrapping_mul(cell));
        let mut line = Line {
            axis: axis as usize,
            origin,
            step,
            plane: plane as i32 as f32,
            turn,
            stride,
            before,
            behind: count - 1 - before,
            ..Line::default()
        };
        line.measure(view, self.slack);
        line.seek(self.whole.0, view, self.slack, &mut self.at);
        (line, (d / step).abs())
    }

    /// The first cell of the next row, or of the next slab, that begins before `end`; whether there is one.
    fn next_row(&mut self, ray: &PreparedRay, end: f32) -> bool {
        let (slack, views) = (self.slack, &ray.views);
        let begin;
        if self.rows.behind > 0 && !(self.rows.next > least(end, self.slab.1)) {
            begin = greatest(self.rows.next, self.slab.0);
            self.rows.forward(&views[self.rows.axis & 3], slack);
            self.at = self.at.wrapping_add(self.rows.stride);
        } else if self.slabs.behind > 0 && !(self.slabs.next > least(end, self.whole.1)) {
            begin = greatest(self.slabs.next, self.whole.0);
            self.slabs.forward(&views[self.slabs.axis & 3], slack);
            self.at = self.at.wrapping_add(self.slabs.stride);
            self.slab = (begin, least(self.slabs.exit, self.whole.1));
            self.rows.seek(begin, &views[self.rows.axis & 3], slack, &mut self.at);
        } else {
            return false;
        }
        self.row_exit = least(self.rows.exit, self.slab.1);
        self.line.seek(begin, &views[self.line.axis & 3], slack, &mut self.at);
        true
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let end = beyond(t_max);
        loop {
            let view = &ray.views[self.line.axis & 3];
            let (slack, row_end) = (self.slack, least(end, self.row_exit));
            let (mut line, mut at, mut is_new) = (self.line, self.at, self.is_new);
            // Along the row, in registers.
            let found = loop {
                if is_new {
                    if BOUNDED {
                        if *budget == 0 {
                            break Some(Step::Paused);
                        }
                        *budget -= 1;
                    }
                    is_new = false;
                    if let Some((first, count)) = self.cells.of(at) {
                        break Some(Step::Leaf(Leaf::of(self.references, first, count)));
                    }
                }
                // Written so that NaN, the ray in the plane, visits.
                if line.behind == 0 || line.next > row_end {
                    break None;
                }
                line.forward(view, slack);
                at = at.wrapping_add(line.stride);
                is_new = true;
            };
            (self.line, self.at, self.is_new) = (line, at, is_new);
            if let Some(step) = found {
                return step;
            }
            if !self.next_row(ray, end) {
                return Step::Done;
            }
            self.is_new = true;
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
