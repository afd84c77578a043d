//! The walk to the end of a ray at once, for queries that do not pause.
//!
//! Parameters are sums in registers, as in Amanatides and Woo's paper, and decide only what roundings cannot change:
//! crossings come in their order if each is later than the last by more than a margin. Of two that are closer, both
//! orders are taken. Where three are, the cursor begins anew and decides everything.

use core::hint::black_box;

use super::{
    Grid,
    along::Along,
    cells::{Cells, OFFSET},
    course::{Course, Side, Spacing},
    met::Met,
};
use crate::{
    accel::{Accelerator, leaf::References, visit_by},
    geometry::{Axis, AxisView, Lattice, PreparedRay, beyond},
    math::{greatest, least},
};

/// Where a ray crosses the planes of an axis.
pub(super) struct Crossings<'c> {
    pub(super) next: f32,
    step: f32,
    /// What is added to the number of the cell.
    stride: u32,
    side: &'c Side,
}

impl<'c> Crossings<'c> {
    /// Where a ray crosses the first plane, and where the last.
    #[inline(always)]
    pub(super) fn of(spacing: &'c Spacing, view: &AxisView) -> (Self, f32) {
        let side = &spacing.sides[(view.entry.to_bits() >> 31) as usize];
        let inverse = view.entry.abs();
        let next = (side.plane - view.origin) * view.entry;
        (Self { next, step: spacing.width * inverse, stride: side.stride, side }, next + spacing.extent * inverse)
    }

    /// Crosses all planes but one up to `from`: what the number of the cell has from this axis.
    #[inline(always)]
    pub(super) fn skip(&mut self, spacing: &Spacing, direction: f32, from: f32) -> u32 {
        let per_cell = spacing.inverse * direction.abs();
        let before = ((from - self.next) * per_cell) as u32;
        self.next = (self.next + self.step) + before as i32 as f32 * self.step;
        self.side.number.wrapping_add(before.wrapping_mul(self.stride))
    }

    /// The same where it crosses the next plane at `next`, or none: see [`Along`].
    #[inline(always)]
    fn at(self, next: f32) -> Self {
        if next.abs() < f32::INFINITY { Self { next, ..self } } else { Self { next: f32::MAX, step: next, ..self } }
    }

    /// The octants of a cell in the halves along this axis that the ray may meet between these parameters.
    #[inline(always)]
    fn halves(&self, enter: f32, exit: f32) -> u32 {
        let middle = self.next - 0.5 * self.step;
        if middle < enter {
            0xff ^ self.side.near
        } else if middle > exit {
            self.side.near
        } else {
            0xff
        }
    }

    /// Crosses the next plane or goes back across the last, if a bit says so.
    #[inline(always)]
    fn turn(&mut self, turned: u32, axis: Axis, at: &mut u32) {
        if turned >> axis as u32 & 1 != 0 {
            self.next += self.step;
            *at = at.wrapping_add(self.stride);
        }
        if turned >> (axis as u32 + 3) & 1 != 0 {
            self.next -= self.step;
            *at = at.wrapping_sub(self.stride);
        }
    }

    /// Crosses the next plane.
    #[inline(always)]
    fn cross(&mut self, clear: &mut f32, end: f32, margin: f32, at: &mut u32) -> Crossed {
        let t = self.next;
        if !(*clear < t) {
            return Crossed::Close;
        }
        *clear = t + margin;
        self.next = t + self.step;
        if t > end {
            return Crossed::End;
        }
        *at = at.wrapping_add(self.stride);
        Crossed::Clear
    }
}

/// What takes the next plane and the last one in their other order, by [`Crossings::turn`]: a bit for the axis of the next one, and
/// above them a bit for that of the last; nothing if others are close to them.
#[cold]
#[inline(never)]
fn turned(x: f32, x_step: f32, y: f32, y_step: f32, z: f32, z_step: f32, margin: f32) -> u32 {
    let t = least(least(x, y), z);
    let (past, ahead) = (t - 2.0 * margin, t + 2.0 * margin);
    // Written so that NaN is close. What is an infinite step before the next plane was not crossed.
    let [x, y, z] = [(x, x_step), (y, y_step), (z, z_step)].map(|(next, step)| {
        let (is_next, is_last) = (!(next > ahead), !(next - step < past) && step.abs() < f32::INFINITY);
        u32::from(is_next) | u32::from(is_last) << 3
    });
    let close = x | y << 1 | z << 2;
    match close {
        // Of two axes, one bit each.
        0o12 | 0o14 | 0o21 | 0o24 | 0o41 | 0o42 => close,
        _ => 0,
    }
}

