use super::{
    Grid,
    cells::Cells,
    line::{Line, Planes},
    met::Met,
};
use crate::{
    accel::{Step, Traversal, leaf::References, segment::Segment},
    geometry::{Aabb, Axis, AxisView, Lattice, PreparedRay, beyond, slack},
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
    octants: &'a [u8],
    bounds: Aabb,
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
    /// Whether the first cells are still to be found.
    begins: bool,
    /// Whether the cell at hand was not looked at yet.
    is_new: bool,
    /// Whether there may be more cells behind the same crossing.
    is_tied: bool,
    tie: Tie,
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
    /// A walk before its beginning, along whichever ray is given to it.
    #[inline(always)]
    pub(super) fn new(grid: &Grid<'a>) -> Self {
        // The first cells are found where this is when it is walked: it need not be moved then.
        Self {
            cells: grid.cells,
            references: grid.references,
            octants: grid.octants,
            bounds: grid.bounds,
            lattice: grid.lattice,
            lines: [Line::NOWHERE; 3],
            enter: 0.0,
            margin: 0.0,
            exit: f32::NEG_INFINITY,
            slack: 0.0,
            at: 0,
            begins: grid.primitives > 0,
            is_new: false,
            is_tied: false,
            tie: Tie { most: [0; 3], back: [0; 3] },
        }
    }

    /// How many cells there are along an axis.
    #[inline(always)]
    const fn count(&self, axis: Axis) -> u32 {
        self.lattice.last(axis) / 2
    }

    /// Finds the first cells, if there are any.
    #[inline(never)]
    fn begin(&mut self, ray: &PreparedRay) {
        self.begins = false;
        let slack = slack(ray.ray().t_min);
        let Some(Segment { enter, exit, .. }) = Segment::within(&self.bounds, 0, ray, slack) else { return };
        (self.enter, self.exit, self.slack, self.is_new) = (enter, exit, slack, true);
        // Twice the widening of exits.
        self.margin = greatest(enter.abs(), exit.abs()) * (1.0 / 32768.0) + 2.0 * slack;
        let (mut at, mut stride, mut is_odd) = (0_u32, 1_u32, false);
        for (axis, lower) in [(Axis::Z, 0x55), (Axis::Y, 0x33), (Axis::X, 0x0f)] {
            let planes = Planes::of(&self.lattice, ray, axis as usize);
            let count = self.count(axis);
            let point = planes.view.origin + enter * axis.of(ray.ray().direction);
            let line = Line::about(&planes, count, point, stride, lower);
            at = at.wrapping_add(line.number(count).wrapping_mul(stride));
            stride = stride.wrapping_mul(count);
            self.lines[axis as usize] = line;
            // Written so that NaN is odd.
            let near = line.plane - line.turn;
            let is_off = planes.entry(near) > enter || !(line.next > enter);
            let is_tied = line.before(count) > 0 && !(planes.exit(near, slack) < enter);
            is_odd |= is_off || is_tied || !(planes.view.exit.abs() < f32::INFINITY);
        }
        self.at = at;
        if is_odd {
            self.begin_oddly(ray);
        }
    }

    /// Finds the first cell where roundings did matter, more than one if the ray has not left those before, and whether
    /// an exit is no number.
    #[inline(never)]
    fn begin_oddly(&mut self, ray: &PreparedRay) {
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

    /// Notes the cells that the ray has not left at `t`, when it crosses a plane of the axis given.
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

    /// The number of the cell at hand.
    #[inline(never)]
    fn tied_cell(&self, at: u32) -> u32 {
        let places = self.lines.iter().zip(self.tie.back);
        places.fold(at, |at, (line, back)| at.wrapping_sub(line.stride.wrapping_mul(back)))
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

    /// The primitives of a cell that the ray may meet, if there are any.
    #[inline(always)]
    fn met(&self, cell: u32, ray: &PreparedRay, enter: f32, limit: f32) -> Option<Met<'a>> {
        let (first, count) = self.cells.of(cell)?;
        let octants = if self.is_tied { 0xff } else { self.on_the_way(ray, enter, limit) };
        Met::of(self.references, self.octants, first, count, octants)
    }

    /// Crosses the next plane of an axis; what is added to the number of the cell.
    #[inline(always)]
    fn cross(&mut self, ray: &PreparedRay, axis: usize) -> u32 {
        let planes = Planes::of(&self.lattice, ray, axis);
        let Some(line) = self.lines.get_mut(axis) else { return 0 };
        line.forward(&planes);
        line.stride
    }

    /// On to the next cell that holds primitives on the ray's way.
    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Met<'a>> {
        if self.begins {
            self.begin(ray);
        }
        let limit = least(beyond(t_max), self.exit);
        let finite = least(limit, f32::MAX);
        let margin = self.margin;
        let (mut at, mut enter, mut is_new) = (self.at, self.enter, self.is_new);
        let step = loop {
            if is_new {
                if BOUNDED {
                    if *budget == 0 {
                        break Step::Paused;
                    }
                    *budget -= 1;
                }
                let cell = if self.is_tied { self.tied_cell(at) } else { at };
                if let Some(met) = self.met(cell, ray, enter, limit) {
                    is_new = false;
                    break Step::Leaf(met);
                }
            }
            is_new = true;
            if self.is_tied && self.next_tied() {
                continue;
            }
            // Across the nearest plane.
            let [x, y, z] = &self.lines;
            let is_y = y.next < x.next;
            let t = if is_y { y.next } else { x.next };
            let is_z = z.next < t;
            let t = if is_z { z.next } else { t };
            let mut axis = if is_z { 2 } else { usize::from(is_y) };
            if t > finite {
                // All at infinity.
                match self.lines.iter().position(|line| line.behind > 0) {
                    Some(other) if !(t > limit) => axis = other,
                    _ => {
                        is_new = false;
                        break Step::Done;
                    }
                }
            }
            at = at.wrapping_add(match axis {
                0 => self.cross(ray, 0),
                1 => self.cross(ray, 1),
                _ => self.cross(ray, 2),
            });
            if !(enter + margin < t) {
                self.tie(ray, t, Some(axis));
            }
            enter = t;
        };
        (self.at, self.enter, self.is_new) = (at, enter, is_new);
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
