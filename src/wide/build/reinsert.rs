//! Nodes are taken out and put where they enlarge the boxes above them least.
//!
//! Meister and Bittner, *Parallel reinsertion for bounding volume hierarchy optimization*, 2018: all threads look for better
//! places in the same hierarchy, then the moves are made, the most useful first, unless an earlier one was in the way.

use std::{cmp::Reverse, ops::ControlFlow, vec, vec::Vec};

use rayon::prelude::*;

use super::{MAX_DEPTH, partition::CHUNK};
use crate::wide::binary::BinaryNode;

/// Nodes looked at for each that is taken out: most searches end earlier by themselves.
const PATIENCE: u32 = 256;

/// The least gain, as a part of the parent's weight.
const LEAST: f32 = 1.0 / 1024.0;

/// A node that is better elsewhere.
struct Move {
    gain: f32,
    from: u32,
    /// Beside this one.
    to: u32,
}

/// A hierarchy with links upward. Pairs stand at odd numbers, behind the root.
struct Tree<'n> {
    nodes: &'n mut [BinaryNode],
    /// By pair: the node above, and how many levels are below that.
    above: Vec<Above>,
    scale: f32,
}

#[derive(Clone, Copy, Default)]
struct Above {
    parent: u32,
    height: u32,
}

/// The other node of a pair.
const fn sibling(node: u32) -> u32 {
    ((node - 1) ^ 1) + 1
}

/// Improves a hierarchy whose children stand behind their parents, `rounds` times; each time the part `ratio` of its nodes
/// is looked at, those most likely met by rays. After each round `go_on` is asked.
pub(super) fn reinsert<B>(
    nodes: &mut [BinaryNode],
    rounds: u32,
    ratio: f32,
    go_on: impl Fn() -> ControlFlow<B>,
) -> ControlFlow<B> {
    let Some(root) = nodes.first() else { return ControlFlow::Continue(()) };
    let scale = root.hull().scale();
    let mut tree = Tree { above: vec![Above::default(); nodes.len() / 2], nodes, scale };
    tree.link_upward();
    for _ in 0..rounds {
        let nodes = tree.likely(ratio);
        let mut moves: Vec<Move> = nodes.par_iter().with_min_len(64).filter_map(|&node| tree.find(node)).collect();
        moves.sort_unstable_by_key(|of| (Reverse(of.gain.to_bits()), of.from));
        let mut touched = vec![false; tree.nodes.len()];
        for of in &moves {
            tree.make(of, &mut touched);
        }
        go_on()?;
    }
    ControlFlow::Continue(())
}

