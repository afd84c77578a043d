use std::vec::Vec;

use super::{
    block::Block,
    node::{Child, Node},
};
use crate::{
    geometry::{Aabb, PreparedRay},
    primitives::{Hit, Sides, Span},
};

/// Nodes and blocks of triangles.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    /// One after the other, without gaps; behind the last as much again as a walk may look at.
    pub blocks: Vec<u32>,
    /// Where walks begin; none if there is nothing.
    pub root: Option<Child>,
    /// The most children that wait while a ray walks: of each node on the way all but one, and the last one's.
    pub stack: usize,
    pub bounds: Aabb,
    pub sides: Sides,
    /// By number; empty if all rays see all triangles.
    pub masks: Vec<u32>,
}

impl Default for Tree {
    fn default() -> Self {
        let (nodes, blocks, masks) = (Vec::new(), Vec::new(), Vec::new());
        Self { nodes, blocks, root: None, stack: 0, bounds: Aabb::EMPTY, sides: Sides::Both, masks }
    }
}

impl Tree {
    /// What rays walk through.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..]) + size_of_val(&self.masks[..])
    }

    /// The block, and what lies behind it.
    #[inline(always)]
    pub(super) fn block(&self, child: Child) -> Option<Block<'_>> {
        let words = self.blocks.get(child.first()..)?.first_chunk()?;
        Some(Block::new(words, child.corners()))
    }

    /// Whether a ray of this mask sees the triangle of this number.
    #[inline(always)]
    pub(super) fn is_seen(&self, number: u32, seen: u32) -> bool {
        self.masks.is_empty() || self.masks.get(number as usize).is_some_and(|mask| mask & seen != 0)
    }

    /// The hit with a triangle of a block that the lanes left open: by the slow tiers if `front` is known, else by all.
    #[cold]
    #[inline(never)]
    pub(super) fn certify(
        &self,
        block: Block<'_>,
        lane: usize,
        front: Option<bool>,
        ray: &PreparedRay,
        span: &Span,
    ) -> Option<Hit> {
        let triangle = block.triangle(lane);
        let crossing = match front {
            Some(_) => triangle.decide(ray, front)?,
            None => triangle.intersect(ray, span.t_min(), span.t_max())?,
        };
        let number = block.number(lane);
        let is_hit = (crossing.front || self.sides == Sides::Both) && self.is_seen(number, ray.ray().mask);
        if is_hit { span.accept(crossing.t, number) } else { None }
    }
}
