use std::vec::Vec;

use super::node::Node;

/// Puts nodes and references into the order of a walk, leaving out what nothing links to; pairs then stand at odd numbers,
/// behind their parents. `make` makes what is to stand for a node.
pub(super) fn lay_out<N>(nodes: &[Node], references: &[u32], make: impl Fn(Node) -> N) -> (Vec<N>, Vec<u32>) {
    let (mut new, mut list) = (Vec::with_capacity(nodes.len() / 2), Vec::with_capacity(references.len()));
    let Some(&root) = nodes.first() else { return (new, list) };
    new.push(make(root));
    let mut pending = std::vec![(root, 0)];
    while let Some((node, place)) = pending.pop() {
        let (first, count) = (node.first() as usize, node.count() as usize);
        if count > 0 {
            new[place] = make(Node::leaf(node.hull(), list.len() as u32, count as u32));
            list.extend_from_slice(&references[first..first + count]);
        } else {
            let children = new.len();
            new[place] = make(Node::inner(node.hull(), children as u32));
            let [left, right] = [nodes[first], nodes[first + 1]];
            new.extend([make(left), make(right)]);
            pending.extend([(right, children + 1), (left, children)]);
        }
    }
    (new, list)
}
