//! The wide tree of least cost within a binary one: Ylitie, Karras and Laine, *Efficient incoherent ray traversal on GPUs
//! through compressed wide BVHs*, 2017.

use std::{vec, vec::Vec};

use super::{
    binary::Binary,
    node::{Child, Node, TRIANGLE_WORDS, WIDTH},
    tree::Tree,
};
use crate::geometry::Triangle;

/// The most triangles in a block.
const LEAF_SIZE: u32 = WIDTH as u32;

/// What a ray's visit to a node costs.
const NODE: f32 = 1.0;

/// What its visit to a block costs, however many triangles there are in it.
const BLOCK: f32 = 0.9;

/// What each triangle adds.
const TRIANGLE: f32 = 0.05;

/// The least costs of a part of the binary tree, as at most 1, 2, … 7 children of a wide node.
type Costs = [f32; WIDTH - 1];

/// What is known of the parts below each binary node.
struct Plan<'b> {
    binary: &'b Binary,
    costs: Vec<Costs>,
    counts: Vec<u32>,
}

impl<'b> Plan<'b> {
    fn new(binary: &'b Binary) -> Self {
        let count = binary.nodes.len();
        let mut plan = Self { binary, costs: vec![[0.0; WIDTH - 1]; count], counts: vec![0; count] };
        // Children stand behind their parents.
        for (index, node) in binary.nodes.iter().enumerate().rev() {
            let area = node.bounds.half_area();
            if node.count > 0 {
                plan.counts[index] = node.count;
                plan.costs[index] = [area * leaf_cost(node.count); WIDTH - 1];
                continue;
            }
            let (left, right) = (node.first as usize, node.first as usize + 1);
            let triangles = plan.counts[left].saturating_add(plan.counts[right]);
            plan.counts[index] = triangles;
            let mut costs = [0.0; WIDTH - 1];
            costs[0] = area * NODE + plan.divided(index, WIDTH).0;
            if triangles <= LEAF_SIZE {
                costs[0] = costs[0].min(area * leaf_cost(triangles));
            }
            for places in 2..WIDTH {
                costs[places - 1] = costs[places - 2].min(plan.divided(index, places).0);
            }
            plan.costs[index] = costs;
        }
        plan
    }

    /// The least cost of a node's children in this many places, at least two, and how many the left one gets.
    fn divided(&self, node: usize, places: usize) -> (f32, usize) {
        let left = self.binary.nodes[node].first as usize;
        let (left, right) = (&self.costs[left], &self.costs[left + 1]);
        let split = |of_left: usize| (left[of_left - 1] + right[places - of_left - 1], of_left);
        (1..places).map(split).reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap_or((f32::INFINITY, 1))
    }

    /// Whether the part below a binary node becomes a block.
    fn is_block(&self, node: usize) -> bool {
        let (count, bounds) = (self.counts[node], &self.binary.nodes[node].bounds);
        self.binary.nodes[node].count > 0
            || (count <= LEAF_SIZE && bounds.half_area() * leaf_cost(count) <= self.costs[node][0])
    }

    /// The binary nodes that become the children of the wide node in the place of `node`.
    fn children(&self, node: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(WIDTH);
        let mut open = vec![(node, WIDTH)];
        while let Some((node, mut places)) = open.pop() {
            while places > 1 && places < WIDTH && self.costs[node][places - 1] == self.costs[node][places - 2] {
                places -= 1;
            }
            if places == 1 || self.binary.nodes[node].count > 0 {
                children.push(node);
                continue;
            }
            let (left, of_left) = (self.binary.nodes[node].first as usize, self.divided(node, places).1);
            open.push((left + 1, places - of_left));
            open.push((left, of_left));
        }
        children
    }

    /// The triangles below a binary node.
    fn references(&self, node: usize) -> Vec<u32> {
        let mut references = Vec::with_capacity(LEAF_SIZE as usize);
        let mut open = vec![node];
        while let Some(index) = open.pop() {
            let node = &self.binary.nodes[index];
            let (first, count) = (node.first as usize, node.count as usize);
            if count == 0 {
                open.extend([first + 1, first]);
            } else {
                references.extend(&self.binary.references[first..first + count]);
            }
        }
        // A triangle that was split may be back in one piece.
        references.sort_unstable();
        references.dedup();
        references
    }
}

fn leaf_cost(triangles: u32) -> f32 {
    BLOCK + TRIANGLE * triangles as f32
}

/// The wide tree within `binary`.
pub(super) fn collapse(binary: &Binary, triangle: impl Fn(u32) -> Triangle) -> Tree {
    let mut tree = Tree::default();
    let Some(root) = binary.nodes.first() else { return tree };
    tree.bounds = root.bounds;
    let plan = Plan::new(binary);
    if plan.is_block(0) {
        tree.root = Some(push_block(&mut tree.blocks, &plan.references(0), &triangle));
    } else {
        tree.root = Some(Child::node(0));
        // Nodes to be made, and where they are named.
        let mut open = vec![(0, None, 1)];
        while let Some((binary_node, named, depth)) = open.pop() {
            tree.stack = tree.stack.max((WIDTH - 1) * depth + 1);
            let index = tree.nodes.len();
            if let Some((node, place)) = named {
                let parent: &mut Node = &mut tree.nodes[node];
                parent.set(place, &binary.nodes[binary_node].bounds, Child::node(index as u32));
            }
            tree.nodes.push(Node::empty(Child::block(0, 1)));
            let children = plan.children(binary_node);
            for (place, &child) in children.iter().enumerate() {
                if plan.is_block(child) {
                    let block = push_block(&mut tree.blocks, &plan.references(child), &triangle);
                    tree.nodes[index].set(place, &binary.nodes[child].bounds, block);
                }
            }
            let inner = children.iter().enumerate().filter(|&(_, &child)| !plan.is_block(child));
            open.extend(inner.map(|(place, &child)| (child, Some((index, place)), depth + 1)).rev());
        }
    }
    tree.nodes.iter_mut().for_each(Node::order);
    // So that eight lanes can be read of any row.
    tree.blocks.extend([0; TRIANGLE_WORDS * WIDTH]);
    tree
}

/// Writes the rows of a block: a coordinate of all its triangles after the other, then their numbers.
fn push_block(blocks: &mut Vec<u32>, references: &[u32], triangle: &impl Fn(u32) -> Triangle) -> Child {
    let first = blocks.len() / TRIANGLE_WORDS;
    for row in 0..TRIANGLE_WORDS - 1 {
        blocks.extend(references.iter().map(|&number| {
            let Triangle { a, b, c } = triangle(number);
            [a, b, c][row / 3][row % 3].to_bits()
        }));
    }
    blocks.extend(references);
    Child::block(first as u32, references.len() as u32)
}
