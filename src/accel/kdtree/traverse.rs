use super::{KdTree, MAX_DEPTH, node::Node};
use crate::{
    accel::{
        Leaf, Step, Traversal,
        leaf::References,
        segment::{Segment, Waiting, slack_within},
    },
    geometry::{Aabb, PreparedRay, beyond},
    math::{greatest, least},
};

/// The walk through a [`KdTree`]: front to back, a stack of segments that wait.
#[derive(Clone, Debug)]
pub struct KdTraversal<'a, const HEIGHT: usize = MAX_DEPTH> {
    nodes: &'a [Node],
    references: References<'a>,
    slack: f32,
    /// The cell to go on with: the whole at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Segment>,
    /// Far children, the nearest on top.
    waiting: Waiting<HEIGHT>,
}

impl<'a, const HEIGHT: usize> KdTraversal<'a, HEIGHT> {
    #[inline]
    pub(super) fn new(tree: &KdTree<'a, HEIGHT>, bounds: &Aabb, node: u32, ray: &PreparedRay) -> Self {
        let slack = slack_within(bounds, ray);
        Self {
            nodes: tree.nodes,
            references: tree.references,
            slack,
            next: Segment::within(bounds, node, ray, slack),
            waiting: Waiting::new(),
        }
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let (nodes, slack, end) = (self.nodes, self.slack, beyond(t_max));
        // The cell at hand is in registers, not in `self`: that is a third of the instructions.
        let Some(mut cell) = self.next.take().or_else(|| self.waiting.pop(end)) else { return Step::Done };
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
                    0 => match self.waiting.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    },
                    1 => return Step::Leaf(Leaf::of(References::IDENTITY, node.first(), 1)),
                    count => return Step::Leaf(Leaf::of(self.references, node.first(), count)),
                }
                continue;
            }
            // The child on the ray's side first.
            let view = &ray.views[axis as usize];
            let descended = node.is_descended(ray.descending);
            let (left, right) = (cell.node + 1, node.number());
            let near = || if descended { right } else { left };
            let far = || if descended { left } else { right };
            let distance = node.position() - view.origin;
            // Parameters are computed where they are needed. Written so that NaN, the ray in the plane, visits both.
            if node.is_cut() {
                // One child: the cell shrinks to it, or the ray passes it by.
                cell.node = left;
                if node.is_empty_on_the_right() != descended {
                    cell.exit = least(distance * view.exit + slack, cell.exit);
                } else {
                    cell.enter = greatest(distance * view.entry, cell.enter);
                }
                if cell.enter > cell.exit {
                    match self.waiting.pop(end) {
                        Some(next) => cell = next,
                        None => return Step::Done,
                    }
                }
                continue;
            }
            let entry = distance * view.entry;
            if entry > cell.exit {
                cell.node = near();
                continue;
            }
            let exit = distance * view.exit + slack;
            if exit < cell.enter {
                cell.node = far();
            } else {
                let enter = greatest(entry, cell.enter);
                self.waiting.push(Segment { node: far(), enter, exit: cell.exit });
                cell = Segment { node: near(), enter: cell.enter, exit: least(exit, cell.exit) };
            }
        }
    }
}

impl<'a, const HEIGHT: usize> Traversal for KdTraversal<'a, HEIGHT> {
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
