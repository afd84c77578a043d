//! Words into a tree: looked at once, so that nothing can fail later.

use glam::Vec3;

use super::{
    HEADER_WORDS, KdTree, MAX_DEPTH,
    form::reference_bytes,
    node::{Kind, Node},
};
use crate::{
    accel::{Malformed, Reason, leaf::References},
    asset,
    geometry::Aabb,
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

    pub(super) fn from_words(words: &[u32]) -> Option<Self> {
        let &[nodes, references, primitives, depth, x0, y0, z0, x1, y1, z1] = words.first_chunk::<HEADER_WORDS>()?;
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let bounds = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        Some(Self { nodes, references, primitives, depth, bounds })
    }
}

impl<'a> KdTree<'a> {
    /// The tree in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each node at most once, whatever the words say. Whether they
    /// also say the truth about some primitives, only a checksum over both can tell.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let error = |word, reason| Malformed { structure: asset::Kind::KdTree, word, reason };
        let tree = Self::view(words).ok_or(error(0, Reason::Length))?;
        let empty = tree.primitives == 0 && tree.bounds == Aabb::EMPTY;
        if !(tree.bounds.is_valid() || empty) {
            return Err(error(4, Reason::Bounds));
        }
        if tree.depth as usize > MAX_DEPTH {
            return Err(Self::too_deep());
        }
        tree.check_nodes()?;
        for index in 0..tree.reference_count {
            if tree.references.get(index) >= tree.primitives {
                return Err(error(HEADER_WORDS + tree.nodes.len() * Node::WORDS, Reason::Primitive));
            }
        }
        Ok(tree)
    }

    /// The header names more levels than a stack has.
    pub(super) const fn too_deep() -> Malformed {
        Malformed { structure: asset::Kind::KdTree, word: 3, reason: Reason::Depth }
    }

    /// One pass in order: right children are the nodes after the left subtrees, so each node has exactly one parent.
    fn check_nodes(&self) -> Result<(), Malformed> {
        // Right children to come, with their depths.
        let mut pending: heapless::Vec<(u32, u32), MAX_DEPTH> = heapless::Vec::new();
        let (mut references, mut depth) = (0_u32, 0_u32);
        let mut ended = false;
        for (index, node) in self.nodes.iter().enumerate() {
            let error =
                |reason| Malformed { structure: asset::Kind::KdTree, word: HEADER_WORDS + index * Node::WORDS, reason };
            if ended {
                return Err(error(Reason::Link));
            }
            match node.kind() {
                Kind::Inner { position, right, empty, .. } => {
                    if !position.is_finite() {
                        return Err(error(Reason::Plane));
                    }
                    depth += 1;
                    if depth > self.depth {
                        return Err(error(Reason::Depth));
                    }
                    // The only child of a cut is the next node.
                    if empty.is_some() && right as usize != index + 1 {
                        return Err(error(Reason::Link));
                    }
                    if empty.is_none() && pending.push((right, depth)).is_err() {
                        return Err(error(Reason::Depth));
                    }
                }
                Kind::Leaf { first, count } => {
                    if count == 1 && first >= self.primitives {
                        return Err(error(Reason::Primitive));
                    }
                    if count > 1 {
                        if first != references {
                            return Err(error(Reason::References));
                        }
                        references = references.checked_add(count).ok_or(error(Reason::References))?;
                    }
                    match pending.pop() {
                        Some((right, level)) if right as usize == index + 1 => depth = level,
                        Some(_) => return Err(error(Reason::Link)),
                        None => ended = true,
                    }
                }
            }
        }
        let end = Malformed { structure: asset::Kind::KdTree, word: HEADER_WORDS, reason: Reason::Link };
        if !ended {
            return Err(end);
        }
        if references != self.reference_count {
            return Err(Malformed { reason: Reason::References, ..end });
        }
        Ok(())
    }

    /// The parts of `words` by their header, if the lengths agree.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let header = Header::from_words(words)?;
        let (_, rest) = words.split_at_checked(HEADER_WORDS)?;
        let (nodes, references) = rest.split_at_checked((header.nodes as usize).checked_mul(Node::WORDS)?)?;
        let narrow = reference_bytes(header.primitives as usize) == 2;
        let reference_words = if narrow { header.references.div_ceil(2) } else { header.references };
        if references.len() != reference_words as usize {
            return None;
        }
        Some(Self {
            words,
            nodes: bytemuck::try_cast_slice(nodes).ok()?,
            references: if narrow { References::narrow(references) } else { References::wide(references) },
            reference_count: header.references,
            primitives: header.primitives,
            depth: header.depth,
            bounds: header.bounds,
        })
    }
}
