use super::{DualSplit, MAX_DEPTH, node::Head};
use crate::{
    accel::{
        Entry, Leaf, Step, Traversal,
        leaf::References,
        segment::{Segment, Waiting},
        slope::{Slope, Slopes},
    },
    geometry::{PreparedRay, beyond},
    math::{greatest, least},
};

/// The walk through a [`DualSplit`]: front to back, a stack of segments that wait.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct DualSplitTraversal<'a, const HEIGHT: usize = MAX_DEPTH> {
    /// First, where its address is the walk's own: nothing is added for each node.
    slopes: Slopes,
    nodes: &'a [u32],
    references: References<'a>,
    /// The cell to go on with: the whole at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Segment>,
    /// Far children, the nearest on top.
    waiting: Waiting<HEIGHT>,
}

impl<'a, const HEIGHT: usize> DualSplitTraversal<'a, HEIGHT> {
    /// From an entry: its planes are those of the float arithmetic, whose interval the slopes' contains.
    #[inline]
    pub(super) fn within(tree: &DualSplit<'a, HEIGHT>, entry: &Entry, ray: &PreparedRay) -> Self {
        let mut walk = Self::new(tree, ray);
        if walk.next.is_some() {
            walk.next = Segment::of_entry(entry, ray);
        }
        walk
    }

    #[inline]
    pub(super) fn new(tree: &DualSplit<'a, HEIGHT>, ray: &PreparedRay) -> Self {
        let (slopes, next) = Slopes::new(ray, &tree.lattice, 0.0);
        Self { nodes: tree.nodes, references: tree.references, slopes, next, waiting: Waiting::new() }
    }

    /// The nearest segment that begins before `end`, up to there: boxes in it may begin behind.
    #[inline(always)]
    fn pop(&mut self, end: f32) -> Option<Segment> {
        self.waiting.pop(end).map(|segment| segment.up_to(end))
    }

    /// What comes first of a cell in two parts: where the near child ends and which one it is, where the far one begins and
    /// which one that is, which waits if there is something in it for the ray.
    #[inline(always)]
    fn part(&mut self, cell: Segment, slope: Slope, (end, near): (u32, u32), (begin, far): (u32, u32)) -> Segment {
        let exit = slope.exit(end);
        if exit < cell.enter {
            // The far child: as nearly all rays that miss the near one meet it, its plane need not be looked at.
            return Segment { node: far, ..cell };
        }
        let entry = slope.entry(begin);
        if !(entry > cell.exit) {
            self.waiting.push(Segment { node: far, enter: greatest(entry, cell.enter), exit: cell.exit });
        }
        Segment { node: near, enter: cell.enter, exit: least(exit, cell.exit) }
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let (nodes, end) = (self.nodes, beyond(t_max));
        // The cell at hand is in registers, not in `self`: that is a third of the instructions.
        let Some(mut cell) = self.next.take().or_else(|| self.pop(end)) else { return Step::Done };
        loop {
            if BOUNDED {
                if *budget == 0 {
                    self.next = Some(cell);
                    return Step::Paused;
                }
                *budget -= 1;
            }
            let Some(&word) = nodes.get(cell.node as usize) else { return Step::Done };
            let head = Head::from_word(word);
            let Some(&slope) = self.slopes.along(head.axis_or_leaf()) else {
                return Step::Leaf(Leaf::of(self.references, head.first(), head.count()));
            };
            let Some(&planes) = nodes.get(cell.node as usize + 1) else { return Step::Done };
            // Comparisons are written so that NaN, the ray in a plane, visits.
            let child = cell.node + 2;
            if head.is_carve() {
                cell.node = child;
                for (head, plane) in [(head, planes & 0xffff), (head.turned(), planes >> 16)] {
                    let Some(slope) = self.slopes.along(head.axis_or_leaf()) else { return Step::Done };
                    if head.is_entered(ray.descending) {
                        cell.enter = greatest(slope.entry(plane), cell.enter);
                    } else {
                        cell.exit = least(slope.exit(plane), cell.exit);
                    }
                    if cell.enter > cell.exit {
                        break;
                    }
                }
                if cell.enter > cell.exit {
                    match self.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    }
                }
                continue;
            }
            // The left child ends at the plane in the lower half, the right one begins at the upper. A way for each direction,
            // so that nothing has to be exchanged.
            let (left, right) = (planes & 0xffff, planes >> 16);
            cell = if head.is_descended(ray.descending) {
                self.part(cell, slope, (right, head.right()), (left, child))
            } else {
                self.part(cell, slope, (left, child), (right, head.right()))
            };
        }
    }
}

impl<'a, const HEIGHT: usize> Traversal for DualSplitTraversal<'a, HEIGHT> {
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
