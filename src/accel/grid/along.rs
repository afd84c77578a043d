//! Where a sweep begins whose ray is along planes.

use super::{
    course::{Course, Spacing},
    sweep::Crossings,
};
use crate::{
    geometry::{Axis, AxisView, Lattice, PreparedRay},
    math::{greatest, least},
};

/// The beginning of a sweep along an axis or two, whose parameters come from the other axes.
///
/// The ray crosses no plane of an axis if, by its own parameters (ARCHITECTURE.md, R1 and R2), it has left the near plane of a cell
/// before the part that counts and enters the far one behind it: then no other cell of the axis has a carrier. These are no sums,
/// so nothing needs a margin. Where the ray is in a plane, or its direction is not quite 0 and one is near, the cursor decides.
#[derive(Default)]
pub(super) struct Along {
    /// Where it crosses the next planes. Not finite where it crosses none: [`NEAR`], [`FAR`] or [`BOTH`].
    pub(super) next: [f32; 3],
    pub(super) clear: f32,
    pub(super) behind: f32,
    pub(super) margin: f32,
}

/// In which halves of its cell a ray stays, as steps before a plane that it never comes to: half of one before, it would cross
/// the middle later than all that counts, or earlier, or nobody knows when.
const NEAR: f32 = f32::NEG_INFINITY;
const FAR: f32 = f32::INFINITY;
const BOTH: f32 = f32::NAN;

impl Along {
    /// In no cell, all crossings close: the cursor decides.
    const CLOSE: Self = Self { next: [BOTH; 3], clear: f32::NAN, behind: 0.0, margin: f32::NAN };

    /// Begins; the number of the cell, or none if the ray misses the bounds.
    #[cold]
    #[inline(never)]
    pub(super) fn begin(&mut self, course: &Course, lattice: &Lattice, ray: &PreparedRay) -> Option<u32> {
        let t_min = ray.ray().t_min;
        let (mut enter, mut exit, mut reciprocals) = (t_min, f32::INFINITY, 0.0);
        let crosses = |view: &AxisView| view.exit.abs() < f32::INFINITY;
        for (spacing, view) in course.axes.iter().zip(&ray.views).filter(|(_, view)| crosses(view)) {
            let (line, end) = Crossings::of(spacing, view);
            (enter, exit) = (greatest(line.next, enter), least(end, exit));
            reciprocals += view.exit.abs();
        }
        let margin = course.margin(enter, exit, reciprocals, t_min);
        let (from, to) = (enter - margin, exit + margin);
        if enter > to {
            return None;
        }
        // Other rays whose parameters overflow come here, too.
        let mut is_close = !(to - from < f32::MAX);
        let mut at = 0_u32;
        for (axis, next) in Axis::ALL.into_iter().zip(&mut self.next) {
            let (spacing, view) = (&course.axes[axis as usize], &ray.views[axis as usize]);
            let number;
            if crosses(view) {
                let (mut line, _) = Crossings::of(spacing, view);
                number = line.skip(spacing, axis.of(ray.ray().direction), from);
                *next = line.next;
                // It would be taken for one that crosses nothing.
                is_close |= !(line.next.abs() < f32::INFINITY);
            } else {
                match Place::of(spacing, (lattice, axis), view, (from, to)) {
                    Place::Within(half, cell) => (*next, number) = (half, cell),
                    Place::Close => (is_close, number) = (true, 0),
                    Place::Outside => return None,
                }
            }
            at = at.wrapping_add(number);
        }
        if is_close {
            *self = Self::CLOSE;
            return Some(u32::MAX);
        }
        (self.clear, self.behind, self.margin) = (enter - 2.0 * margin, exit - 0.5 * margin, margin);
        Some(at)
    }
}

/// Where a ray is along an axis: in these halves of a cell, whose number has this from it; close to a plane; outside the bounds.
enum Place {
    Within(f32, u32),
    Close,
    Outside,
}

impl Place {
    /// That from `from` to `to`.
    fn of(spacing: &Spacing, (lattice, axis): (&Lattice, Axis), view: &AxisView, (from, to): (f32, f32)) -> Self {
        // Written so that NaN is neither.
        let is_before = |plane: f32| (plane - view.origin) * view.entry > to;
        let is_behind = |plane: f32| (plane - view.origin) * view.exit < from;
        let [ascending, descending] = &spacing.sides;
        let (first, last) = if view.ascends() { (ascending, descending) } else { (descending, ascending) };
        if is_before(first.plane) || is_behind(last.plane) {
            return Self::Outside;
        }
        let count = lattice.last(axis) / 2;
        let cell = (((view.origin - ascending.plane) * spacing.inverse) as u32).min(count.wrapping_sub(1));
        let [below, middle, above] = [0, 1, 2].map(|plane| lattice.position(axis, 2 * cell + plane));
        let (near, far) = if view.ascends() { (below, above) } else { (above, below) };
        if !(is_behind(near) && is_before(far)) {
            return Self::Close;
        }
        let half = match (is_before(middle), is_behind(middle)) {
            (true, _) => NEAR,
            (_, true) => FAR,
            _ => BOTH,
        };
        Self::Within(half, cell.wrapping_mul(ascending.stride))
    }
}
