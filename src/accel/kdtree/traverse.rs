use super::{
    KdTree, MAX_DEPTH,
    node::{Kind, Node},
};
use crate::{
    accel::{Leaf, Step, Traversal, leaf::References},
    geometry::{PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through a [`KdTree`]: front to back, a stack of far children.
///
/// A stack entry is a node with the entry and exit of its cell. (The entry cannot be had from the exit of the cell just
/// left: a ray in a plane is in both cells all the time.)
#[derive(Clone, Debug)]
pub struct KdTraversal<'a> {
    nodes: &'a [Node],
    references: References<'a>,
    /// The node to visit next, if the ray is in one.
    node: Option<u32>,
    enter: f32,
    exit: f32,
    slack: f32,
    stack: heapless::Vec<Entry, MAX_DEPTH>,
}

/// A far child that waits.
#[derive(Clone, Copy, Debug)]
struct Entry {
    node: u32,
    enter: f32,
    exit: f32,
}

impl<'a> KdTraversal<'a> {
    pub(super) fn new(tree: &KdTree<'a>, ray: &PreparedRay) -> Self {
        let mut traversal = Self {
            nodes: tree.nodes,
            references: tree.references,
            node: None,
            enter: 0.0,
            exit: 0.0,
            slack: 0.0,
            stack: heapless::Vec::new(),
        };
        if let Some((enter, exit)) = tree.bounds.interval(ray) {
            traversal.enter = greatest(enter, ray.ray().t_min);
            traversal.exit = least(exit, beyond(ray.ray().t_max));
            traversal.slack = slack(traversal.enter);
            traversal.node = if traversal.enter > traversal.exit { None } else { Some(0) };
        }
        traversal
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        loop {
            let Some(index) = self.node else {
                let Some(entry) = self.stack.pop() else { return Step::Done };
                if !(entry.enter > beyond(t_max)) {
                    self.node = Some(entry.node);
                    self.enter = entry.enter;
                    self.exit = entry.exit;
                }
                continue;
            };
            if BOUNDED {
                if *budget == 0 {
                    return Step::Paused;
                }
                *budget -= 1;
            }
            let Some(node) = self.nodes.get(index as usize) else { return Step::Done };
            match node.kind() {
                Kind::Inner { axis, position, right } => {
                    // The child on the ray's side first.
                    let view = &ray.views[axis as usize];
                    let (near, far) = if view.ascends() { (index + 1, right) } else { (right, index + 1) };
                    let distance = position - view.origin;
                    let entry = distance * view.entry;
                    let exit = distance * view.exit + self.slack;
                    // Written so that NaN, the ray in the plane, visits both.
                    if entry > self.exit {
                        self.node = Some(near);
                    } else if exit < self.enter {
                        self.node = Some(far);
                    } else {
                        // Cannot fail: the tree is no deeper than the stack.
                        let enter = greatest(entry, self.enter);
                        let _ = self.stack.push(Entry { node: far, enter, exit: self.exit });
                        self.node = Some(near);
                        self.exit = least(exit, self.exit);
                    }
                }
                Kind::Leaf { first, count } => {
                    self.node = None;
                    match count {
                        0 => {}
                        1 => return Step::Leaf(Leaf::consecutive(first, 1)),
                        _ => return Step::Leaf(Leaf::of(self.references, first, count)),
                    }
                }
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
