//! What the other structures rest on: the slabs of their cells with any rule broken, and shortcuts that look right.

use hitscan::{
    Hit,
    accel::{Hierarchy, Inside, Structure},
    geometry::{Aabb, Axis},
    glam::Vec3,
};

use super::walk::{Shape, Walker};

/// A way that a walk is often written, and that is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortcut {
    /// Grid: a digital differential analyser that never goes back where planes are crossed at once.
    OneCellAtATime,
    /// Grid: a sweep without margin, for which crossings are close only if they are equal.
    SweepWithoutMargin,
    /// Octree: the planes in the middle are crossed at the mean of the parameters of the planes around.
    MeanOfParameters,
    /// Bounded: a ray that misses the box, by plain slabs, is not walked.
    PlainBox,
    /// Bounded: a ray that misses the sphere, by the plain discriminant, is not walked.
    PlainSphere,
    /// Mailbox: what the last ray tested is still marked.
    StaleMailbox,
    /// Instances, R6: the best hit is passed down, wherever the instance ends.
    BestPassedDown,
}

impl Shortcut {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::OneCellAtATime,
        Self::SweepWithoutMargin,
        Self::MeanOfParameters,
        Self::PlainBox,
        Self::PlainSphere,
        Self::StaleMailbox,
        Self::BestPassedDown,
    ];
}

/// Cells along each axis.
const SIDE: usize = 4;

/// A plane of a grid over `bounds`.
fn plane(bounds: &Aabb, axis: Axis, index: usize) -> f32 {
    let (min, max) = (axis.of(bounds.min), axis.of(bounds.max));
    if index == SIDE { max } else { (min + (max - min) * (index as f32 / SIDE as f32)).min(max) }
}

/// A cell of a grid over `bounds`.
fn cell(bounds: &Aabb, at: [usize; 3]) -> Aabb {
    let corner = |step: usize| Vec3::from_array([0, 1, 2].map(|i| plane(bounds, Axis::ALL[i], at[i] + step)));
    Aabb { min: corner(0), max: corner(1) }
}

/// All cells of a grid.
fn cells() -> impl Iterator<Item = [usize; 3]> {
    (0..SIDE.pow(3)).map(|i| [i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE])
}

