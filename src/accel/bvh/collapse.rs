//! Subtrees into leaves, where testing all of their primitives is expected to cost no more.

use super::{
    MAX_DEPTH,
    node::{Link, MAX_LEAF, Pair, Surface},
    open::Header,
    options::Options,
};
use crate::geometry::Aabb;

/// Of a mark: all below the pair is one leaf.
const LEAF: u32 = 1 << 31;

/// What is known about what is below each pair.
pub(super) struct Marks<'w> {
    /// How many primitives, and whether they are to be one leaf.
    pub(super) leaves: &'w mut [u32],
    /// What they are expected to cost, as bits.
    pub(super) costs: &'w mut [u32],
    /// How many pairs stay.
    pub(super) kept: &'w mut [u32],
}

impl Marks<'_> {
    /// Marks what is to be a leaf, by the cost of the surface area heuristic (MacDonald and Booth 1990), so that no more
    /// pairs stay than are allowed, if that can be.
    ///
    /// A pair has a price beside the cost of looking at it, the least at which they are few enough: so what is left out is
    /// what is missed least.
    pub(super) fn choose(&mut self, pairs: &[Pair], surface: &Surface, options: &Options) {
        let allowed = options.pairs(pairs.len() + 1);
        if self.mark(pairs, surface, options, 0.0) as usize <= allowed {
            return;
        }
        // Positive numbers are in the order of their bits: the upper ones are enough.
        let (mut low, mut high) = (0, f32::MAX.to_bits() >> 15);
        while low + 1 < high {
            let middle = (low + high) / 2;
            let kept = self.mark(pairs, surface, options, f32::from_bits(middle << 15));
            *(if kept as usize <= allowed { &mut high } else { &mut low }) = middle;
        }
        self.mark(pairs, surface, options, f32::from_bits(high << 15));
    }

    /// Marks what is to be a leaf if each pair has this price; how many pairs stay. From the last pair to the first.
    fn mark(&mut self, pairs: &[Pair], surface: &Surface, options: &Options, price: f32) -> u32 {
        let most = options.leaf_size.clamp(1, MAX_LEAF);
        let of = |words: &[u32], link: Link| words.get(link.number() as usize).copied().unwrap_or(0);
        for (index, [left, right]) in pairs.iter().enumerate().rev() {
            let area = surface.of(left.planes.union(right.planes));
            let (mut count, mut cost, mut kept) = (0, area + price, 1);
            for node in [left, right] {
                if node.link.is_leaf() {
                    count += node.link.count();
                    cost += surface.of(node.planes) * options.intersection_cost;
                } else {
                    count += of(self.leaves, node.link) & !LEAF;
                    cost += f32::from_bits(of(self.costs, node.link));
                    kept += of(self.kept, node.link);
                }
            }
            let as_leaf = area * options.intersection_cost * count as f32;
            let is_leaf = count <= most && as_leaf <= cost;
            let words = (self.leaves.get_mut(index), self.costs.get_mut(index), self.kept.get_mut(index));
            if let (Some(leaf), Some(place), Some(stay)) = words {
                *leaf = if is_leaf { count | LEAF } else { count };
                *place = (if is_leaf { as_leaf } else { cost }).to_bits();
                *stay = if is_leaf { 0 } else { kept };
            }
        }
        self.kept.first().copied().filter(|_| !pairs.is_empty()).unwrap_or(0)
    }
}

/// What is left of the pairs.
pub(super) struct Remains {
    pub(super) pairs: u32,
    depth: u32,
    root: Link,
}

impl Remains {
    pub(super) const fn header(&self, primitives: u32, bounds: Aabb) -> Header {
        Header { pairs: self.pairs, primitives, depth: self.depth, root: self.root, bounds }
    }
}

/// Makes leaves of the marked pairs; those that stay move together.
pub(super) fn collapse(pairs: &mut [Pair], primitives: u32, marks: &[u32]) -> Remains {
    // Links to come: what they were, the pair and the side where they stand, how many pairs are above.
    let mut pending: heapless::Vec<(Link, usize, usize, u32), MAX_DEPTH> = heapless::Vec::new();
    let mut remains = Remains { pairs: 0, depth: 0, root: Link::inner(0) };
    let mut positions = 0;
    let root = if primitives == 1 { Link::leaf(0, 1) } else { Link::inner(0) };
    let mut next = (primitives > 0).then_some((root, usize::MAX, 0, 0));
    while let Some((link, parent, side, depth)) = next {
        let mark = marks.get(link.number() as usize).copied().unwrap_or(0);
        let count = if link.is_leaf() { link.count() } else { mark & !LEAF };
        let now = if link.is_leaf() || mark & LEAF != 0 {
            let leaf = Link::leaf(positions, count);
            positions += count;
            next = pending.pop();
            leaf
        } else {
            // Pairs come in order, so what is written over was read.
            let Some(pair) = pairs.get(link.number() as usize).copied() else { break };
            let number = remains.pairs;
            if let Some(place) = pairs.get_mut(number as usize) {
                *place = pair;
            }
            remains.pairs += 1;
            remains.depth = remains.depth.max(depth + 1);
            let [left, right] = pair.map(|node| node.link);
            // Cannot fail: one for each level above.
            let _ = pending.push((right, number as usize, 1, depth + 1));
            next = Some((left, number as usize, 0, depth + 1));
            Link::inner(number)
        };
        match pairs.get_mut(parent).and_then(|pair| pair.get_mut(side)) {
            Some(node) => node.link = now,
            None => remains.root = now,
        }
    }
    remains
}
