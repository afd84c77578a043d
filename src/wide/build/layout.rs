use std::vec::Vec;

use super::node::Node;

/// Puts nodes and references into the order of a walk, leaving out what nothing links to; pairs then stand at odd numbers,
/// behind their parents.
pub(super) fn lay_out(nodes: &[Node], references: &[u32]) -> (Vec<Node>, Vec<u32>) {
    let (mut new, mut list) = (Vec::with_capacity(nodes.len() / 2), Vec::with_capacity(references.len()));
    new.extend(nodes.first());
    // Places of nodes that still have the links of old.
    let mut pending: Vec<usize> = (0..new.len()).collect();
    while let Some(place) = pending.pop() {
        let node: Node = new[place];
        let (first, count) = (node.first() as usize, node.count() as usize);
        if count > 0 {
            new[place] = Node::leaf(node.hull(), list.len() as u32, count as u32);
            list.extend_from_slice(&references[first..first + count]);
        } else {
            let children = new.len();
            new[place] = Node::inner(node.hull(), children as u32);
            new.extend_from_slice(&nodes[first..first + 2]);
            pending.extend([children + 1, children]);
        }
    }
    (new, list)
}
