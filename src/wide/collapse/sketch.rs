use std::{vec, vec::Vec};

use super::plan::Plan;
use crate::wide::{
    block,
    node::{Child, WIDTH},
};

/// A part of the wide tree, before it is written.
#[derive(Debug, Default)]
pub(super) struct Sketch {
    /// Parents before their children.
    pub nodes: Vec<Sketched>,
    /// Words of all blocks.
    pub words: usize,
    /// Nodes below one another.
    pub depth: usize,
    /// Parts that are left to others.
    pub parts: Vec<Left>,
}

/// A node of a [`Sketch`].
#[derive(Debug)]
pub(super) struct Sketched {
    /// The binary nodes that became its children.
    pub children: heapless::Vec<usize, WIDTH>,
    /// What they are, counted from the sketch's first node and word.
    pub named: [Child; WIDTH],
}

/// A part that a sketch leaves out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    /// The binary node whose place it takes.
    pub root: usize,
    /// The node of the sketch that names it, and the place there.
    pub node: usize,
    pub place: usize,
    /// Nodes above it.
    pub depth: usize,
}

impl Sketch {
    /// The part of the tree in the place of the binary node `root`, without parts of at most so many references.
    pub(super) fn new(plan: &Plan<'_>, root: usize, left: u32) -> Self {
        let mut sketch = Self::default();
        // Nodes to be made, where they are named, and how many are above.
        let mut open = vec![(root, None, 0)];
        while let Some((root, named, depth)) = open.pop() {
            let index = sketch.nodes.len();
            if let Some((node, place)) = named {
                if plan.references(root) <= left {
                    sketch.parts.push(Left { root, node, place, depth });
                    continue;
                }
                let parent: &mut Sketched = &mut sketch.nodes[node];
                parent.named[place] = Child::node(index as u32);
            }
            sketch.depth = sketch.depth.max(depth + 1);
            let children = if plan.corners(root) > 0 { heapless::Vec::from_array([root]) } else { plan.children(root) };
            let mut node = Sketched { children, named: [Child::node(0); WIDTH] };
            // Where a walk goes first, that comes first, too.
            for (place, &child) in node.children.iter().enumerate().rev() {
                if plan.corners(child) > 0 {
                    node.named[place] = sketch.block(plan, child);
                }
            }
            let inner = node.children.iter().enumerate().filter(|&(_, &child)| plan.corners(child) == 0);
            open.extend(inner.map(|(place, &child)| (child, Some((index, place)), depth + 1)));
            sketch.nodes.push(node);
        }
        sketch
    }

    /// Adds a block.
    fn block(&mut self, plan: &Plan<'_>, node: usize) -> Child {
        let corners = plan.corners(node);
        let block = Child::block(self.words, corners);
        self.words += block::words(corners, plan.numbers(plan.range(node)).count());
        block
    }
}
