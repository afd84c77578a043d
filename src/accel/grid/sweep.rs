//! The walk to the end of a ray at once, for queries that do not pause.
//!
//! Parameters are sums in registers, as in Amanatides and Woo's paper, and decide only what roundings cannot change:
//! crossings come in their order if each is later than the last by more than a margin. Where one is not, the cursor
//! begins anew and decides everything.

use super::{Grid, met::Met};
use crate::{
    accel::{Accelerator, leaf::References, visit_by},
    geometry::{Aabb, Axis, AxisView, Lattice, PreparedRay, beyond},
    math::{greatest, least},
};

/// Planes of an axis, equally far apart up to roundings, and the numbers of the cells between them.
#[derive(Clone, Copy, Debug)]
struct Spacing {
    /// The first plane and the last one.
    first: f32,
    last: f32,
    /// The distance from one to the next, and one over that.
    width: f32,
    inverse: f32,
    /// The distance from the first to the last.
    extent: f32,
    /// What is added to a cell's number for the next cell, and for the last one to that of the first.
    stride: u32,
    end: u32,
}

/// A grid's planes as sweeps want them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    axes: [Spacing; 3],
    /// The error of a parameter relative to itself, of as many sums as there are cells along an axis, beside twice the
    /// widening of exits.
    relative: f32,
    /// The error of a plane's place.
    absolute: f32,
}

impl Course {
    pub(super) fn new(lattice: &Lattice, bounds: &Aabb) -> Self {
        let [nx, ny, nz] = Axis::ALL.map(|axis| lattice.last(axis) / 2);
        let spacing = |axis: Axis, count: u32, stride: u32| {
            let (first, step) = lattice.along(axis as u32);
            Spacing {
                first,
                last: lattice.position(axis, lattice.last(axis)),
                width: 2.0 * step,
                inverse: 0.5 / step,
                extent: lattice.extent(axis),
                stride,
                end: count.wrapping_sub(1).wrapping_mul(stride),
            }
        };
        let steps = nx.max(ny).max(nz) as f32;
        let farthest = greatest(bounds.min.abs().max_element(), bounds.max.abs().max_element());
        Self {
            axes: [
                spacing(Axis::X, nx, ny.wrapping_mul(nz)),
                spacing(Axis::Y, ny, nz),
                spacing(Axis::Z, nz, 1),
            ],
            relative: 1.0 / 32_768.0 + steps * (1.0 / 2_097_152.0),
            absolute: farthest * (1.0 / 262_144.0) + f32::MIN_POSITIVE,
        }
    }
}

/// Where a ray crosses the planes of an axis.
struct Crossings {
    next: f32,
    step: f32,
    /// What is added to the number of the cell.
    stride: u32,
    /// The octants in the half of a cell that the ray enters first.
    near: u32,
}

