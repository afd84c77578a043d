//! The tree over primitives in the order of its leaves.

use super::{
    KdTree,
    node::{Kind, Node},
    open::Header,
};
use crate::accel::leaf::References;

impl<'a> KdTree<'a> {
    /// The primitives in the order of the leaves, each as often as leaves name it.
    pub fn order(&self) -> impl Iterator<Item = u32> + use<'a> {
        let references = self.references;
        self.leaves().flat_map(move |(first, count)| {
            let references = if count == 1 { References::IDENTITY } else { references };
            (first..first.saturating_add(count)).map(move |index| references.get(index))
        })
    }

    /// Whether it is over primitives in the order of the leaves, and so holds no references: each leaf is a range.
    #[must_use]
    pub fn is_ordered(&self) -> bool {
        self.reference_count == 0 && self.leaves().any(|(_, count)| count > 1)
    }

    /// The words of the same tree over what the caller has put into [`order`](Self::order): without references.
    pub fn ordered_words(&self) -> impl Iterator<Item = u32> + use<'a> {
        // A walk's words cannot name more than a link's bits can.
        let primitives = self.leaves().fold(0_u32, |sum, (_, count)| sum.saturating_add(count));
        let header = Header {
            nodes: self.nodes.len() as u32,
            references: 0,
            primitives,
            depth: self.depth,
            bounds: self.bounds,
        };
        let nodes = self.nodes.iter().scan(0_u32, |place, node| {
            Some(match node.kind() {
                Kind::Leaf { count, .. } => {
                    let first = *place;
                    *place = first.saturating_add(count);
                    Node::leaf(first, count)
                }
                Kind::Inner { .. } => *node,
            })
        });
        header.to_words().into_iter().chain(nodes.flat_map(Node::to_words))
    }

    /// The first reference and the count of each leaf.
    fn leaves(&self) -> impl Iterator<Item = (u32, u32)> + use<'a> {
        self.nodes.iter().filter_map(|node| match node.kind() {
            Kind::Leaf { first, count } => Some((first, count)),
            Kind::Inner { .. } => None,
        })
    }
}
