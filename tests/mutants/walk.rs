//! The walk through the words of a kD-tree, and the list, written again with rules that can be broken.

use hitscan::{
    Hit, PreparedRay, Ray,
    geometry::{Aabb, Axis, Triangle},
    glam::Vec3,
};

use crate::common::noise;

/// A rule broken, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutant {
    /// All rules as they are.
    Right,
    /// R1: an axis whose reciprocal overflows is taken for parallel.
    ContainmentForOverflow,
    /// R1: exits use the cut reciprocal too where it overflows.
    CutExitsForOverflow,
    /// R1: rays that reach back treat overflow as others do.
    OverflowReachesBack,
    /// R2: exits are where they are.
    NoWidening,
    /// R2: exits are multiplied only, which narrows where they are negative.
    FactorOnly,
    /// R2: exits are widened by a factor of their magnitude, with nothing for underflow.
    NoTiny,
    /// R2: a cell's exits are widened less than those of the boxes in it.
    ThinSlack,
    /// R2: comparisons are written so that NaN skips.
    NanSkips,
    /// The far child is entered where the near one is left.
    EnterAtExit,
    /// R4: what lies behind the best hit is skipped at once.
    PruneAtBest,
    /// R5: shapes that are not certified are not clamped to their bounds.
    NoClamp,
    /// R7: triangles are rejected by their corners' parameters, without slack.
    RejectAtBest,
}

use Mutant::*;

impl Mutant {
    /// All that are wrong.
    pub const ALL: [Self; 12] = [
        ContainmentForOverflow,
        CutExitsForOverflow,
        OverflowReachesBack,
        NoWidening,
        FactorOnly,
        NoTiny,
        ThinSlack,
        NanSkips,
        EnterAtExit,
        PruneAtBest,
        NoClamp,
        RejectAtBest,
    ];
}

/// A shape that the walk can test.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Certified.
    Triangle(Triangle),
    /// A box hit at [`noise`].
    Noise(Aabb),
}

/// A ray under the rules.
pub struct Walker<'a> {
    mutant: Mutant,
    pub shapes: &'a [Shape],
    prepared: PreparedRay,
    pub ray: Ray,
    /// Reciprocals for entries and exits per axis.
    pub views: [(f32, f32); 3],
    pub best: Option<Hit>,
}

const TINY: f32 = f32::MIN_POSITIVE;

impl<'a> Walker<'a> {
    pub fn new(mutant: Mutant, shapes: &'a [Shape], ray: &Ray) -> Option<Self> {
        let prepared = ray.prepare()?;
        let ray = *prepared.ray();
        let mut walker = Self { mutant, shapes, prepared, ray, views: [(0.0, 0.0); 3], best: None };
        walker.views = ray.direction.to_array().map(|d| walker.view(d));
        Some(walker)
    }

    fn view(&self, direction: f32) -> (f32, f32) {
        let inverse = 1.0 / direction;
        let exit = inverse * (1.0 + self.widening());
        let cut = inverse.clamp(f32::MIN, f32::MAX);
        if direction == 0.0 || exit.is_finite() {
            return (inverse, exit);
        }
        match self.mutant {
            ContainmentForOverflow => (inverse / 0.0_f32.copysign(1.0), exit),
            CutExitsForOverflow => (cut, cut),
            OverflowReachesBack => (cut, exit),
            _ if self.ray.t_min >= 0.0 => (cut, exit),
            _ => (f32::NAN, f32::NAN),
        }
    }

    fn widening(&self) -> f32 {
        if self.mutant == NoWidening { 0.0 } else { 1.0 / 65536.0 }
    }

    fn tiny(&self) -> f32 {
        if matches!(self.mutant, NoWidening | FactorOnly | NoTiny) { 0.0 } else { TINY }
    }

    /// The widened parameter of a box's far side.
    pub fn exit(&self, t: f32) -> f32 {
        let narrowed = t < 0.0 && self.mutant != FactorOnly;
        (if narrowed { t * (1.0 - 4.0 * self.widening()) } else { t }) + self.tiny()
    }

    fn slack(&self, t: f32) -> f32 {
        match self.mutant {
            FactorOnly => 0.0,
            ThinSlack => TINY - t.min(0.0) * (4.0 * self.widening()),
            _ => 2.0 * self.tiny() - t.min(0.0) * (8.0 * self.widening()),
        }
    }

    pub fn beyond(&self, t: f32) -> f32 {
        if self.mutant == PruneAtBest { t } else { t + t.abs() * (4.0 * self.widening()) + 4.0 * self.tiny() }
    }

    pub fn ascends(&self, axis: Axis) -> bool {
        !self.views[axis as usize].0.is_sign_negative()
    }

