use super::{DualSplit, MAX_DEPTH, node::Head};
use crate::{
    accel::{
        Entry, Leaf, Step, Traversal,
        leaf::References,
        segment::{Segment, Waiting},
        slope::Slopes,
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
            let Some(slope) = self.slopes.along(head.axis_or_leaf()) else {
                return Step::Leaf(Leaf::of(self.references, head.first(), head.count()));
            };
            let Some(&planes) = nodes.get(cell.node as usize + 1) else { return Step::Done };
            // Comparisons are written so that NaN, the ray in a plane, visits.
            let child = cell.node + 2;
            if head.is_carve() {
                cell.node = child;
                for (head, plane) in [(head, planes & 0xffff), (head.turned(), planes >> 16)] {
                    let Some(slope) = self.slopes.along(head.axis_or_leaf()) else { return Step::Done };
                    if head.is_upper() == head.is_descended(ray.descending) {
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
            // The near child ends at the plane in the lower half, the far one begins at the upper.
            let descended = head.is_descended(ray.descending);
            let planes = if descended { planes.rotate_left(16) } else { planes };
            let near = || if descended { head.right() } else { child };
            let far = || if descended { child } else { head.right() };
            let exit = slope.exit(planes & 0xffff);
            if exit < cell.enter {
                // The far child: as nearly all rays that miss the near one meet it, its plane need not be looked at.
                cell.node = far();
                continue;
            }
            let entry = slope.entry(planes >> 16);
            if !(entry > cell.exit) {
                self.waiting.push(Segment { node: far(), enter: greatest(entry, cell.enter), exit: cell.exit });
            }
            cell = Segment { node: near(), enter: cell.enter, exit: least(exit, cell.exit) };
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