impl Tree<'_> {
    fn weight(&self, node: u32) -> f32 {
        self.nodes[node as usize].hull().weight(self.scale)
    }

    fn above(&self, node: u32) -> Above {
        self.above[(node as usize - 1) / 2]
    }

    /// How many levels are below a node.
    fn height(&self, node: u32) -> u32 {
        let node = self.nodes[node as usize];
        if node.count() > 0 { 0 } else { self.above(node.first() as u32).height }
    }

    /// Puts a node into a place.
    fn put(&mut self, place: u32, node: BinaryNode) {
        self.nodes[place as usize] = node;
        if node.count() == 0 {
            self.above[(node.first() - 1) / 2].parent = place;
        }
    }

    /// Makes box and height of an inner node right; whether they were not.
    fn fit(&mut self, place: u32) -> bool {
        let node = self.nodes[place as usize];
        let [left, right] = [node.first() as u32, node.first() as u32 + 1];
        let hull = self.nodes[left as usize].hull().union(self.nodes[right as usize].hull());
        let height = 1 + self.height(left).max(self.height(right));
        let fitted = node.with_hull(hull);
        let above = &mut self.above[(left as usize - 1) / 2];
        let differs = above.height != height || fitted.hull() != node.hull();
        above.height = height;
        self.nodes[place as usize] = fitted;
        differs
    }

    fn link_upward(&mut self) {
        for place in (0..self.nodes.len() as u32).rev() {
            self.put(place, self.nodes[place as usize]);
            if self.nodes[place as usize].count() == 0 {
                self.fit(place);
            }
        }
    }

    /// The part `ratio` of all nodes, those with the largest boxes.
    fn likely(&self, ratio: f32) -> Vec<u32> {
        let numbers = (1..self.nodes.len() as u32).into_par_iter().with_min_len(CHUNK);
        let mut keys: Vec<u64> =
            numbers.map(|node| u64::from(self.weight(node).to_bits()) << 32 | u64::from(!node)).collect();
        let count = (keys.len() as f32 * ratio) as usize;
        if count < keys.len() {
            keys.select_nth_unstable_by_key(count, |&key| Reverse(key));
            keys.truncate(count);
        }
        keys.into_iter().map(|key| !(key as u32)).collect()
    }

    /// The place where a node takes away most from the sum of all weights, if any does.
    fn find(&self, from: u32) -> Option<Move> {
        let mut pivot = self.above(from).parent;
        // What is saved if the node is taken out.
        let mut saved = self.weight(pivot);
        let mut hull = self.nodes[sibling(from) as usize].hull();
        let mut search = Search::new(self, from, saved * LEAST);
        search.below(sibling(from), saved);
        while pivot != 0 {
            let beside = sibling(pivot);
            search.below(beside, saved);
            hull = hull.union(self.nodes[beside as usize].hull());
            pivot = self.above(pivot).parent;
            saved += self.weight(pivot) - hull.weight(self.scale);
        }
        search.best
    }

    /// Moves a node, unless one of those that it concerns was moved already, or it would get too deep.
    fn make(&mut self, of: &Move, touched: &mut [bool]) {
        let &Move { from, to, .. } = of;
        let parent = self.above(from).parent;
        let concerned = [from, sibling(from), parent, to];
        if concerned.iter().any(|&node| touched[node as usize]) {
            return;
        }
        // Not below itself, where the target may have got.
        let (mut node, mut depth) = (to, 0);
        while node != 0 {
            if node == from {
                return;
            }
            node = self.above(node).parent;
            depth += 1;
        }
        if depth + 1 + self.height(from).max(self.height(to)) > MAX_DEPTH {
            return;
        }
        for node in concerned {
            touched[node as usize] = true;
        }
        let (moved, pair) = (self.nodes[from as usize], from.min(sibling(from)));
        self.put(parent, self.nodes[sibling(from) as usize]);
        self.fit_above(parent);
        let beside = self.nodes[to as usize];
        self.put(pair, beside);
        self.put(pair + 1, moved);
        self.put(to, BinaryNode::inner(beside.hull(), pair as usize));
        self.fit(to);
        self.fit_above(to);
    }

    /// Makes all above a node right.
    fn fit_above(&mut self, mut node: u32) {
        while node != 0 {
            node = self.above(node).parent;
            if !self.fit(node) {
                return;
            }
        }
    }
}

/// A search for a better place.
struct Search<'t> {
    tree: &'t Tree<'t>,
    from: u32,
    own: f32,
    least: f32,
    best: Option<Move>,
    /// Nodes that may still be looked at.
    patience: u32,
}

impl<'t> Search<'t> {
    fn new(tree: &'t Tree<'t>, from: u32, least: f32) -> Self {
        Self { tree, from, own: tree.weight(from), least, best: None, patience: PATIENCE }
    }

    /// Looks at a node and those below, where `saved` is what there is to gain if nothing had to grow.
    fn below(&mut self, node: u32, saved: f32) {
        let (scale, hull) = (self.tree.scale, self.tree.nodes[self.from as usize].hull());
        let mut stack: heapless::Vec<(u32, f32), 64> = heapless::Vec::new();
        let mut next = Some((node, saved));
        while let Some((place, saved)) = next {
            next = None;
            if self.patience > 0 && saved - self.own > self.least {
                self.patience -= 1;
                let node = &self.tree.nodes[place as usize];
                let here = saved - hull.union(node.hull()).weight(scale);
                if here > self.least {
                    self.least = here;
                    self.best = Some(Move { gain: here, from: self.from, to: place });
                }
                let below = here + node.hull().weight(scale);
                if node.count() == 0 && below - self.own > self.least {
                    // If there is no room, what is left out is not looked at.
                    let _ = stack.push((node.first() as u32 + 1, below));
                    next = Some((node.first() as u32, below));
                }
            }
            next = next.or_else(|| stack.pop());
        }
    }
}
