use crate::{
    accel::{
        Leaf,
        kdtree::{
            form::{FAR, LAST_PLANE, LONG, MANY},
            node::Side,
        },
        leaf::References,
    },
    geometry::{Axis, descends},
};

/// A node of 4 bytes, and in rare cases a word or two behind it.
///
/// | | bits 16 … 31 | bits 2 … 15 | bits 0, 1 |
/// |---|---|---|---|
/// | inner node | words to the right child; the left one follows | number of the plane | axis 0, 1, 2 |
/// | cut | 0: empty on the right, 1: on the left; the only child follows | number of the plane | axis |
/// | long inner node | 65,535: the words to the right child stand in the next word | number of the plane | axis |
///
/// | | bits 10 … 31 | bits 2 … 9 | bits 0, 1 |
/// |---|---|---|---|
/// | leaf of one | the primitive | 1 | 3 |
/// | other leaf | index of the first reference | how many | 3 |
/// | far leaf | 2^22 - 1: the number stands in the next word | | 3 |
/// | large leaf | | 255: the count stands in the next word that is left | 3 |
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node(u32);

impl Node {
    /// What [`axis_or_leaf`](Self::axis_or_leaf) is of a leaf.
    pub(crate) const LEAF: u32 = 3;

    /// The node in a word.
    #[inline(always)]
    pub(crate) const fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// The word.
    pub(crate) const fn to_word(self) -> u32 {
        self.0
    }

    /// A plane whose right child is set by [`linked_by`](Self::linked_by).
    pub(crate) const fn inner(axis: Axis, plane: u32) -> Self {
        Self((plane & LAST_PLANE) << 2 | axis as u32)
    }

    /// The same plane with its right child so many words ahead, 2 … [`LONG`] - 1.
    pub(crate) const fn linked_by(self, distance: u32) -> Self {
        Self(distance << 16 | self.0 & 0xffff)
    }

    /// The same plane with nothing on one side.
    pub(crate) const fn cutting(self, empty: Side) -> Self {
        self.linked_by(match empty {
            Side::Left => 1,
            Side::Right => 0,
        })
    }

    /// The same plane with the distance to its right child in the next word.
    pub(crate) const fn long(self) -> Self {
        self.linked_by(LONG)
    }

    /// A leaf; what does not fit is to follow.
    pub(crate) const fn leaf(first: u32, count: u32) -> Self {
        let first = if first < FAR { first } else { FAR };
        let count = if count < MANY { count } else { MANY };
        Self(first << 10 | count << 2 | Self::LEAF)
    }

    /// The number of an inner node's axis, or 3 of a leaf.
    #[inline(always)]
    pub(crate) const fn axis_or_leaf(self) -> u32 {
        self.0 & 3
    }

    /// The number of an inner node's plane.
    #[inline(always)]
    pub(crate) const fn plane(self) -> u32 {
        self.0 >> 2 & LAST_PLANE
    }

    /// Words to an inner node's right child, or one of three signs.
    #[inline(always)]
    pub(crate) const fn link(self) -> u32 {
        self.0 >> 16
    }

    /// Whether one side of a plane is empty.
    #[inline(always)]
    pub(crate) const fn is_cut(self) -> bool {
        self.link() <= 1
    }

    /// Whether it is the right side of a cut that is empty.
    #[inline(always)]
    pub(crate) const fn is_empty_on_the_right(self) -> bool {
        // The link of a cut is 0 or 1.
        self.0 >> 16 & 1 == 0
    }

    /// Whether the distance to the right child stands in the next word.
    #[inline(always)]
    pub(crate) const fn is_long(self) -> bool {
        self.link() == LONG
    }

    /// Whether a ray that descends along the axes of `mask` meets the right child first.
    #[inline(always)]
    pub(crate) const fn is_descended(self, mask: u32) -> bool {
        descends(mask, self.0)
    }

    /// A leaf's first reference, or its only primitive.
    #[inline(always)]
    pub(crate) const fn first(self) -> u32 {
        self.0 >> 10
    }

    /// How many primitives a leaf has.
    #[inline(always)]
    pub(crate) const fn count(self) -> u32 {
        self.0 >> 2 & MANY
    }

    /// Whether a leaf's first reference stands in the next word.
    #[inline(always)]
    pub(crate) const fn is_far(self) -> bool {
        self.first() == FAR
    }

