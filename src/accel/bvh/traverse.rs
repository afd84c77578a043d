use super::{
    Bvh, MAX_DEPTH,
    node::{Link, Node, Pair},
};
use crate::{
    accel::{Entry, Leaf, Step, Traversal, leaf::References, segment::Segment, slope::Slopes},
    geometry::{Axis, PreparedRay, beyond},
    math::{greatest, least},
};

/// The walk through a [`Bvh`]: the nearer child first, a stack of those that wait.
#[derive(Clone, Debug)]
pub struct BvhTraversal<'a> {
    pairs: &'a [Pair],
    references: References<'a>,
    slopes: Slopes,
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

/// Where a ray that descends along the axes of `descending` enters a box behind `enter`, and where it leaves that before
/// `exit`: the slab test, NaN being no bound.
#[inline(always)]
fn interval(node: &Node, slopes: &Slopes, descending: u32, mut enter: f32, mut exit: f32) -> (f32, f32) {
    for axis in Axis::ALL {
        let slope = slopes.of(axis);
        // The planes change places where the ray descends.
        let turn = (descending >> axis as u32 & 1) * 16;
        let planes = node.planes.of(axis).rotate_right(turn);
        enter = greatest(slope.entry(planes & 0xffff), enter);
        exit = least(slope.exit(planes >> 16), exit);
    }
    (enter, exit)
}

impl<'a> BvhTraversal<'a> {
    /// From an entry: its planes are those of the float arithmetic, whose interval the slopes' contains.
    #[inline]
    pub(super) fn within(bvh: &Bvh<'a>, entry: &Entry, ray: &PreparedRay) -> Self {
        let mut walk = Self::new(bvh, ray);
        if walk.next.is_some() {
            walk.next =
                Segment::of_entry(entry, ray).map(|part| Cell { link: Link::from_bits(part.node), enter: part.enter });
        }
        walk
    }

    #[inline]
    pub(super) fn new(bvh: &Bvh<'a>, ray: &PreparedRay) -> Self {
        let (slopes, whole) = Slopes::new(ray, &bvh.lattice, 0.0);
        // The stack is not filled here, so that it is made where it stays: moving it would cost more than many pairs.
        Self {
            pairs: bvh.pairs,
            references: bvh.references,
            slopes,
            next: whole.map(|whole| Cell { link: bvh.root, enter: whole.enter }),
            stack: heapless::Vec::new(),
        }
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
        let (pairs, end, descending) = (self.pairs, beyond(t_max), ray.descending);
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
            let (left_enter, left_exit) = interval(left, &self.slopes, descending, cell.enter, end);
            let (right_enter, right_exit) = interval(right, &self.slopes, descending, cell.enter, end);
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
