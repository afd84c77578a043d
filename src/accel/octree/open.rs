//! Words into a tree: looked at once, so that nothing can fail later.

use glam::Vec3;

use super::{
    HEADER_WORDS, MAX_DEPTH, Octree, leaf_words,
    node::{Kind, MAX_FEW, Node, Point, behind, count},
    reference_halves,
};
use crate::{
    accel::{Malformed, Reason},
    asset,
    geometry::{Aabb, Axis},
};

/// The header as it stands in the words.
pub(super) struct Header {
    pub(super) nodes: u32,
    pub(super) references: u32,
    pub(super) primitives: u32,
    pub(super) depth: u32,
    pub(super) bounds: Aabb,
}

impl Header {
    pub(super) fn to_words(&self) -> [u32; HEADER_WORDS] {
        let [x0, y0, z0] = self.bounds.min.to_array().map(f32::to_bits);
        let [x1, y1, z1] = self.bounds.max.to_array().map(f32::to_bits);
        [self.nodes, self.references, self.primitives, self.depth, x0, y0, z0, x1, y1, z1]
    }

    fn from_words(words: &[u32]) -> Option<Self> {
        let &[nodes, references, primitives, depth, x0, y0, z0, x1, y1, z1] = words.first_chunk::<HEADER_WORDS>()?;
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let bounds = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        Some(Self { nodes, references, primitives, depth, bounds })
    }
}

/// What a pass over the nodes has counted.
#[derive(Default)]
struct Counts {
    nodes: u32,
    references: u32,
    /// Words: where the next block or leaf must begin.
    next: usize,
}

impl<'a> Octree<'a> {
    /// The tree in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each node at most once, whatever the words say. Whether they
    /// also say the truth about some primitives, only a checksum over both can tell.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let error = |word, reason| Malformed { structure: asset::Kind::Octree, word, reason };
        let tree = Self::view(words).ok_or(error(0, Reason::Length))?;
        let empty = tree.primitives == 0 && tree.bounds == Aabb::EMPTY;
        if !(tree.bounds.is_valid() || empty) {
            return Err(error(4, Reason::Bounds));
        }
        if tree.depth as usize > MAX_DEPTH {
            return Err(error(3, Reason::Depth));
        }
        let counts = tree.check_nodes()?;
        if counts.next != tree.body.len() {
            return Err(error(HEADER_WORDS + counts.next, Reason::Length));
        }
        if counts.nodes != tree.nodes {
            return Err(error(0, Reason::Header));
        }
        if counts.references != tree.references {
            return Err(error(1, Reason::References));
        }
        Ok(tree)
    }

    /// One pass in the order of the words: each block and each leaf's references begin where those before end, so each
    /// node has exactly one parent.
    fn check_nodes(&self) -> Result<Counts, Malformed> {
        // Children to come, from one word up to another.
        let mut pending: heapless::Vec<(u32, u32), MAX_DEPTH> = heapless::Vec::new();
        let mut counts = Counts::default();
        if self.body.is_empty() {
            return Ok(counts);
        }
        counts.next = 1;
        let mut word = 0;
        loop {
            let error =
                |reason| Malformed { structure: asset::Kind::Octree, word: HEADER_WORDS + word as usize, reason };
            let node = self.node(word).ok_or(error(Reason::Link))?;
            counts.nodes += 1;
            match node.kind() {
                Kind::Inner { octants, block } => {
                    if block as usize != counts.next || octants == 0 {
                        return Err(error(Reason::Link));
                    }
                    let point = self.point(block).ok_or(error(Reason::Link))?;
                    if !is_in_order(point, octants) {
                        return Err(error(Reason::Plane));
                    }
                    let first = block + Point::WORDS as u32;
                    let end = first + count(octants);
                    counts.next = end as usize;
                    if counts.next > self.body.len() {
                        return Err(error(Reason::Link));
                    }
                    if pending.len() >= self.depth as usize || pending.push((first, end)).is_err() {
                        return Err(error(Reason::Depth));
                    }
                }
                Kind::One(primitive) => {
                    if primitive >= self.primitives {
                        return Err(error(Reason::Primitive));
                    }
                }
                Kind::Few { first, count } => self.check_leaf(node, first, count, &mut counts).map_err(error)?,
                Kind::Many { counted } => {
                    let count = self.body.get(counted as usize).copied().ok_or(error(Reason::References))?;
                    // None, or more than the node itself could tell.
                    if (1..=MAX_FEW).contains(&count) {
                        return Err(error(Reason::References));
                    }
                    self.check_leaf(node, counted, count, &mut counts).map_err(error)?;
                }
            }
            word = loop {
                let Some((next, end)) = pending.last_mut() else { return Ok(counts) };
                if next < end {
                    *next += 1;
                    break *next - 1;
                }
                pending.pop();
            };
        }
    }

    /// Checks and counts the references of a leaf, whose words begin at `first`.
    fn check_leaf(&self, node: Node, first: u32, count: u32, counts: &mut Counts) -> Result<(), Reason> {
        let words = leaf_words(count as usize, reference_halves(self.primitives as usize));
        let end = counts.next.checked_add(words).filter(|&end| end <= self.body.len());
        if first as usize != counts.next || end.is_none() {
            return Err(Reason::References);
        }
        counts.next = end.unwrap_or(0);
        counts.references = counts.references.checked_add(count).ok_or(Reason::References)?;
        for primitive in node.leaf_in(self.body, self.is_wide()) {
            if primitive >= self.primitives {
                return Err(Reason::Primitive);
            }
        }
        Ok(())
    }

    /// The parts of `words` by their header; there are nodes if there are primitives.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let Header { nodes, references, primitives, depth, bounds } = Header::from_words(words)?;
        let body = words.get(HEADER_WORDS..)?;
        let tree = Self { words, body, nodes, references, primitives, depth, bounds };
        (body.is_empty() == (primitives == 0)).then_some(tree)
    }
}

/// Whether all planes are numbers, and those at infinity have nothing behind them.
fn is_in_order(point: Point, octants: u32) -> bool {
    Axis::ALL.into_iter().all(|axis| {
        let position = point.along(axis);
        position.is_finite() || (position == f32::INFINITY && octants & behind(axis) == 0)
    })
}
