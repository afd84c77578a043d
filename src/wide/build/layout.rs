use std::vec::Vec;

use crate::wide::binary::{Binary, BinaryNode};

/// Puts nodes and references into the order of a walk, in which pairs stand at odd numbers, behind their parents.
pub(super) fn lay_out(old: &Binary) -> Binary {
    let mut new =
        Binary { nodes: Vec::with_capacity(old.nodes.len()), references: Vec::with_capacity(old.references.len()) };
    new.nodes.extend(old.nodes.first());
    let mut pending: Vec<usize> = (0..new.nodes.len()).collect();
    while let Some(place) = pending.pop() {
        let node = new.nodes[place];
        let (first, count) = (node.first(), node.count());
        if count > 0 {
            new.nodes[place] = BinaryNode::leaf(node.hull(), new.references.len(), count);
            new.references.extend_from_slice(&old.references[first..first + count]);
        } else {
            let children = new.nodes.len();
            new.nodes[place] = BinaryNode::inner(node.hull(), children);
            new.nodes.extend_from_slice(&old.nodes[first..first + 2]);
            pending.extend([children + 1, children]);
        }
    }
    new
}
