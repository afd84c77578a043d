use super::{
    Grid,
    cells::Cells,
    line::{Line, Planes},
    met::Met,
};
use crate::{
    accel::{
        Step, Traversal,
        segment::{Segment, slack_within},
    },
    geometry::{Axis, AxisView, Lattice, PreparedRay, beyond},
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
    entries: &'a [u16],
    lattice: Lattice,
    /// Where the walk is along each axis.
    lines: [Line; 3],
    /// Where the ray entered the cell that the last crossing led to.
    enter: f32,
    /// No plane crossed at `t` is left behind later than this after it.
    margin: f32,
    /// Where the ray leaves the bounds.
    exit: f32,
    slack: f32,
    /// The number of the cell that the last crossing led to.
    at: u32,
    next: Next,
    tie: Tie,
}

/// What a walk looks at next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The nearest plane.
    Plane,
    /// The cell at hand.
    Cell,
    /// The first cell, about which the walk is, or those before it that the ray has not left.
    Beginning,
    /// Cells behind the crossing just made.
    Tie,
    /// Nothing.
    Nothing,
}

/// Cells that are visited at the same crossing: all combinations of going back by up to so many along each axis.
#[derive(Clone, Copy, Debug, Default)]
struct Tie {
    /// The most cells back.
    most: [u32; 3],
    /// How many the cell at hand is back.
    back: [u32; 3],
}

impl<'a> GridTraversal<'a> {
    /// A walk at the beginning of the ray; made where it stays, because moving it would cost as much as some cells.
    #[inline(always)]
    pub(super) fn new(grid: &Grid<'a>, ray: &PreparedRay) -> Self {
        let slack = slack_within(&grid.bounds, ray);
        let segment = if grid.primitives > 0 { Segment::within(&grid.bounds, 0, ray, slack) } else { None };
        let is_met = segment.is_some();
        let Segment { enter, exit, .. } = segment.unwrap_or(Segment { node: 0, enter: 0.0, exit: f32::NEG_INFINITY });
        // Twice the widening of exits.
        let margin = greatest(enter.abs(), exit.abs()) * (1.0 / 32768.0) + 2.0 * slack;
        let (mut at, mut stride, mut is_odd) = (0_u32, 1_u32, false);
        let mut line = |axis: Axis, lower: u32| {
            let planes = Planes::of(&grid.lattice, ray, axis as usize);
            let count = grid.lattice.last(axis) / 2;
            let point = planes.view.origin + enter * axis.of(ray.ray().direction);
            let (line, cell) = Line::about(&planes, count, point, stride, lower);
            at = at.wrapping_add(cell.wrapping_mul(stride));
            stride = stride.wrapping_mul(count);
            // Written so that NaN is odd.
            let near = planes.entry(line.plane - line.turn);
            is_odd |= !(line.next > enter) | (line.before(count) > 0 && !(near + margin < enter));
            is_odd |= !(planes.view.exit.abs() < f32::INFINITY);
            line
        };
        let (z, y, x) = (line(Axis::Z, 0x55), line(Axis::Y, 0x33), line(Axis::X, 0x0f));
        let next = match (is_met, is_odd) {
            (false, _) => Next::Nothing,
            (true, false) => Next::Cell,
            (true, true) => Next::Beginning,
        };
        Self {
            cells: grid.cells,
            entries: grid.entries,
            lattice: grid.lattice,
            lines: [x, y, z],
            enter,
            margin,
            exit,
            slack,
            at,
            next,
            tie: Tie { most: [0; 3], back: [0; 3] },
        }
    }

    /// How many cells there are along an axis.
    #[inline(always)]
    const fn count(&self, axis: Axis) -> u32 {
        self.lattice.last(axis) / 2
    }

