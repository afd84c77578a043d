use super::{plan::Plan, sketch::Sketch};
use crate::{
    geometry::Triangle,
    wide::{
        block,
        node::{Child, Node, WIDTH},
    },
};

/// The places of a part of the tree.
#[derive(Debug)]
pub(super) struct Places<'t> {
    pub nodes: &'t mut [Node],
    pub words: &'t mut [u32],
    /// The numbers of the first node and word.
    pub first_node: usize,
    pub first_word: usize,
}

impl Places<'_> {
    /// The first of them, as many as a part needs.
    pub(super) fn split_off(&mut self, part: &Sketch) -> Self {
        let (count, words) = (part.nodes.len(), part.words);
        let first = Self {
            nodes: self.nodes.split_off_mut(..count).unwrap_or_default(),
            words: self.words.split_off_mut(..words).unwrap_or_default(),
            ..*self
        };
        self.first_node += count;
        self.first_word += words;
        first
    }

    /// Writes nodes and blocks.
    pub(super) fn write(self, plan: &Plan<'_>, sketch: &Sketch, triangle: &impl Fn(u32) -> Triangle) {
        let (mut all, mut words) = (&sketch.triangles[..], self.words);
        for (node, sketched) in self.nodes.iter_mut().zip(&sketch.nodes) {
            *node = Node::empty();
            for (place, &child) in sketched.children.iter().enumerate().rev() {
                let named = sketched.named[place];
                let bounds = &plan.binary.nodes[child].bounds;
                if !named.is_block() {
                    node.set(place, bounds, Child::node(named.0 + self.first_node as u32));
                    continue;
                }
                let corners = named.corners();
                node.set(place, bounds, Child::block(named.first() + self.first_word, corners));
                let (numbers, rest) = all.split_at(usize::from(sketched.counts[place]));
                let (block, behind) = words.split_at_mut(block::words(corners, numbers.len()));
                let triangles: heapless::Vec<Triangle, WIDTH> =
                    numbers.iter().map(|&number| triangle(number)).collect();
                block::write(block, numbers, &triangles);
                (all, words) = (rest, behind);
            }
            node.order();
        }
    }
}
