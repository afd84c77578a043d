use super::{KdTree, MAX_DEPTH, node::Node};
use crate::{
    accel::{Leaf, Step, Traversal, leaf::References},
    geometry::{PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through a [`KdTree`]: front to back, a stack of cells that wait.
#[derive(Clone, Debug)]
pub struct KdTraversal<'a> {
    nodes: &'a [Node],
    references: References<'a>,
    slack: f32,
    /// The cell to go on with: the whole at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Cell>,
    /// Far children, the nearest on top.
    stack: heapless::Vec<Cell, MAX_DEPTH>,
}

/// A node with the entry and exit of its cell.
///
/// (The entry cannot be had from the exit of the cell just left: a ray in a plane is in both cells all the time.)
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) node: u32,
    pub(super) enter: f32,
    pub(super) exit: f32,
}

impl<'a> KdTraversal<'a> {
    #[inline]
    pub(super) fn new(tree: &KdTree<'a>, ray: &PreparedRay) -> Self {
        // Not filled here, so that it is made where it stays: moving the stack would cost more than a hundred nodes.
        let mut traversal = Self {
            nodes: tree.nodes,
            references: tree.references,
            slack: 0.0,
            next: None,
            stack: heapless::Vec::new(),
        };
        if let Some((enter, exit)) = tree.bounds.interval(ray) {
            let enter = greatest(enter, ray.ray().t_min);
            let exit = least(exit, beyond(ray.ray().t_max));
            traversal.slack = slack(enter);
            traversal.next = if enter > exit { None } else { Some(Cell { node: 0, enter, exit }) };
        }
        traversal
    }

    /// The nearest cell that begins before `end`.
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
        let (nodes, slack, end) = (self.nodes, self.slack, beyond(t_max));
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
            let Some(node) = nodes.get(cell.node as usize) else { return Step::Done };
            let axis = node.axis_or_leaf();
            if axis == Node::LEAF {
                match node.number() {
                    0 => match self.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    },
                    1 => return Step::Leaf(Leaf::of(References::wide(node.payload()), 0, 1)),
                    count => return Step::Leaf(Leaf::of(self.references, node.first(), count)),
                }
                continue;
            }
            // The child on the ray's side first.
            let view = &ray.views[axis as usize];
            let descended = node.is_descended(ray.descending);
            let (left, right) = (cell.node + 1, node.number());
            let (near, far) = if descended { (right, left) } else { (left, right) };
            let distance = node.position() - view.origin;
            let entry = distance * view.entry;
            let exit = distance * view.exit + slack;
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
                cell.node = left;
                if passed {
                    match self.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    }
                }
            } else if entry > cell.exit {
                cell.node = near;
            } else if exit < cell.enter {
                cell.node = far;
            } else {
                // Cannot fail: the tree is no deeper than the stack.
                let enter = greatest(entry, cell.enter);
                let _ = self.stack.push(Cell { node: far, enter, exit: cell.exit });
                cell = Cell { node: near, enter: cell.enter, exit: least(exit, cell.exit) };
            }
        }
    }
}

impl<'a> Traversal for KdTraversal<'a> {
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
