use core::cell::Cell;
use std::vec::Vec;

use fearless_simd::Simd;

use super::{
    block::Block,
    node::{Child, Node},
};
use crate::{
    geometry::{Aabb, Crossing, PreparedRay, Ray},
    primitives::{Hit, Sides, Span},
};

/// With so many nodes of 256 bytes a tree does not fit into the nearer caches.
const MANY: usize = 16384;

/// A ray as it was given, and as it is prepared where that is wanted: so seldom that who walks alone does not keep it.
pub(super) trait Asker {
    fn ray(&self) -> &Ray;

    fn prepared(&self) -> Option<PreparedRay>;

    /// Hears of each block that the walk to the least hit looks at.
    #[inline(always)]
    fn count(&self) {}
}

impl Asker for PreparedRay {
    #[inline(always)]
    fn ray(&self) -> &Ray {
        self.ray()
    }

    #[inline(always)]
    fn prepared(&self) -> Option<PreparedRay> {
        Some(*self)
    }
}

impl Asker for Ray {
    #[inline(always)]
    fn ray(&self) -> &Ray {
        self
    }

    #[inline(always)]
    fn prepared(&self) -> Option<PreparedRay> {
        self.prepare()
    }
}

/// A ray that counts the blocks it looks at.
#[derive(Debug)]
pub(super) struct Counter {
    pub ray: Ray,
    pub tested: Cell<usize>,
}

impl Asker for Counter {
    #[inline(always)]
    fn ray(&self) -> &Ray {
        &self.ray
    }

    #[inline(always)]
    fn prepared(&self) -> Option<PreparedRay> {
        self.ray.prepare()
    }

    #[inline(always)]
    fn count(&self) {
        self.tested.set(self.tested.get() + 1);
    }
}

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

    /// The block, and what lies behind it; none if there is no child.
    #[inline(always)]
    pub(super) fn block(&self, child: Child) -> Option<Block<'_>> {
        let words = self.blocks.get(child.first()..)?.first_chunk()?;
        Some(Block::new(words, child.corners()))
    }

    /// Something of each line of the cache in which the child lies.
    #[inline(always)]
    pub(super) fn touch(&self, child: Child) -> u32 {
        if child.is_block() {
            self.block(child).map_or(0, Block::touch)
        } else {
            self.nodes.get(child.0 as usize).map_or(0, Node::touch)
        }
    }

    /// Asks memory for a child that waits, if the tree is so large that it may be far away.
    #[inline(always)]
    pub(super) fn touch_later(&self, child: Child) {
        if self.nodes.len() > MANY {
            core::hint::black_box(self.touch(child));
        }
    }

    /// Whether a ray of this mask sees the triangle of this number.
    #[inline(always)]
    pub(super) fn is_seen(&self, number: u32, seen: u32) -> bool {
        self.masks.is_empty() || self.masks.get(number as usize).is_some_and(|mask| mask & seen != 0)
    }

    /// The hit with a triangle of a block that the lanes left open: by the slow tiers if `front` is known, else by all.
    #[cold]
    #[inline(never)]
    pub(super) fn certify<S: Simd>(
        &self,
        simd: S,
        (block, lane): (Block<'_>, usize),
        front: Option<bool>,
        asker: &impl Asker,
        span: &Span,
    ) -> Option<Hit> {
        let ray = asker.ray();
        let range = front.and_then(|_| {
            simd.vectorize(
                #[inline(always)]
                || block.range(simd, lane, ray),
            )
        });
        let crossing = match (front, range) {
            (Some(front), Some([low, high])) if low.to_bits() == high.to_bits() && low.is_finite() => {
                Crossing { t: low, front }
            }
            (_, Some([low, high])) if high < span.t_min() || low > span.t_max() => return None,
            (Some(_), _) => block.triangle(lane).decide(&asker.prepared()?, front)?,
            (None, _) => block.triangle(lane).intersect(&asker.prepared()?, span.t_min(), span.t_max())?,
        };
        let number = block.number(lane);
        let is_hit = (crossing.front || self.sides == Sides::Both) && self.is_seen(number, ray.mask);
        if is_hit { span.accept(crossing.t, number) } else { None }
    }
}