/// What came of crossing a plane.
enum Crossed {
    /// The next cell.
    Clear,
    /// Nothing: it is close to the crossing before.
    Close,
    /// No cell: the plane is behind the end.
    End,
}

/// A table of cells, as a sweep asks it.
trait Table {
    /// What it says of a cell in which there is something; nothing of others.
    fn look(&self, cell: u32) -> Option<u32>;

    /// The octants in which there may be something.
    fn octants(said: u32) -> u32;

    /// The first reference and the one behind the last.
    fn references(&self, cell: u32, said: u32) -> Option<(u32, u32)>;
}

/// A word per cell: an offset and octants.
struct Words<'a>(&'a [u32]);

impl Table for Words<'_> {
    #[inline(always)]
    fn look(&self, cell: u32) -> Option<u32> {
        self.0.get(cell as usize).copied().filter(|&word| word > OFFSET)
    }

    #[inline(always)]
    fn octants(said: u32) -> u32 {
        said >> 24
    }

    #[inline(always)]
    fn references(&self, cell: u32, said: u32) -> Option<(u32, u32)> {
        let next = *self.0.get(cell.wrapping_add(1) as usize)?;
        Some((said & OFFSET, next & OFFSET))
    }
}

impl Table for Cells<'_> {
    #[inline(always)]
    fn look(&self, cell: u32) -> Option<u32> {
        self.rank(cell)
    }

    #[inline(always)]
    fn octants(_said: u32) -> u32 {
        0xff
    }

    #[inline(always)]
    fn references(&self, _cell: u32, said: u32) -> Option<(u32, u32)> {
        self.offsets.pair(said)
    }
}

/// Where a sweep is.
struct Sweep<'c> {
    x: Crossings<'c>,
    y: Crossings<'c>,
    z: Crossings<'c>,
    /// The number of the cell at hand.
    at: u32,
    /// Crossings before this are close to the last one.
    clear: f32,
    margin: f32,
    /// Where the ray is about to leave the last cell.
    behind: f32,
}

impl<'c> Sweep<'c> {
    /// At the beginning of a ray; none if it misses the bounds.
    #[inline(always)]
    fn of(course: &'c Course, lattice: &Lattice, ray: &PreparedRay) -> Option<Self> {
        let [x, y, z] = &course.axes;
        let [vx, vy, vz, _] = &ray.views;
        let ((mut x, x_exit), (mut y, y_exit), (mut z, z_exit)) =
            (Crossings::of(x, vx), Crossings::of(y, vy), Crossings::of(z, vz));
        let t_min = ray.ray().t_min;
        let enter = greatest(greatest(greatest(x.next, t_min), y.next), z.next);
        let exit = least(least(x_exit, y_exit), z_exit);
        let margin = course.margin(enter, exit, (vx.exit.abs() + vy.exit.abs()) + vz.exit.abs(), t_min);
        let length = exit + margin - enter;
        // Negative, infinite or NaN, by one comparison.
        if length.to_bits() >= f32::INFINITY.to_bits() {
            if length < 0.0 {
                return None;
            }
            // Read anew: else all rays would compute and keep before the comparison what only these take from here.
            let (course, ray) = black_box((course, ray));
            let mut along = Along::default();
            let at = along.begin(course, lattice, ray)?;
            let Along { next: [x_next, y_next, z_next], clear, behind, margin } = along;
            let ([x, y, z], [vx, vy, vz, _]) = (&course.axes, &ray.views);
            let ((x, _), (y, _), (z, _)) = (Crossings::of(x, vx), Crossings::of(y, vy), Crossings::of(z, vz));
            let (x, y, z) = (x.at(x_next), y.at(y_next), z.at(z_next));
            return Some(Self { x, y, z, at, clear, margin, behind });
        }
        let mut at = 0_u32;
        for (line, axis) in [&mut x, &mut y, &mut z].into_iter().zip(Axis::ALL) {
            at = at.wrapping_add(line.skip(&course.axes[axis as usize], axis.of(ray.ray().direction), enter - margin));
        }
        Some(Self { x, y, z, at, clear: enter - 2.0 * margin, margin, behind: exit - 0.5 * margin })
    }

