//! The wide tree of least cost within a binary one: Ylitie, Karras and Laine, *Efficient incoherent ray traversal on GPUs
//! through compressed wide BVHs*, 2017.
//!
//! Costs are found from the bottom up ([`plan`]); what becomes a node or a block is settled from the top down ([`sketch`]), and
//! written where it belongs when all sizes are known ([`mod@write`]). Each step by all threads; who does what depends on sizes alone.

mod plan;
mod repeats;
mod sketch;
mod write;

use std::{iter, ops::ControlFlow, vec::Vec};

use bytemuck::zeroed_vec;
use rayon::prelude::*;

use self::{
    plan::Plan,
    sketch::{Left, Sketch},
    write::Places,
};
use super::{
    binary::Binary,
    block::BLOCK_WORDS,
    build::Monitor,
    node::{Child, WIDTH},
    tree::Tree,
};
use crate::geometry::Triangle;

/// Parts of so many references are left to one thread.
const ALONE: u32 = 8192;

/// The wide tree within `binary`, if its blocks can be named. `price` is what bytes cost; when it is done, so much `work` is done.
pub(super) fn collapse<B: Send>(
    binary: &Binary,
    price: f32,
    work: u32,
    triangle: impl Fn(u32) -> Triangle + Sync,
    monitor: &Monitor<'_, B>,
) -> ControlFlow<B, Option<Tree>> {
    let mut tree = Tree::default();
    let Some(root) = binary.nodes.first() else { return ControlFlow::Continue(Some(tree)) };
    let plan = Plan::new(binary, price, &triangle);
    monitor.advance(0)?;

    // A tree of one part is all top.
    let left = if plan.references(0) > ALONE { ALONE } else { 0 };
    let mut top = Sketch::new(&plan, 0, left);
    let parts: Vec<Sketch> = top.parts.par_iter().map(|part| Sketch::new(&plan, part.root, 0)).collect();
    monitor.advance(0)?;
    let (mut count, mut words) = (top.nodes.len(), top.words);
    for (&Left { node, place, depth, .. }, part) in top.parts.iter().zip(&parts) {
        top.nodes[node].named[place] = Child::node(count as u32);
        count += part.nodes.len();
        words += part.words;
        top.depth = top.depth.max(depth + part.depth);
    }
    if words > Child::MAX_WORDS {
        return ControlFlow::Continue(None);
    }
    (tree.root, tree.bounds, tree.stack) = (Some(Child::node(0)), root.hull().bounds(), (WIDTH - 1) * top.depth + 1);
    // Behind the last block there is as much as a walk may look at.
    (tree.nodes, tree.blocks) = (zeroed_vec(count), zeroed_vec(words + BLOCK_WORDS));
    let (nodes, words) = (&mut tree.nodes[..], &mut tree.blocks[..]);
    let mut rest = Places { nodes, words, first_node: 0, first_word: 0 };
    let tasks: Vec<_> = iter::once(&top).chain(&parts).map(|part| (rest.split_off(part), part)).collect();
    tasks.into_par_iter().try_for_each(|(places, part)| {
        places.write(&plan, part);
        monitor.advance(0)
    })?;
    monitor.advance(work)?;
    ControlFlow::Continue(Some(tree))
}