    /// The primitives of the leaf at `index`.
    #[inline(always)]
    pub(super) fn leaf_in<'a>(self, nodes: &'a [u32], index: u32, references: References<'a>) -> Leaf<'a> {
        let (mut first, mut count) = (self.first(), self.count());
        if self.is_far() | self.is_large() {
            let behind = |by: u32| nodes.get((index + by) as usize).copied().unwrap_or(0);
            if self.is_far() {
                first = behind(1);
            }
            if self.is_large() {
                count = behind(1 + u32::from(self.is_far()));
            }
        }
        Leaf::of(if count == 1 { References::IDENTITY } else { references }, first, count)
    }

    /// Where the children of the inner node at `index` are, the left one first.
    #[inline(always)]
    pub(super) fn children(self, nodes: &[u32], index: u32) -> (u32, u32) {
        // Corrected where it is rare, not chosen: a jump less on the way of nearly all.
        let (mut left, mut right) = (index + 1, index + self.link());
        if self.is_long() {
            right = index.wrapping_add(nodes.get(left as usize).copied().unwrap_or(0));
            left += 1;
        }
        (left, right)
    }

    /// Whether a leaf's count stands in a word of its own.
    #[inline(always)]
    pub(crate) const fn is_large(self) -> bool {
        self.count() == MANY
    }
}

/// What a node says, with the words behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A plane; if one side is empty, the children are the same.
    Inner { axis: Axis, plane: u32, left: u32, right: u32, empty: Option<Side> },
    /// Primitives; the next node is at `end`.
    Leaf { first: u32, count: u32, end: u32 },
}

/// The node at `index`, if all its words are there.
pub(super) fn kind(nodes: &[u32], index: u32) -> Option<Kind> {
    let mut next = index;
    let mut word = || {
        let word = nodes.get(next as usize).copied();
        next = next.saturating_add(1);
        word
    };
    let node = Node(word()?);
    let axis = match node.axis_or_leaf() {
        0 => Axis::X,
        1 => Axis::Y,
        2 => Axis::Z,
        _ => {
            let first = if node.is_far() { word()? } else { node.first() };
            let count = if node.is_large() { word()? } else { node.count() };
            return Some(Kind::Leaf { first, count, end: next });
        }
    };
    let distance = if node.is_long() { word()? } else { node.link() };
    let empty = match node.link() {
        0 => Some(Side::Right),
        1 => Some(Side::Left),
        _ => None,
    };
    let right = if empty.is_some() { next } else { index.checked_add(distance)? };
    Some(Kind::Inner { axis, plane: node.plane(), left: next, right, empty })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_keep_all_14_bits_beside_links() {
        for plane in [0, 1, 8191, LAST_PLANE] {
            for axis in Axis::ALL {
                let node = Node::inner(axis, plane);
                let read = |words: &[u32]| kind(words, 0);
                let cut = |side| Some(Kind::Inner { axis, plane, left: 1, right: 1, empty: Some(side) });
                for side in [Side::Left, Side::Right] {
                    assert_eq!(read(&[node.cutting(side).to_word()]), cut(side));
                }
                for right in [2, LONG - 1] {
                    let expected = Kind::Inner { axis, plane, left: 1, right, empty: None };
                    assert_eq!(read(&[node.linked_by(right).to_word()]), Some(expected));
                }
                for right in [LONG, 1 << 20] {
                    let expected = Kind::Inner { axis, plane, left: 2, right, empty: None };
                    assert_eq!(read(&[node.long().to_word(), right]), Some(expected));
                }
                assert_eq!(read(&[node.long().to_word()]), None);
            }
        }
    }

    #[test]
    fn leaves_spill_what_does_not_fit() {
        for first in [0, 7, FAR - 1, FAR, u32::MAX] {
            for count in [0, 1, MANY - 1, MANY, 1 << 20] {
                let leaf = Node::leaf(first, count);
                let mut words = std::vec![leaf.to_word()];
                words.extend(leaf.is_far().then_some(first));
                words.extend(leaf.is_large().then_some(count));
                assert_eq!(kind(&words, 0), Some(Kind::Leaf { first, count, end: words.len() as u32 }));
                assert_eq!(words.len() > 1, first >= FAR || count >= MANY);
                words.pop();
                assert_eq!(kind(&words, 0), None);
            }
        }
    }
}
