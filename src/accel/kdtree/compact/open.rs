//! Words into a compact tree: looked at once, so that nothing can fail later.

use super::{
    CompactKdTree,
    node::{Kind, kind},
};
use crate::{
    accel::{
        Malformed, Reason,
        kdtree::{
            HEADER_WORDS, MAX_DEPTH,
            form::{lattice, reference_bytes},
            open::Header,
        },
        leaf::References,
    },
    asset,
    geometry::Aabb,
};

impl<'a> CompactKdTree<'a> {
    /// The tree in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each node at most once, whatever the words say.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let error = |word, reason| Malformed { structure: asset::Kind::CompactKdTree, word, reason };
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
                return Err(error(HEADER_WORDS + tree.nodes.len(), Reason::Primitive));
            }
        }
        Ok(tree)
    }

    /// The header names more levels than a stack has.
    pub(super) const fn too_deep() -> Malformed {
        Malformed { structure: asset::Kind::CompactKdTree, word: 3, reason: Reason::Depth }
    }

    /// One pass in order: right children begin where the left subtrees end, so each node has exactly one parent.
    fn check_nodes(&self) -> Result<(), Malformed> {
        // Right children to come, with their depths.
        let mut pending: heapless::Vec<(u32, u32), MAX_DEPTH> = heapless::Vec::new();
        let (mut references, mut depth) = (0_u32, 0_u32);
        let mut next = Some(0_u32);
        let end = self.nodes.len() as u32;
        while let Some(index) = next {
            let word = HEADER_WORDS + index as usize;
            let error = |reason| Malformed { structure: asset::Kind::CompactKdTree, word, reason };
            match kind(self.nodes, index).ok_or(error(Reason::Link))? {
                Kind::Inner { left, right, empty, .. } => {
                    depth += 1;
                    if depth > self.depth || (empty.is_none() && pending.push((right, depth)).is_err()) {
                        return Err(error(Reason::Depth));
                    }
                    next = Some(left);
                }
                Kind::Leaf { first, count, end: behind } => {
                    if count == 1 && first >= self.primitives {
                        return Err(error(Reason::Primitive));
                    }
                    if count > 1 {
                        if first != references {
                            return Err(error(Reason::References));
                        }
                        references = references.checked_add(count).ok_or(error(Reason::References))?;
                    }
                    next = match pending.pop() {
                        Some((right, level)) if right == behind => {
                            depth = level;
                            Some(right)
                        }
                        None if behind == end => None,
                        _ => return Err(error(Reason::Link)),
                    };
                }
            }
        }
        if references != self.reference_count {
            let word = HEADER_WORDS;
            return Err(Malformed { structure: asset::Kind::CompactKdTree, word, reason: Reason::References });
        }
        Ok(())
    }

    /// The parts of `words` by their header, if the lengths agree.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let header = Header::from_words(words)?;
        let (_, rest) = words.split_at_checked(HEADER_WORDS)?;
        let (nodes, references) = rest.split_at_checked(header.nodes as usize)?;
        let narrow = reference_bytes(header.primitives as usize) == 2;
        let reference_words = if narrow { header.references.div_ceil(2) } else { header.references };
        if references.len() != reference_words as usize {
            return None;
        }
        let lattice = lattice(&header.bounds);
        Some(Self {
            words,
            nodes,
            references: if narrow { References::narrow(references) } else { References::wide(references) },
            reference_count: header.references,
            primitives: header.primitives,
            depth: header.depth,
            bounds: header.bounds,
            lattice,
        })
    }
}
