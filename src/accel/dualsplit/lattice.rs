use core::mem;

use super::{DualSplit, MAX_DEPTH, node::Head};
use crate::{
    accel::{
        LatticeAccelerator, LatticeWalk, Leaf,
        lattice_segment::{LatticeSegment, LatticeWaiting},
        leaf::References,
    },
    geometry::LatticePath,
};

/// The walk through a [`DualSplit`] in whole numbers: that of
/// [`DualSplitTraversal`](super::DualSplitTraversal), step by step.
#[derive(Clone, Debug)]
pub struct DualSplitWalk<'a, const HEIGHT: usize = MAX_DEPTH> {
    nodes: &'a [u32],
    references: References<'a>,
    /// Whether the first node was visited.
    has_begun: bool,
    /// Far children, the nearest on top.
    waiting: LatticeWaiting<HEIGHT>,
}

impl<'a, const HEIGHT: usize> LatticeAccelerator for DualSplit<'a, HEIGHT> {
    type Walk = DualSplitWalk<'a, HEIGHT>;

    #[inline(always)]
    fn walk(&self) -> DualSplitWalk<'a, HEIGHT> {
        DualSplitWalk {
            nodes: self.nodes,
            references: self.references,
            has_begun: false,
            waiting: LatticeWaiting::new(),
        }
    }
}

impl<'a, const HEIGHT: usize> LatticeWalk for DualSplitWalk<'a, HEIGHT> {
    type Leaf = Leaf<'a>;

    #[inline(never)]
    fn next_leaf<P: LatticePath>(&mut self, path: &P, depth: i32) -> Option<Leaf<'a>> {
        let nodes = self.nodes;
        let has_begun = mem::replace(&mut self.has_begun, true);
        let mut cell = if has_begun { self.waiting.pop(depth)? } else { LatticeSegment::whole(path) };
        loop {
            let head = Head::from_word(*nodes.get(cell.node as usize)?);
            let axis = head.axis_or_leaf();
            if axis == Head::LEAF {
                return Some(Leaf::of(self.references, head.first(), head.count()));
            }
            let planes = *nodes.get(cell.node as usize + 1)?;
            let child = cell.node + 2;
            if head.is_carve() {
                cell.node = child;
                for (head, plane) in [(head, planes & 0xffff), (head.turned(), planes >> 16)] {
                    let axis = head.axis_or_leaf();
                    if head.is_entered(path.descending()) {
                        cell.enter = path.entry(axis, plane)?.max(cell.enter);
                    } else {
                        cell.exit = path.exit(axis, plane)?.min(cell.exit);
                    }
                    if cell.enter > cell.exit {
                        cell = self.waiting.pop(depth)?;
                        break;
                    }
                }
                continue;
            }
            // The near child ends at the plane in the lower half, the far one begins at the upper.
            let descended = head.is_descended(path.descending());
            let (planes, near, far) =
                if descended { (planes.rotate_left(16), head.right(), child) } else { (planes, child, head.right()) };
            let exit = path.exit(axis, planes & 0xffff)?;
            if exit < cell.enter {
                cell.node = far;
                continue;
            }
            let entry = path.entry(axis, planes >> 16)?;
            if entry <= cell.exit {
                self.waiting.push(far, entry.max(cell.enter), cell.exit);
            }
            cell = LatticeSegment { node: near, enter: cell.enter, exit: exit.min(cell.exit) };
        }
    }
}
