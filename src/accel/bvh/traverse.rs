use super::{
    Bvh, MAX_DEPTH,
    node::{Link, Node, Pair},
};
use crate::{
    accel::{Leaf, Step, Traversal, leaf::References},
    geometry::{Axis, Lattice, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through a [`Bvh`]: the nearer child first, a stack of those that wait.
#[derive(Clone, Debug)]
pub struct BvhTraversal<'a> {
    pairs: &'a [Pair],
    references: References<'a>,
    lattice: Lattice,
    slack: f32,
    /// The box to go on with: the whole at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Cell>,
    /// Boxes entered later than their siblings, those of the deepest pair on top.
    stack: heapless::Vec<Cell, MAX_DEPTH>,
}

/// What is in a box, and where the ray enters that.
#[derive(Clone, Copy, Debug)]
struct Cell {
    link: Link,
    enter: f32,
}

/// A ray among the planes of a lattice.
#[derive(Clone, Copy)]
struct Slabs<'r> {
    ray: &'r PreparedRay,
    lattice: &'r Lattice,
    slack: f32,
}

impl Slabs<'_> {
    /// Where the ray enters a box behind `enter`, and where it leaves that before `exit`: the slab test, NaN being no
    /// bound.
    #[inline(always)]
    fn interval(&self, node: &Node, mut enter: f32, mut exit: f32) -> (f32, f32) {
        for axis in Axis::ALL {
            let view = &self.ray.views[axis as usize];
            // The planes change places where the ray descends.
            let turn = (self.ray.descending >> axis as u32 & 1) * 16;
            let planes = node.planes.of(axis).rotate_right(turn);
            let near = self.lattice.position(axis, planes & 0xffff);
            let far = self.lattice.position(axis, planes >> 16);
            enter = greatest((near - view.origin) * view.entry, enter);
            exit = least((far - view.origin) * view.exit + self.slack, exit);
        }
        (enter, exit)
    }
}

impl<'a> BvhTraversal<'a> {
    #[inline]
    pub(super) fn new(bvh: &Bvh<'a>, ray: &PreparedRay) -> Self {
        // Not filled here, so that it is made where it stays: moving the stack would cost more than many pairs.
        let mut traversal = Self {
            pairs: bvh.pairs,
            references: bvh.references,
            lattice: bvh.lattice,
            slack: 0.0,
            next: None,
            stack: heapless::Vec::new(),
        };
        if let Some((enter, exit)) = bvh.bounds.interval(ray) {
            let enter = greatest(enter, ray.ray().t_min);
            let exit = least(exit, beyond(ray.ray().t_max));
            traversal.slack = slack(enter);
            traversal.next = if enter > exit { None } else { Some(Cell { link: bvh.root, enter }) };
        }
        traversal
    }

    /// The box on top that begins before `end`.
    #[inline(always)]
    fn pop(&mut self, end: f32) -> Option<Cell> {
        loop {
            let cell = self.stack.pop()?;
            if !(cell.enter > end) {
                return Some(cell);
            }
        }
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let (pairs, end, lattice) = (self.pairs, beyond(t_max), self.lattice);
        let slabs = Slabs { ray, lattice: &lattice, slack: self.slack };
        let Some(mut cell) = self.next.take().or_else(|| self.pop(end)) else { return Step::Done };
        while !cell.link.is_leaf() {
            if BOUNDED {
                if *budget == 0 {
                    self.next = Some(cell);
                    return Step::Paused;
                }
                *budget -= 1;
            }
            let Some([left, right]) = pairs.get(cell.link.number() as usize) else { return Step::Done };
            let (left_enter, left_exit) = slabs.interval(left, cell.enter, end);
            let (right_enter, right_exit) = slabs.interval(right, cell.enter, end);
            let left_cell = Cell { link: left.link, enter: left_enter };
            let right_cell = Cell { link: right.link, enter: right_enter };
            // Written so that NaN visits.
            cell = match (left_enter > left_exit, right_enter > right_exit) {
                (false, false) => {
                    let (near, far) =
                        if left_enter > right_enter { (right_cell, left_cell) } else { (left_cell, right_cell) };
                    // Cannot fail: the hierarchy is no deeper than the stack.
                    let _ = self.stack.push(far);
                    near
                }
                (false, true) => left_cell,
                (true, false) => right_cell,
                (true, true) => match self.pop(end) {
                    Some(cell) => cell,
                    None => return Step::Done,
                },
            };
        }
        Step::Leaf(Leaf::of(self.references, cell.link.number(), cell.link.count()))
    }
}

impl<'a> Traversal for BvhTraversal<'a> {
    type Leaf = Leaf<'a>;

    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<Leaf<'a>> {
        match self.advance::<false>(ray, t_max, &mut 0) {
            Step::Leaf(leaf) => Some(leaf),
            Step::Paused | Step::Done => None,
        }
    }

    /// A pair of nodes counts as one.
    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        self.advance::<true>(ray, t_max, budget)
    }
}
