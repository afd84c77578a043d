use super::{CompactKdTree, node::Node};
use crate::{
    accel::{
        Entry, Leaf, Step, Traversal,
        kdtree::MAX_DEPTH,
        leaf::References,
        segment::{Segment, Waiting},
        slope::Slopes,
    },
    geometry::{PreparedRay, beyond},
    math::{greatest, least},
};

/// The walk through a [`CompactKdTree`]: that through a [`KdTree`](crate::KdTree), step by step, but its planes are
/// numbers and its children some words ahead.
#[derive(Clone, Debug)]
pub struct CompactKdTraversal<'a, const HEIGHT: usize = MAX_DEPTH> {
    nodes: &'a [u32],
    references: References<'a>,
    slopes: Slopes,
    /// The cell to go on with: the whole at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Segment>,
    /// Far children, the nearest on top.
    waiting: Waiting<HEIGHT>,
}

impl<'a, const HEIGHT: usize> CompactKdTraversal<'a, HEIGHT> {
    /// From an entry: its planes are those of the float arithmetic, whose interval the slopes' contains.
    #[inline]
    pub(super) fn within(tree: &CompactKdTree<'a, HEIGHT>, entry: &Entry, ray: &PreparedRay) -> Self {
        let mut walk = Self::new(tree, ray);
        if walk.next.is_some() {
            walk.next = Segment::of_entry(entry, ray);
        }
        walk
    }

    #[inline]
    pub(super) fn new(tree: &CompactKdTree<'a, HEIGHT>, ray: &PreparedRay) -> Self {
        let (slopes, next) = Slopes::new(ray, &tree.lattice, 1.0);
        Self { nodes: tree.nodes, references: tree.references, slopes, next, waiting: Waiting::new() }
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let (nodes, end) = (self.nodes, beyond(t_max));
        let Some(mut cell) = self.next.take().or_else(|| self.waiting.pop(end)) else { return Step::Done };
        loop {
            if BOUNDED {
                if *budget == 0 {
                    self.next = Some(cell);
                    return Step::Paused;
                }
                *budget -= 1;
            }
            let Some(&word) = nodes.get(cell.node as usize) else { return Step::Done };
            let node = Node::from_word(word);
            let Some(slope) = self.slopes.along(node.axis_or_leaf()) else {
                if node.count() != 0 {
                    return Step::Leaf(node.leaf_in(nodes, cell.node, self.references));
                }
                match self.waiting.pop(end) {
                    Some(next) => cell = next,
                    None => return Step::Done,
                }
                continue;
            };
            // The child on the ray's side first.
            let descended = node.is_descended(ray.descending);
            // The far child begins at one face of a plane that is a step thick, the near one ends at the other.
            let (entry, exit) = (slope.entry(node.plane()), slope.exit(node.plane()));
            // Written so that NaN, the ray in the plane, visits both.
            if node.is_cut() {
                // One child: the cell shrinks to it, or the ray passes it by.
                let passed = if node.is_empty_on_the_right() != descended {
                    cell.exit = least(exit, cell.exit);
                    exit < cell.enter
                } else {
                    cell.enter = greatest(entry, cell.enter);
                    entry > cell.exit
                };
                cell.node += 1;
                if passed {
                    match self.waiting.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    }
                }
                continue;
            }
            let (left, right) = node.children(nodes, cell.node);
            let (near, far) = if descended { (right, left) } else { (left, right) };
            if entry > cell.exit {
                cell.node = near;
            } else if exit < cell.enter {
                cell.node = far;
            } else {
                let enter = greatest(entry, cell.enter);
                self.waiting.push(Segment { node: far, enter, exit: cell.exit });
                cell = Segment { node: near, enter: cell.enter, exit: least(exit, cell.exit) };
            }
        }
    }
}

impl<'a, const HEIGHT: usize> Traversal for CompactKdTraversal<'a, HEIGHT> {
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