    pub fn interval(&self, aabb: &Aabb) -> Option<(f32, f32)> {
        let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in Axis::ALL {
            let (min, max) = (axis.of(aabb.min), axis.of(aabb.max));
            let (near, far) = if self.ascends(axis) { (min, max) } else { (max, min) };
            let (origin, view) = (axis.of(self.ray.origin), self.views[axis as usize]);
            // Both give the second number where the first is NaN.
            enter = if (near - origin) * view.0 > enter { (near - origin) * view.0 } else { enter };
            let far = self.exit((far - origin) * view.1);
            exit = if far < exit { far } else { exit };
        }
        (enter <= exit).then_some((enter, exit))
    }

    /// The parameter at which it hits a shape, if that may matter.
    fn crossing(&self, index: u32) -> Option<f32> {
        let limit = self.best.map_or(self.ray.t_max, |best| best.t);
        match self.shapes[index as usize] {
            Shape::Triangle(triangle) => {
                if self.mutant == RejectAtBest {
                    let axis = Axis::of_largest(self.ray.direction);
                    let inverse = self.views[axis as usize].0;
                    let t =
                        [triangle.a, triangle.b, triangle.c].map(|v| (axis.of(v) - axis.of(self.ray.origin)) * inverse);
                    if t.iter().all(|&t| t > limit) || t.iter().all(|&t| t < self.ray.t_min) {
                        return None;
                    }
                }
                Some(triangle.intersect(&self.prepared, self.ray.t_min, limit)?.t)
            }
            Shape::Noise(bounds) => {
                let t = noise(index, &self.ray);
                let (enter, exit) = self.interval(&bounds)?;
                let t = if t < enter && self.mutant != NoClamp { enter } else { t };
                Some(if t > exit && self.mutant != NoClamp { exit } else { t })
            }
        }
    }

    pub fn test(&mut self, primitive: u32) {
        if let Some(t) = self.crossing(primitive) {
            self.offer(t, primitive);
        }
    }

    /// Takes a hit that counts.
    pub fn offer(&mut self, t: f32, primitive: u32) {
        if t >= self.ray.t_min && t <= self.ray.t_max {
            let hit = Hit { t, primitive };
            if self.best.is_none_or(|best| hit.precedes(&best)) {
                self.best = Some(hit);
            }
        }
    }

    /// The closest hit by trying all shapes.
    pub fn list(mut self) -> Option<Hit> {
        (0..self.shapes.len() as u32).for_each(|index| self.test(index));
        self.best
    }

    /// The closest hit by a walk through `words`.
    pub fn tree(mut self, words: &[u32]) -> Option<Hit> {
        let (header, rest) = words.split_at(10);
        let (nodes, references) = rest.split_at(header[0] as usize * 2);
        let corner = |i: usize| Vec3::from_array([0, 1, 2].map(|k| f32::from_bits(header[i + k])));
        let (enter, exit) = self.interval(&Aabb::new(corner(4), corner(7)))?;
        let (enter, exit) = (enter.max(self.ray.t_min), exit.min(self.beyond(self.ray.t_max)));
        let slack = self.slack(enter);
        let mut stack = vec![];
        if !(enter > exit) {
            stack.push((0, enter, exit));
        }
        while let Some((index, enter, exit)) = stack.pop() {
            if self.best.is_some_and(|best| enter > self.beyond(best.t)) {
                continue;
            }
            let (payload, link) = (nodes[2 * index], nodes[2 * index + 1]);
            let number = (link >> 4) as usize;
            if link & 3 == 3 {
                for reference in payload as usize..payload as usize + number {
                    let word = || references[reference / 2] >> (16 * (reference % 2)) & 0xffff;
                    self.test(if number == 1 { payload } else { word() });
                }
                continue;
            }
            let axis = Axis::ALL[(link & 3) as usize];
            // Of a cut's children one is empty, and the other is the next node, by either number.
            let children = [(index + 1, link & 4 == 0), (number, link & 8 == 0)];
            let [left, right] = children.map(|(child, there)| there.then_some(child));
            let (near, far) = if self.ascends(axis) { (left, right) } else { (right, left) };
            let distance = f32::from_bits(payload) - axis.of(self.ray.origin);
            let view = self.views[axis as usize];
            let (entry, leave) = (distance * view.0, distance * view.1 + slack);
            let (only_near, only_far) = if self.mutant == NanSkips {
                (!(entry <= exit), !(leave >= enter))
            } else {
                (entry > exit, leave < enter)
            };
            let entry = if self.mutant == EnterAtExit { leave } else { entry };
            if only_near {
                stack.extend(near.map(|near| (near, enter, exit)));
            } else if only_far {
                stack.extend(far.map(|far| (far, enter, exit)));
            } else {
                stack.extend(far.map(|far| (far, if entry > enter { entry } else { enter }, exit)));
                stack.extend(near.map(|near| (near, enter, if leave < exit { leave } else { exit })));
            }
        }
        self.best
    }
}
