//! Words into a tree: looked at once, so that nothing can fail later.

use glam::Vec3;

use super::{
    DualSplit, HEADER_WORDS, MAX_DEPTH,
    block::Block,
    is_narrow,
    node::{Head, Kind},
    number_words,
};
use crate::{
    accel::{Malformed, Reason, leaf::References},
    asset,
    geometry::{Aabb, Lattice},
};

/// Whether the primitives stand in the order of the leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Yes: a position is a number.
    Ordered = 0,
    /// No: the number of each position stands behind the nodes.
    Numbered = 1,
}

/// The header as it stands in the words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    /// Words of nodes.
    pub(super) nodes: u32,
    pub(super) primitives: u32,
    /// The most splits above a leaf.
    pub(super) depth: u32,
    pub(super) form: Form,
    pub(super) bounds: Aabb,
}

impl Header {
    pub(super) fn to_words(self) -> [u32; HEADER_WORDS] {
        let [x0, y0, z0] = self.bounds.min.to_array().map(f32::to_bits);
        let [x1, y1, z1] = self.bounds.max.to_array().map(f32::to_bits);
        [self.nodes, self.primitives, self.depth, self.form as u32, x0, y0, z0, x1, y1, z1]
    }

    fn from_words(words: &[u32]) -> Option<Self> {
        let &[nodes, primitives, depth, form, x0, y0, z0, x1, y1, z1] = words.first_chunk::<HEADER_WORDS>()?;
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let bounds = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        let form = match form {
            0 => Form::Ordered,
            1 => Form::Numbered,
            _ => return None,
        };
        Some(Self { nodes, primitives, depth, form, bounds })
    }
}

impl<'a> DualSplit<'a> {
    /// The tree in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each node at most once, whatever the words say. Whether they
    /// also say the truth about some primitives, only a checksum over both can tell.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let error = |word, reason| Malformed { structure: asset::Kind::DualSplit, word, reason };
        if words.get(3).is_some_and(|&form| form > 1) {
            return Err(error(3, Reason::Header));
        }
        let tree = Self::view(words).ok_or(error(0, Reason::Length))?;
        let empty = tree.primitives == 0 && tree.bounds == Aabb::EMPTY;
        if !(tree.bounds.is_valid() || empty) {
            return Err(error(4, Reason::Bounds));
        }
        if tree.depth as usize > MAX_DEPTH {
            return Err(Self::too_deep());
        }
        tree.check_nodes()?;
        if tree.form == Form::Numbered {
            for position in 0..tree.primitives {
                if tree.references.get(position) >= tree.primitives {
                    return Err(error(HEADER_WORDS + tree.nodes.len(), Reason::Primitive));
                }
            }
        }
        Ok(tree)
    }

    /// The header names more levels than a stack has.
    pub(super) const fn too_deep() -> Malformed {
        Malformed { structure: asset::Kind::DualSplit, word: 2, reason: Reason::Depth }
    }

    /// One pass in order: right children follow the left subtrees, so each node has exactly one parent; leaves follow one
    /// another, so each position is in exactly one.
    fn check_nodes(&self) -> Result<(), Malformed> {
        // Right children to come, with their depths.
        let mut pending: heapless::Vec<(u32, u32), MAX_DEPTH> = heapless::Vec::new();
        let (mut at, mut done, mut depth) = (0_usize, 0_u32, 0_u32);
        let mut ended = self.primitives == 0;
        while let Some(&word) = self.nodes.get(at) {
            let place = HEADER_WORDS + at;
            let error = |reason| Malformed { structure: asset::Kind::DualSplit, word: place, reason };
            if ended {
                return Err(error(Reason::Link));
            }
            match Head::from_word(word).kind().ok_or(error(Reason::Link))? {
                Kind::Split { right, .. } => {
                    depth += 1;
                    if depth > self.depth || pending.push((right, depth)).is_err() {
                        return Err(error(Reason::Depth));
                    }
                    at += 2;
                }
                Kind::Carve { .. } => at += 2,
                Kind::Leaf { first, count } => {
                    if first != done || count == 0 {
                        return Err(error(Reason::References));
                    }
                    done += count;
                    at += 1;
                    match pending.pop() {
                        Some((right, level)) if right as usize == at => depth = level,
                        Some(_) => return Err(error(Reason::Link)),
                        None => ended = true,
                    }
                }
            }
        }
        let end = Malformed { structure: asset::Kind::DualSplit, word: HEADER_WORDS, reason: Reason::Link };
        if !ended || at != self.nodes.len() {
            return Err(end);
        }
        if done != self.primitives {
            return Err(Malformed { reason: Reason::References, ..end });
        }
        Ok(())
    }

    /// The parts of `words` by their header, if the lengths agree.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let header = Header::from_words(words)?;
        let (_, rest) = words.split_at_checked(HEADER_WORDS)?;
        let (nodes, numbers) = rest.split_at_checked(header.nodes as usize)?;
        let (references, length) = match header.form {
            Form::Ordered => (References::IDENTITY, 0),
            Form::Numbered if is_narrow(header.primitives) => {
                (References::narrow(numbers), number_words(header.primitives))
            }
            Form::Numbered => (References::wide(numbers), number_words(header.primitives)),
        };
        if numbers.len() != length {
            return None;
        }
        Some(Self {
            words,
            nodes,
            references,
            lattice: Lattice::over(&header.bounds, [Block::LAST; 3]),
            form: header.form,
            primitives: header.primitives,
            depth: header.depth,
            bounds: header.bounds,
        })
    }
}
