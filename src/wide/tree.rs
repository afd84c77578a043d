use std::vec::Vec;

use glam::Vec3;

use super::node::{Child, Node, TRIANGLE_WORDS, WIDTH};
use crate::{
    geometry::{Aabb, PreparedRay, Triangle},
    primitives::{Hit, Sides, Span},
};

/// Words that a walk looks at for a block: eight lanes of each row, wherever it begins.
pub(super) const BLOCK_WORDS: usize = (TRIANGLE_WORDS - 1) * WIDTH + WIDTH;

/// Nodes and blocks of triangles.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    /// Per block the rows of its triangles, without gaps; behind the last as much again as a walk may look at.
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

/// The rows of a block, from its first word on.
pub(super) type Block = [u32; BLOCK_WORDS];

impl Tree {
    /// What rays walk through.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..]) + size_of_val(&self.masks[..])
    }

    /// The block, and what lies behind it.
    #[inline(always)]
    pub(super) fn block(&self, child: Child) -> Option<&Block> {
        self.blocks.get(child.first() * TRIANGLE_WORDS..)?.first_chunk()
    }

    /// Whether a ray of this mask sees the triangle of this number.
    #[inline(always)]
    pub(super) fn is_seen(&self, number: u32, seen: u32) -> bool {
        self.masks.is_empty() || self.masks.get(number as usize).is_some_and(|mask| mask & seen != 0)
    }

    /// A triangle of the `count` in a block.
    #[inline(always)]
    pub(super) fn triangle(&self, block: &Block, lane: usize, count: usize) -> Triangle {
        let along = |row: usize| f32::from_bits(block.get(row * count + lane).copied().unwrap_or(0));
        let corner = |i: usize| Vec3::new(along(3 * i), along(3 * i + 1), along(3 * i + 2));
        Triangle::new(corner(0), corner(1), corner(2))
    }

    /// The hit with a triangle of a block that the lanes left open: by the slow tiers if `front` is known, else by all.
    #[cold]
    #[inline(never)]
    pub(super) fn certify(
        &self,
        block: &Block,
        (lane, count): (usize, usize),
        front: Option<bool>,
        ray: &PreparedRay,
        span: &Span,
    ) -> Option<Hit> {
        let triangle = self.triangle(block, lane, count);
        let crossing = match front {
            Some(_) => triangle.decide(ray, front)?,
            None => triangle.intersect(ray, span.t_min(), span.t_max())?,
        };
        let number = block.get((TRIANGLE_WORDS - 1) * count + lane).copied().unwrap_or(0);
        let is_hit = (crossing.front || self.sides == Sides::Both) && self.is_seen(number, ray.ray().mask);
        if is_hit { span.accept(crossing.t, number) } else { None }
    }
}