impl Walker<'_> {
    /// The closest hit by a walk through the boxes of any structure.
    pub fn boxes(mut self, structure: &Structure) -> Option<Hit> {
        let mut stack: Vec<_> = structure.root().into_iter().collect();
        while let Some(cell) = stack.pop() {
            if !self.meets(&cell.bounds) {
                continue;
            }
            match structure.open(&cell) {
                Inside::Cells(cells) => stack.extend(cells.into_iter().flatten()),
                Inside::Leaf(leaf) => leaf.for_each(|primitive| self.test(primitive)),
            }
        }
        self.best
    }

    /// Whether a cell has to be visited.
    fn meets(&self, bounds: &Aabb) -> bool {
        let limit = self.beyond(self.best.map_or(self.ray.t_max, |best| best.t));
        self.interval(bounds).is_some_and(|(enter, exit)| !(enter > limit || exit < self.ray.t_min))
    }

    /// The box of a shape.
    fn around(&self, primitive: u32) -> Aabb {
        match self.shapes[primitive as usize] {
            Shape::Triangle(triangle) => Aabb::around([triangle.a, triangle.b, triangle.c]),
            Shape::Noise(bounds) => bounds,
        }
    }

    /// The box of all shapes.
    fn whole(&self) -> Aabb {
        (0..self.shapes.len() as u32).fold(Aabb::EMPTY, |all, primitive| all.union(&self.around(primitive)))
    }

    /// Tests all shapes that reach into a cell.
    fn visit(&mut self, cell: &Aabb) {
        for primitive in 0..self.shapes.len() as u32 {
            let bounds = self.around(primitive);
            if bounds.min.cmple(cell.max).all() && bounds.max.cmpge(cell.min).all() {
                self.test(primitive);
            }
        }
    }

    /// The closest hit by a shortcut, or as it has to be done.
    pub fn shortcut(mut self, shortcut: Shortcut, taken: bool, before: Option<Walker>) -> Option<Hit> {
        let whole = self.whole();
        match shortcut {
            Shortcut::OneCellAtATime if taken => self.one_cell_at_a_time(&whole),
            Shortcut::MeanOfParameters if taken => self.mean_of_parameters(&whole),
            Shortcut::OneCellAtATime | Shortcut::MeanOfParameters => self.all_cells(&whole),
            Shortcut::SweepWithoutMargin => {
                if !self.sweep(&whole, !taken) {
                    self.all_cells(&whole);
                }
            }
            Shortcut::PlainBox if taken && !self.meets_plainly(&whole) => {}
            Shortcut::PlainSphere if taken && !self.meets_sphere(&whole) => {}
            Shortcut::PlainBox | Shortcut::PlainSphere => return self.list(),
            Shortcut::StaleMailbox => {
                let all = 0..self.shapes.len() as u32;
                let stale = |primitive: &u32| taken && before.as_ref().is_some_and(|b| b.meets(&b.around(*primitive)));
                all.filter(|primitive| !stale(primitive)).for_each(|primitive| self.test(primitive));
            }
            Shortcut::BestPassedDown => self.placed(&whole, taken),
        }
        self.best
    }

    /// All cells that have to be visited, in no order.
    fn all_cells(&mut self, whole: &Aabb) {
        for at in cells() {
            let cell = cell(whole, at);
            if self.meets(&cell) {
                self.visit(&cell);
            }
        }
    }

    /// Planes at sums of parameters, two that are close in both orders; false where more are.
    fn sweep(&mut self, whole: &Aabb, has_margin: bool) -> bool {
        let Some((enter, exit)) = self.interval(whole) else { return true };
        let start = if enter > self.ray.t_min { enter } else { self.ray.t_min };
        let farthest = whole.min.abs().max(whole.max.abs()).max_element();
        let margin = exit.max(-start) * (1.0 / 32_768.0 + SIDE as f32 / 2_097_152.0)
            + self.views.iter().map(|view| view.1.abs()).sum::<f32>() * (farthest / 262_144.0)
            + (self.ray.t_min.abs() - self.ray.t_min) / 4096.0
            + 4.0 * f32::MIN_POSITIVE;
        let margin = if has_margin { margin } else { 0.0 * margin };
        let width = (whole.max - whole.min) / SIDE as f32;
        let step = Axis::ALL.map(|axis| axis.of(width) * self.views[axis as usize].0.abs());
        let ahead = Axis::ALL.map(|axis| if self.ascends(axis) { 1 } else { -1 });
        let mut at = ahead.map(|ahead| if ahead > 0 { 0 } else { SIDE as i32 - 1 });
        let mut next = Axis::ALL.map(|axis| {
            let near = plane(whole, axis, if self.ascends(axis) { 0 } else { SIDE });
            (near - axis.of(self.ray.origin)) * self.views[axis as usize].0 + step[axis as usize]
        });
        for axis in 0..3 {
            while next[axis] <= start - margin && (0..SIDE as i32).contains(&at[axis]) {
                next[axis] += step[axis];
                at[axis] += ahead[axis];
            }
        }
        let mut clear = start - 2.0 * margin;
        loop {
            if at.iter().all(|index| (0..SIDE as i32).contains(index)) {
                self.visit(&cell(whole, at.map(|index| index as usize)));
            }
            let axis = (0..3).min_by(|&a, &b| next[a].total_cmp(&next[b])).unwrap();
            let t = next[axis];
            if !(clear < t) {
                let is_next = |axis: &usize| !(next[*axis] > t + 2.0 * margin);
                let is_last = |axis: &usize| !(next[*axis] - step[*axis] < t - 2.0 * margin);
                let [of_next, of_last] = [(0..3).filter(is_next).collect::<Vec<_>>(), (0..3).filter(is_last).collect()];
                let (&[of_next], &[of_last]) = (&of_next[..], &of_last[..]) else { return false };
                if of_next == of_last {
                    return false;
                }
                next[of_next] += step[of_next];
                at[of_next] += ahead[of_next];
                next[of_last] -= step[of_last];
                at[of_last] -= ahead[of_last];
                clear = next[of_last] - margin;
                if !(clear < next[of_last]) {
                    clear = f32::NEG_INFINITY;
                }
                continue;
            }
            clear = t + margin;
            if t > self.beyond(self.best.map_or(self.ray.t_max, |best| best.t)) + margin || t > exit + margin {
                return true;
            }
            next[axis] = t + step[axis];
            at[axis] += ahead[axis];
        }
    }

    /// Amanatides and Woo 1987, to the letter.
    fn one_cell_at_a_time(&mut self, whole: &Aabb) {
        let Some((enter, _)) = self.interval(whole) else { return };
        let start = if enter > self.ray.t_min { enter } else { self.ray.t_min };
        // The plane of an axis behind a cell, as the ray goes.
        let far = |walker: &Self, axis: Axis, index: usize| {
            let plane = plane(whole, axis, index + usize::from(walker.ascends(axis)));
            walker.exit((plane - axis.of(walker.ray.origin)) * walker.views[axis as usize].1)
        };
        let mut at = Axis::ALL.map(|axis| {
            let ascends = self.ascends(axis);
            let along = |i: &usize| if ascends { *i } else { SIDE - 1 - *i };
            let first = (0..SIDE - 1).find(|i| !(far(self, axis, along(i)) < start)).unwrap_or(SIDE - 1);
            along(&first)
        });
        loop {
            self.visit(&cell(whole, at));
            let next = |axis: &Axis| far(self, *axis, at[*axis as usize]);
            let axis = Axis::ALL.into_iter().min_by(|a, b| next(a).total_cmp(&next(b))).unwrap();
            if next(&axis) > self.beyond(self.best.map_or(self.ray.t_max, |best| best.t)) {
                return;
            }
            let index = &mut at[axis as usize];
            let Some(step) = (if self.ascends(axis) { Some(*index + 1) } else { index.checked_sub(1) }) else { return };
            if step == SIDE {
                return;
            }
            *index = step;
        }
    }

    /// Revelles, Ureña and Lastra 2000: parameters of planes as means.
    fn mean_of_parameters(&mut self, whole: &Aabb) {
        for at in cells() {
            let (mut enter, mut exit) = (self.ray.t_min, self.beyond(self.ray.t_max));
            for axis in Axis::ALL {
                let view = self.views[axis as usize];
                let at_plane = |plane: f32, view: f32| (plane - axis.of(self.ray.origin)) * view;
                let mean = |index: usize, view: f32| {
                    let (a, b) = (at_plane(axis.of(whole.min), view), at_plane(axis.of(whole.max), view));
                    let (half, quarter) = ((a + b) * 0.5, [(a + (a + b) * 0.5) * 0.5, ((a + b) * 0.5 + b) * 0.5]);
                    [a, quarter[0], half, quarter[1], b][index]
                };
                let (near, far) = if self.ascends(axis) { (0, 1) } else { (1, 0) };
                let (entry, leave) = (mean(at[axis as usize] + near, view.0), mean(at[axis as usize] + far, view.1));
                enter = if entry > enter { entry } else { enter };
                exit = if self.exit(leave) < exit { self.exit(leave) } else { exit };
            }
            if !(enter > exit) {
                self.visit(&cell(whole, at));
            }
        }
    }

    /// Kay and Kajiya 1986, to the letter.
    fn meets_plainly(&self, bounds: &Aabb) -> bool {
        let (mut enter, mut exit) = (self.ray.t_min, self.ray.t_max);
        for axis in Axis::ALL {
            let (origin, inverse) = (axis.of(self.ray.origin), 1.0 / axis.of(self.ray.direction));
            let (a, b) = ((axis.of(bounds.min) - origin) * inverse, (axis.of(bounds.max) - origin) * inverse);
            (enter, exit) = (enter.max(a.min(b)), exit.min(a.max(b)));
        }
        enter <= exit
    }

    /// Whether the line comes as near to the middle as the corners are.
    fn meets_sphere(&self, bounds: &Aabb) -> bool {
        let (middle, d) = (bounds.center(), self.ray.direction);
        let (to, radius) = (middle - self.ray.origin, (bounds.max - middle).length());
        let reach = to.dot(d);
        !(reach * reach - d.dot(d) * (to.dot(to) - radius * radius) < 0.0)
    }

    /// Shapes that are hit anywhere, two in each instance, whose box is the first one's.
    fn placed(&mut self, whole: &Aabb, best_passed_down: bool) {
        for first in (0..self.shapes.len() as u32).step_by(2) {
            let bounds = self.around(first).intersection(whole);
            let Some((enter, exit)) = self.interval(&bounds) else { continue };
            let limit = if best_passed_down { self.best.map_or(self.ray.t_max, |best| best.t) } else { f32::INFINITY };
            for primitive in (first..first + 2).take(self.shapes.len()) {
                let t = crate::common::noise(primitive, &self.ray);
                if !(t > limit) {
                    let t = if t < enter { enter } else { t };
                    self.offer(if t > exit { exit } else { t }, primitive);
                }
            }
        }
    }
}
