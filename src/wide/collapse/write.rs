use glam::Vec3;

use super::{plan::Plan, sketch::Sketch};
use crate::wide::{
    block::{self, Lane},
    node::{Child, Node, WIDTH},
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
    pub(super) fn write(self, plan: &Plan<'_>, sketch: &Sketch) {
        let mut words = self.words;
        for (node, sketched) in self.nodes.iter_mut().zip(&sketch.nodes) {
            *node = Node::empty();
            for (place, &child) in sketched.children.iter().enumerate().rev() {
                let named = sketched.named[place];
                let bounds = &plan.binary.nodes[child].hull().bounds();
                if !named.is_block() {
                    node.set(place, bounds, Child::node(named.0 + self.first_node as u32));
                    continue;
                }
                let corners = named.corners();
                node.set(place, bounds, Child::block(named.first() + self.first_word, corners));
                words = write_block(words, plan, child, corners);
            }
            node.order();
        }
    }
}

/// Writes the block of a binary node; what is left of the words.
fn write_block<'w>(words: &'w mut [u32], plan: &Plan<'_>, node: usize, corners: usize) -> &'w mut [u32] {
    let range = plan.range(node);
    let places = plan.repeats.places(range.clone());
    let mut different = [Vec3::ZERO; WIDTH];
    let all = plan.triangles[range.clone()].iter().flat_map(|of| [of.a, of.b, of.c]);
    for (&place, corner) in places.iter().zip(all) {
        different[usize::from(place) % WIDTH] = corner;
    }
    let lanes: heapless::Vec<Lane, WIDTH> = plan
        .numbers(range)
        .map(|(triangle, number)| Lane { number, corners: [0, 1, 2].map(|corner| places[3 * triangle + corner]) })
        .collect();
    let (block, behind) = words.split_at_mut(block::words(corners, lanes.len()));
    block::write(block, &different[..corners], &lanes);
    behind
}