    /// Finds the first cell where roundings did matter, more than one if the ray has not left those before, and whether
    /// an exit is no number.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, ray: &PreparedRay) {
        let mut number = 0_u32;
        for axis in Axis::ALL {
            let (planes, count) = (Planes::of(&self.lattice, ray, axis as usize), self.count(axis));
            let line = &mut self.lines[axis as usize];
            line.settle(&planes, count, self.enter);
            number = number.wrapping_mul(count).wrapping_add(line.number(count));
            // A ray along the planes has left one behind or never will. Other exits that are no numbers are too late.
            let AxisView { entry, exit, .. } = planes.view;
            let is_past = planes.exit(line.plane - line.turn, self.slack) < f32::MIN && entry.abs() > f32::MAX;
            if !(exit.abs() < f32::INFINITY || is_past) {
                self.margin = f32::INFINITY;
            }
        }
        self.at = number;
        self.tie(ray, self.enter, None);
    }

    /// Notes the cells that the ray has not left at `t`, when it crosses a plane of the axis given: the one at hand and
    /// perhaps some before it.
    #[cold]
    #[inline(never)]
    fn tie(&mut self, ray: &PreparedRay, t: f32, crossed: Option<usize>) {
        self.tie = Tie::default();
        for axis in Axis::ALL {
            if Some(axis as usize) != crossed {
                let planes = Planes::of(&self.lattice, ray, axis as usize);
                let line = &self.lines[axis as usize];
                self.tie.most[axis as usize] = line.back(&planes, self.count(axis), t, self.slack);
            }
        }
        self.next = if self.tie.most == [0; 3] { Next::Cell } else { Next::Tie };
    }

    /// The next cell of the same crossing, if there is one.
    #[cold]
    #[inline(never)]
    fn next_tied(&mut self) -> u32 {
        let places = self.lines.iter().zip(self.tie.back);
        let cell = places.fold(self.at, |at, (line, back)| at.wrapping_sub(line.stride.wrapping_mul(back)));
        for (back, most) in self.tie.back.iter_mut().zip(self.tie.most) {
            if *back < most {
                *back += 1;
                return cell;
            }
            *back = 0;
        }
        self.next = Next::Plane;
        cell
    }

    /// The octants of the cell at hand whose three intervals have a point in common with each other and with the ray's,
    /// and perhaps more.
    #[inline(always)]
    fn on_the_way(&self, ray: &PreparedRay, enter: f32, limit: f32) -> u32 {
        let margin = self.margin;
        let [x, y, z] = &self.lines;
        let exit = least(least(least(x.next, y.next), z.next), limit) + margin;
        let mut octants = 0xff;
        // Each is left out for a reason; NaN is none.
        let [x, y, z] = [(0, x), (1, y), (2, z)].map(|(axis, line)| {
            let entry = Planes::of(&self.lattice, ray, axis).entry(line.plane - 0.5 * line.turn);
            let left = entry + margin;
            if left < enter {
                octants &= !line.near;
            }
            if entry > exit {
                octants &= line.near;
            }
            (entry, left, line.near)
        });
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

    /// Crosses the next plane of an axis, unless that is behind `end`: where that was, and what is added to the number of the cell.
    #[inline(always)]
    fn cross(&mut self, ray: &PreparedRay, axis: usize, end: f32) -> Option<(f32, u32, usize)> {
        let planes = Planes::of(&self.lattice, ray, axis);
        let line = self.lines.get_mut(axis)?;
        let t = line.next;
        if t > end {
            return None;
        }
        line.forward(&planes);
        Some((t, line.stride, axis))
    }

    /// As [`cross`](Self::cross), where all planes are at infinity, and the ray's end too.
    #[cold]
    #[inline(never)]
    fn cross_at_infinity(&mut self, ray: &PreparedRay, limit: f32) -> Option<(f32, u32, usize)> {
        if limit < f32::INFINITY {
            return None;
        }
        let axis = self.lines.iter().position(|line| line.behind > 0)?;
        self.cross(ray, axis, limit)
    }

    /// On to the next cell that holds primitives on the ray's way.
    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Met<'a>> {
        let limit = least(beyond(t_max), self.exit);
        let end = least(limit, f32::MAX);
        if self.next == Next::Beginning {
            self.begin(ray);
        }
        loop {
            if self.next == Next::Tie {
                if BOUNDED {
                    if *budget == 0 {
                        return Step::Paused;
                    }
                    *budget -= 1;
                }
                let cell = self.next_tied();
                if let Some(references) = self.cells.of(cell)
                    && let Some(met) = Met::new(self.entries, references, 0xff)
                {
                    return Step::Leaf(met);
                }
                continue;
            }
            if self.next == Next::Nothing {
                return Step::Done;
            }
            let (mut at, mut enter, margin) = (self.at, self.enter, self.margin);
            let mut is_new = self.next == Next::Cell;
            // Without ties all that changes is in registers.
            let (next, step) = loop {
                if is_new {
                    if BOUNDED {
                        if *budget == 0 {
                            break (Next::Cell, Some(Step::Paused));
                        }
                        *budget -= 1;
                    }
                    if let Some(references) = self.cells.of(at) {
                        let octants = self.on_the_way(ray, enter, limit);
                        if octants != 0
                            && let Some(met) = Met::new(self.entries, references, octants)
                        {
                            break (Next::Plane, Some(Step::Leaf(met)));
                        }
                    }
                }
                is_new = true;
                // Across the nearest plane.
                let [x, y, z] = &self.lines;
                let crossed = if y.next < x.next {
                    if z.next < y.next { self.cross(ray, 2, end) } else { self.cross(ray, 1, end) }
                } else if z.next < x.next {
                    self.cross(ray, 2, end)
                } else {
                    self.cross(ray, 0, end)
                };
                let Some((t, stride, axis)) = crossed.or_else(|| self.cross_at_infinity(ray, limit)) else {
                    break (Next::Plane, Some(Step::Done));
                };
                at = at.wrapping_add(stride);
                let is_tied = !(enter + margin < t);
                enter = t;
                if is_tied {
                    self.tie(ray, t, Some(axis));
                    break (self.next, None);
                }
            };
            (self.at, self.enter, self.next) = (at, enter, next);
            if let Some(step) = step {
                return step;
            }
        }
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