impl Crossings {
    /// The octants of a cell in the halves along this axis that the ray may meet between these parameters.
    #[inline(always)]
    fn halves(&self, enter: f32, exit: f32) -> u32 {
        let middle = self.next - 0.5 * self.step;
        if middle < enter {
            !self.near
        } else if middle > exit {
            self.near
        } else {
            0xff
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
        if t > end {
            return Crossed::End;
        }
        self.next = t + self.step;
        *at = at.wrapping_add(self.stride);
        Crossed::Clear
    }
}

enum Crossed { Clear, Close, End }

impl<'a> Grid<'a> {
    /// See [`Accelerator::visit`].
    #[inline(always)]
    pub(super) fn sweep(&self, ray: &PreparedRay, mut t_max: f32, mut visit: impl FnMut(Met<'a>) -> Option<f32>) {
        if self.primitives == 0 {
            return;
        }
        let Course { axes: [x, y, z], relative, absolute } = &self.course;
        let [vx, vy, vz, _] = &ray.views;
        // Where the ray enters the lattice along an axis, and how long it stays.
        let slab = |spacing: &Spacing, view: &AxisView| {
            let near = if view.ascends() { spacing.first } else { spacing.last };
            let inverse = view.entry.abs();
            ((near - view.origin) * view.entry, spacing.extent * inverse, spacing.width * inverse)
        };
        let (sx, sy, sz) = (slab(x, vx), slab(y, vy), slab(z, vz));
        let t_min = ray.ray().t_min;
        let enter = greatest(greatest(greatest(sx.0, t_min), sy.0), sz.0);
        let exit = least(least(sx.0 + sx.1, sy.0 + sy.1), sz.0 + sz.1);
        let margin = (enter.abs() + exit.abs()) * relative
            + ((vx.exit.abs() + vy.exit.abs()) + vz.exit.abs()) * absolute
            + ((t_min.abs() - t_min) * (1.0 / 4096.0) + 4.0 * f32::MIN_POSITIVE);
        if enter > exit + margin {
            return;
        }
        let enter = enter - margin;
        let mut at = 0_u32;
        let d = ray.ray().direction;
        let mut crossings = |(first, _, step): (f32, f32, f32), spacing: &Spacing, view: &AxisView, d: f32, lower: u32| {
            let before = ((enter - first) * (spacing.inverse * d.abs())) as u32;
            let (number, stride, near) = if view.ascends() {
                (0, spacing.stride, lower)
            } else {
                (spacing.end, spacing.stride.wrapping_neg(), 0xff ^ lower)
            };
            at = at.wrapping_add(number).wrapping_add(before.wrapping_mul(stride));
            Crossings { next: (first + step) + before as i32 as f32 * step, step, stride, near }
        };
        let mut x = crossings(sx, x, vx, d.x, 0x0f);
        let mut y = crossings(sy, y, vy, d.y, 0x33);
        let mut z = crossings(sz, z, vz, d.z, 0x55);
        let behind = exit - 0.5 * margin;
        let (firsts, ends) = match self.cells.offsets {
            References::Narrow(offsets) if self.cells.blocks.is_empty() => {
                (offsets, offsets.get(1..).unwrap_or_default())
            }
            _ => return self.walk(ray, t_max, &mut visit),
        };
        let mut end = least(beyond(t_max) + margin, behind);
        // Crossings before this are close to the last one.
        let mut clear = enter + margin;
        loop {
            if let Some(&last) = ends.get(at as usize)
                && let Some(&first) = firsts.get(at as usize)
                && first != last
            {
                let exit = least(least(x.next, y.next), z.next);
                let (from, to) = (clear - 2.0 * margin, exit + margin);
                let octants = x.halves(from, to) & y.halves(from, to) & z.halves(from, to);
                if let Some(met) = Met::of(self.references, self.octants, first.into(), last.into(), octants) {
                    match visit(met) {
                        Some(t) => t_max = t,
                        None => return,
                    }
                    end = least(beyond(t_max) + margin, behind);
                }
            }
            let crossed = if y.next < x.next {
                if z.next < y.next { z.cross(&mut clear, end, margin, &mut at) } else { y.cross(&mut clear, end, margin, &mut at) }
            } else if z.next < x.next {
                z.cross(&mut clear, end, margin, &mut at)
            } else {
                x.cross(&mut clear, end, margin, &mut at)
            };
            match crossed {
                Crossed::Clear => {}
                Crossed::Close => break,
                Crossed::End => {
                    // Behind what is wanted, or out of the last cell with no other crossing near.
                    let is_near = |t: f32| u32::from(!(t > clear));
                    let near = [&x, &y, &z].map(|line| is_near(line.next) + is_near(line.next + line.step));
                    if end < behind || near[0] + near[1] + near[2] == 1 {
                        return;
                    }
                    break;
                }
            }
        }
        self.walk(ray, t_max, &mut visit);
    }

    /// The same by the cursor, which decides what is close.
    #[cold]
    #[inline(never)]
    fn walk(&self, ray: &PreparedRay, t_max: f32, visit: &mut impl FnMut(Met<'a>) -> Option<f32>) {
        visit_by(self.traverse(ray), ray, t_max, visit);
    }
}
