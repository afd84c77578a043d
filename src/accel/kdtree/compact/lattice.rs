use core::mem;

use super::{CompactKdTree, node::Node};
use crate::{
    accel::{
        LatticeAccelerator, LatticeWalk, Leaf,
        kdtree::MAX_DEPTH,
        lattice_segment::{LatticeSegment, LatticeWaiting},
        leaf::References,
    },
    geometry::LatticePath,
};

/// The walk through a [`CompactKdTree`] in whole numbers.
///
/// Its planes are numbers of 14 bits. Times four, they are those of 16 bits up to three; what lies between a plane and the
/// next one is behind the first and before the second, and both are within what a ray allows for.
#[derive(Clone, Debug)]
pub struct CompactKdWalk<'a, const HEIGHT: usize = MAX_DEPTH> {
    nodes: &'a [u32],
    references: References<'a>,
    /// Whether the first node was visited.
    has_begun: bool,
    /// Far children, the nearest on top.
    waiting: LatticeWaiting<HEIGHT>,
}

impl<'a, const HEIGHT: usize> LatticeAccelerator for CompactKdTree<'a, HEIGHT> {
    type Walk = CompactKdWalk<'a, HEIGHT>;

    #[inline(always)]
    fn walk(&self) -> CompactKdWalk<'a, HEIGHT> {
        CompactKdWalk {
            nodes: self.nodes,
            references: self.references,
            has_begun: false,
            waiting: LatticeWaiting::new(),
        }
    }
}

impl<'a, const HEIGHT: usize> LatticeWalk for CompactKdWalk<'a, HEIGHT> {
    type Leaf = Leaf<'a>;

    #[inline(never)]
    fn next_leaf<P: LatticePath>(&mut self, path: &P, depth: i32) -> Option<Leaf<'a>> {
        let nodes = self.nodes;
        let has_begun = mem::replace(&mut self.has_begun, true);
        let mut cell = if has_begun { self.waiting.pop(depth)? } else { LatticeSegment::whole(path) };
        loop {
            let node = Node::from_word(*nodes.get(cell.node as usize)?);
            let axis = node.axis_or_leaf();
            if axis == Node::LEAF {
                if node.count() != 0 {
                    return Some(node.leaf_in(nodes, cell.node, self.references));
                }
                cell = self.waiting.pop(depth)?;
                continue;
            }
            // The child on the ray's side first.
            let descended = node.is_descended(path.descending());
            let plane = node.plane() << 2;
            let (entry, exit) = (path.entry(axis, plane)?, path.exit(axis, plane)?);
            if node.is_cut() {
                // One child: the cell shrinks to it, or the ray passes it by.
                if node.is_empty_on_the_right() != descended {
                    cell.exit = exit.min(cell.exit);
                } else {
                    cell.enter = entry.max(cell.enter);
                }
                cell.node += 1;
                if cell.enter > cell.exit {
                    cell = self.waiting.pop(depth)?;
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
                self.waiting.push(far, entry.max(cell.enter), cell.exit);
                cell = LatticeSegment { node: near, enter: cell.enter, exit: exit.min(cell.exit) };
            }
        }
    }
}