    /// To the end of the ray; false if that is not reached, because two crossings are close.
    #[inline(always)]
    fn run<'a, T: Table>(
        self,
        table: T,
        entries: &'a [u16],
        t_max: f32,
        visit: &mut impl FnMut(Met<'a>) -> Option<f32>,
    ) -> bool {
        let Self { mut x, mut y, mut z, mut at, mut clear, margin, behind } = self;
        let mut end = least(beyond(t_max) + margin, behind);
        loop {
            if let Some(said) = table.look(at) {
                let exit = least(least(x.next, y.next), z.next);
                let (from, to) = (clear - 2.0 * margin, exit + margin);
                let octants = x.halves(from, to) & y.halves(from, to) & z.halves(from, to);
                if octants & T::octants(said) != 0
                    && let Some(references) = table.references(at, said)
                    && let Some(met) = Met::new(entries, references, octants)
                {
                    let Some(t_max) = visit(met) else { return true };
                    end = least(beyond(t_max) + margin, behind);
                }
            }
            let crossed = if y.next < x.next {
                if z.next < y.next {
                    z.cross(&mut clear, end, margin, &mut at)
                } else {
                    y.cross(&mut clear, end, margin, &mut at)
                }
            } else if z.next < x.next {
                z.cross(&mut clear, end, margin, &mut at)
            } else {
                x.cross(&mut clear, end, margin, &mut at)
            };
            match crossed {
                Crossed::Clear => {}
                Crossed::Close => {
                    let turned = turned(x.next, x.step, y.next, y.step, z.next, z.step, margin);
                    if turned == 0 {
                        return false;
                    }
                    x.turn(turned, Axis::X, &mut at);
                    y.turn(turned, Axis::Y, &mut at);
                    z.turn(turned, Axis::Z, &mut at);
                    clear = least(least(x.next, y.next), z.next) - margin;
                }
                // Behind what is wanted.
                Crossed::End if end < behind => return true,
                // Out of the last cell, if no other crossing is near.
                Crossed::End => return (x.next > clear) & (y.next > clear) & (z.next > clear),
            }
        }
    }
}

impl<'a> Grid<'a> {
    /// See [`Accelerator::visit`].
    #[inline(always)]
    pub(super) fn sweep(&self, ray: &PreparedRay, t_max: f32, mut visit: impl FnMut(Met<'a>) -> Option<f32>) {
        match self.cells.offsets {
            References::Wide(words) if self.cells.mask == OFFSET => {
                self.sweep_over(Words(words), ray, t_max, &mut visit)
            }
            _ if !self.cells.blocks.is_empty() => self.sweep_over(self.cells, ray, t_max, &mut visit),
            _ => self.walk(ray, t_max, &mut visit),
        }
    }

    #[inline(always)]
    fn sweep_over(
        &self,
        table: impl Table,
        ray: &PreparedRay,
        t_max: f32,
        visit: &mut impl FnMut(Met<'a>) -> Option<f32>,
    ) {
        let Some(sweep) = Sweep::of(&self.course, &self.lattice, ray) else { return };
        if !sweep.run(table, self.entries, t_max, visit) {
            self.walk(ray, t_max, visit);
        }
    }

    /// The same by the cursor, which decides what is close.
    #[cold]
    #[inline(never)]
    fn walk(&self, ray: &PreparedRay, t_max: f32, visit: &mut impl FnMut(Met<'a>) -> Option<f32>) {
        visit_by(self.traverse(ray), ray, t_max, visit);
    }
}
