//! Nodes are taken out and put where they enlarge the boxes above them least.
//!
//! Bittner, Hapala and Havran, *Fast insertion-based optimization of bounding volume hierarchies*, 2013, with the search
//! of Meister and Bittner, *Parallel reinsertion for bounding volume hierarchy optimization*, 2018.

use crate::accel::MAX_LEVELS;

use super::{
    descend::flatten,
    node::{Link, Node, Pair, Planes, Surface},
};

/// Nodes looked at for each that is taken out: most searches end earlier by themselves.
const PATIENCE: u32 = 100;

/// The least gain, as a part of the parent's surface.
const LEAST: f32 = 1.0 / 1024.0;

/// Of the root: it stands in no pair.
const NONE: u32 = u32::MAX;

/// A hierarchy with links upward. A node's place is twice the number of its pair, and one more on the right.
struct Tree<'w> {
    pairs: &'w mut [Pair],
    /// Of each pair: the place of the node that links to it.
    parents: &'w mut [u32],
    /// Of each pair: the leaves below it.
    counts: &'w mut [u32],
    surface: Surface,
}

/// Improves a hierarchy with a leaf for each position, going through all nodes `rounds` times.
pub(super) fn reinsert(pairs: &mut [Pair], parents: &mut [u32], counts: &mut [u32], surface: Surface, rounds: u32) {
    let mut tree = Tree { pairs, parents, counts, surface };
    tree.link_upward();
    let end = tree.pairs.len() as u32 * 2;
    for round in 0..rounds {
        for place in 0..end {
            // From the last first: where small parts are in order, large ones find better places.
            let place = if round % 2 == 1 { place } else { end - 1 - place };
            if let Some(target) = tree.find(place) {
                tree.move_to(place, target);
            }
        }
    }
}

/// Lists the positions from left to right and, by pair in the order in which they come, how many are on its left.
pub(super) fn order(pairs: &[Pair], counts: &[u32], old: &[u32], list: &mut [u32], lefts: &mut [u32]) {
    let sized = |link: Link| {
        let count = if link.is_leaf() { 1 } else { counts.get(link.number() as usize).copied().unwrap_or(1) };
        (link, count)
    };
    let children = |link: Link| match link.is_leaf() {
        true => Err(old.get(link.number() as usize).copied().unwrap_or(0)),
        false => Ok(pairs.get(link.number() as usize).map(|pair| pair.map(|node| sized(node.link)))),
    };
    flatten(Link::inner(0), children, list, lefts);
}

impl Tree<'_> {
    fn node(&self, place: u32) -> Node {
        self.pairs.as_flattened().get(place as usize).copied().unwrap_or(Node::NOTHING)
    }

    fn parent(&self, place: u32) -> u32 {
        self.parents.get(place as usize / 2).copied().unwrap_or(NONE)
    }

    /// Puts a node into a place.
    fn put(&mut self, place: u32, node: Node) {
        if let Some(old) = self.pairs.as_flattened_mut().get_mut(place as usize) {
            *old = node;
        }
        if !node.link.is_leaf()
            && let Some(parent) = self.parents.get_mut(node.link.number() as usize)
        {
            *parent = place;
        }
    }

    /// Counts the leaves below a pair.
    fn count(&mut self, pair: usize) {
        let of = |node: &Node| match node.link.is_leaf() {
            true => 1,
            false => self.counts.get(node.link.number() as usize).copied().unwrap_or(0),
        };
        let sum = self.pairs.get(pair).map_or(0, |pair| pair.iter().map(of).sum());
        if let Some(count) = self.counts.get_mut(pair) {
            *count = sum;
        }
    }

    fn link_upward(&mut self) {
        if let Some(root) = self.parents.first_mut() {
            *root = NONE;
        }
        for index in (0..self.pairs.len()).rev() {
            for place in [index as u32 * 2, index as u32 * 2 + 1] {
                self.put(place, self.node(place));
            }
            self.count(index);
        }
    }

    /// Makes boxes and counts right from the pair of `place` up to the root.
    fn update(&mut self, mut place: u32) {
        loop {
            self.count(place as usize / 2);
            let hull = self.node(place).planes.union(self.node(place ^ 1).planes);
            place = self.parent(place);
            match self.pairs.as_flattened_mut().get_mut(place as usize) {
                Some(node) => node.planes = hull,
                None => return,
            }
        }
    }

    /// The node beside which the one at `place` takes away most from the sum of all surfaces, if any does.
    fn find(&self, place: u32) -> Option<u32> {
        let mut pivot = self.parent(place);
        if pivot == NONE {
            return None;
        }
        // What is saved if the node is taken out.
        let mut saved = self.surface.of(self.node(pivot).planes);
        let mut hull = self.node(place ^ 1).planes;
        let mut search = Search::new(self, self.node(place).planes, saved * LEAST);
        search.below(place ^ 1, saved);
        for _ in 0..MAX_LEVELS {
            search.below(pivot ^ 1, saved);
            hull = hull.union(self.node(pivot ^ 1).planes);
            let up = self.parent(pivot);
            if up == NONE {
                return search.target;
            }
            saved += self.surface.of(self.node(up).planes) - self.surface.of(hull);
            pivot = up;
        }
        // So deep that it would take long to tell all above.
        None
    }

    /// Takes the node at `place` out and puts it beside that at `target`.
    fn move_to(&mut self, place: u32, target: u32) {
        let (moved, pair, above) = (self.node(place), place & !1, self.parent(place));
        self.put(above, self.node(place ^ 1));
        self.update(above);
        let beside = self.node(target);
        self.put(pair, beside);
        self.put(pair + 1, moved);
        self.put(target, Node { planes: beside.planes.union(moved.planes), link: Link::inner(pair / 2) });
        self.update(pair);
    }
}

/// A search for a better place.
struct Search<'t> {
    tree: &'t Tree<'t>,
    node: Planes,
    /// What the best place so far saves.
    best: f32,
    target: Option<u32>,
    /// Nodes that may still be looked at.
    patience: u32,
}

impl<'t> Search<'t> {
    fn new(tree: &'t Tree<'t>, node: Planes, least: f32) -> Self {
        Self { tree, node, best: least, target: None, patience: PATIENCE }
    }

    /// Looks at the node at `place` and those below, where `saved` is what there is to gain if nothing had to grow.
    fn below(&mut self, place: u32, saved: f32) {
        let surface = &self.tree.surface;
        let own = surface.of(self.node);
        let mut stack: heapless::Vec<(u32, f32), 32> = heapless::Vec::new();
        let mut next = Some((place, saved));
        while let Some((place, saved)) = next {
            next = None;
            if self.patience > 0 && saved - own > self.best {
                self.patience -= 1;
                let node = self.tree.node(place);
                let here = saved - surface.of(node.planes.union(self.node));
                if here > self.best {
                    (self.best, self.target) = (here, Some(place));
                }
                let below = here + surface.of(node.planes);
                if !node.link.is_leaf() && below - own > self.best {
                    let _ = stack.push((node.link.number() * 2 + 1, below));
                    next = Some((node.link.number() * 2, below));
                }
            }
            next = next.or_else(|| stack.pop());
        }
    }
}
