use std::{boxed::Box, vec::Vec};

use crate::wide::{
    binary::{Binary, BinaryNode},
    hull::Hull,
};

/// A hierarchy while all threads make it: a part made by one of them, or two that are larger.
#[derive(Debug)]
pub(super) enum Branch {
    /// With its root first, in the order of a walk; numbers count from its own first node and reference.
    Part(Binary),
    /// In a box.
    Pair(Hull, Box<[Self; 2]>),
}

impl Branch {
    /// How many nodes there are below the root, and how many references.
    fn size(&self) -> [usize; 2] {
        match self {
            Self::Part(part) => [part.nodes.len() - 1, part.references.len()],
            Self::Pair(_, both) => {
                let [left, right] = [both[0].size(), both[1].size()];
                [2 + left[0] + right[0], left[1] + right[1]]
            }
        }
    }

    /// The whole, in the order of a walk.
    pub(super) fn join(self) -> Binary {
        let [below, count] = self.size();
        let mut nodes: Vec<BinaryNode> = bytemuck::zeroed_vec(below + 1);
        let mut references = bytemuck::zeroed_vec(count);
        if let Some((root, below)) = nodes.split_first_mut() {
            *root = self.write(Places { nodes: below, references: &mut references, first_node: 1, first_reference: 0 });
        }
        Binary { nodes, references }
    }

    /// Writes what is below the root; the root.
    fn write(self, places: Places<'_>) -> BinaryNode {
        match self {
            Self::Part(part) => {
                places.references.copy_from_slice(&part.references);
                let move_up = |node: &BinaryNode| match node.count() {
                    0 => BinaryNode::inner(node.hull(), node.first() + places.first_node - 1),
                    count => BinaryNode::leaf(node.hull(), node.first() + places.first_reference, count),
                };
                for (place, node) in places.nodes.iter_mut().zip(&part.nodes[1..]) {
                    *place = move_up(node);
                }
                move_up(&part.nodes[0])
            }
            Self::Pair(hull, both) => {
                let first = places.first_node;
                let (pair, [of_left, of_right]) = places.split(both[0].size());
                let [left, right] = *both;
                let (left, right) = rayon::join(|| left.write(of_left), || right.write(of_right));
                pair.copy_from_slice(&[left, right]);
                BinaryNode::inner(hull, first)
            }
        }
    }
}

/// Where a branch goes.
struct Places<'t> {
    nodes: &'t mut [BinaryNode],
    references: &'t mut [u32],
    /// The numbers of the first ones.
    first_node: usize,
    first_reference: usize,
}

impl<'t> Places<'t> {
    /// Those of a pair, and those of what is below its nodes, where the left one needs so many.
    fn split(self, [nodes, references]: [usize; 2]) -> (&'t mut [BinaryNode], [Self; 2]) {
        let (pair, below) = self.nodes.split_at_mut(2);
        let (left, right) = (below.split_at_mut(nodes), self.references.split_at_mut(references));
        let first = self.first_node + 2;
        let of_left =
            Self { nodes: left.0, references: right.0, first_node: first, first_reference: self.first_reference };
        let of_right = Self {
            nodes: left.1,
            references: right.1,
            first_node: first + nodes,
            first_reference: self.first_reference + references,
        };
        (pair, [of_left, of_right])
    }
}
