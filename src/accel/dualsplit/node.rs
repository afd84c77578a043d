use super::block::Face;
use crate::geometry::{Axis, descends};

/// The first word of a node.
///
/// | | bits 4 … 31 | bits 2, 3 | bits 0, 1 | second word |
/// |---|---|---|---|---|
/// | split | word at which the right child begins; the left one follows | 0 | axis | where the left child ends, and where the right one begins |
/// | carve | bits 4 … 7: the second [`Face`], as the first without bit 2; the only child follows | 1, or 3 if the first face is an upper one | axis of the first | where these faces are |
/// | leaf | bits 6 …: position of its first primitive; bits 2 … 5: how many | | 3 | none |
///
/// The second word holds the numbers of two planes, the first in its lower half. So a ray that ascends leaves a split's
/// left child at the lower half and enters the right one at the upper; one that descends, the other way round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Head(u32);

/// What the first word of a node says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Two children.
    Split { axis: Axis, right: u32 },
    /// Empty space cut off at two faces of the only child.
    Carve { faces: [Face; 2] },
    /// Primitives.
    Leaf { first: u32, count: u32 },
}

/// The bit of a carve.
const CARVE: u32 = 1 << 2;

/// The bit of an upper face.
const UPPER: u32 = 1 << 3;

/// A face in four bits.
const fn bits(face: Face) -> u32 {
    face.axis as u32 | if face.upper { UPPER } else { 0 }
}

/// A face from four bits.
const fn face(bits: u32) -> Option<Face> {
    match axis(bits) {
        Some(axis) => Some(Face { axis, upper: bits & UPPER != 0 }),
        None => None,
    }
}

/// The axis whose number is in the lower two bits.
const fn axis(bits: u32) -> Option<Axis> {
    match bits & 3 {
        0 => Some(Axis::X),
        1 => Some(Axis::Y),
        2 => Some(Axis::Z),
        _ => None,
    }
}

impl Head {
    /// What [`axis_or_leaf`](Self::axis_or_leaf) is of a leaf.
    pub(super) const LEAF: u32 = 3;

    /// The most primitives of a leaf.
    pub(super) const MAX_COUNT: u32 = (1 << 4) - 1;

    /// The most primitives that can be told apart.
    pub(super) const MAX_PRIMITIVES: u32 = 1 << 26;

    /// Two children, the right one at the word `right`.
    pub(super) const fn split(axis: Axis, right: u32) -> Self {
        Self(right << 4 | axis as u32)
    }

    /// The same with another right child.
    pub(super) const fn linked_to(self, right: u32) -> Self {
        Self(right << 4 | self.0 & 15)
    }

    /// One child.
    pub(super) const fn carve([first, second]: [Face; 2]) -> Self {
        Self(bits(second) << 4 | CARVE | bits(first))
    }

    /// A leaf.
    pub(super) const fn leaf(first: u32, count: u32) -> Self {
        Self(first << 6 | count << 2 | Self::LEAF)
    }

    /// The word.
    pub(super) const fn to_word(self) -> u32 {
        self.0
    }

    /// The head in a word.
    #[inline(always)]
    pub(super) const fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// The number of the axis, of a carve that of its first face, or 3 of a leaf.
    #[inline(always)]
    pub(super) const fn axis_or_leaf(self) -> u32 {
        self.0 & 3
    }

    /// Whether something other than a leaf is a carve.
    #[inline(always)]
    pub(super) const fn is_carve(self) -> bool {
        self.0 & CARVE != 0
    }

    /// Whether a ray that descends along the axes of `mask` meets higher coordinates first.
    #[inline(always)]
    pub(super) const fn is_descended(self, mask: u32) -> bool {
        descends(mask, self.0)
    }

    /// Whether the first face is an upper one.
    #[inline(always)]
    pub(super) const fn is_upper(self) -> bool {
        self.0 & UPPER != 0
    }

    /// Whether a ray that descends along the axes of `mask` enters what is left of a carve at its first face: upper where it
    /// descends, lower where it does not.
    #[inline(always)]
    pub(super) const fn is_entered(self, mask: u32) -> bool {
        // Turned around where bit 3 of the word, which is that of an upper face, is not set.
        descends(mask ^ 0x00ff_00ff, self.0)
    }

    /// The same with the second face as the first.
    #[inline(always)]
    pub(super) const fn turned(self) -> Self {
        Self(self.0 >> 4)
    }

    /// The word at which a split's right child begins.
    #[inline(always)]
    pub(super) const fn right(self) -> u32 {
        self.0 >> 4
    }

    /// The position of a leaf's first primitive.
    #[inline(always)]
    pub(super) const fn first(self) -> u32 {
        self.0 >> 6
    }

    /// How many primitives a leaf has.
    #[inline(always)]
    pub(super) const fn count(self) -> u32 {
        self.0 >> 2 & Self::MAX_COUNT
    }

    /// All of it at once; none if no node begins so.
    pub(super) const fn kind(self) -> Option<Kind> {
        let Some(axis) = axis(self.0) else {
            return Some(Kind::Leaf { first: self.first(), count: self.count() });
        };
        if !self.is_carve() {
            return if self.is_upper() { None } else { Some(Kind::Split { axis, right: self.right() }) };
        }
        match (face(self.0), face(self.0 >> 4), self.0 >> 4 & !(UPPER | 3)) {
            (Some(first), Some(second), 0) => Some(Kind::Carve { faces: [first, second] }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_hold_what_they_promise() {
        for axis in Axis::ALL {
            for right in [0, 1, (1 << 28) - 1] {
                let head = Head::split(axis, 7).linked_to(right);
                assert_eq!(head, Head::split(axis, right));
                assert_eq!(Head::from_word(head.to_word()).kind(), Some(Kind::Split { axis, right }));
                assert!(!head.is_carve());
            }
            for second in Axis::ALL {
                for [upper, other] in [[false, true], [true, true], [true, false]] {
                    let faces = [Face { axis, upper }, Face { axis: second, upper: other }];
                    let carve = Head::carve(faces);
                    assert_eq!(carve.kind(), Some(Kind::Carve { faces }));
                    assert!(carve.is_carve() && carve.is_upper() == upper && carve.turned().is_upper() == other);
                    for bit in [6].into_iter().chain(8..32) {
                        assert_eq!(Head::from_word(carve.to_word() ^ 1 << bit).kind(), None);
                    }
                }
            }
        }
        for first in [0, 1, Head::MAX_PRIMITIVES - 1] {
            for count in [0, 1, Head::MAX_COUNT] {
                assert_eq!(Head::leaf(first, count).kind(), Some(Kind::Leaf { first, count }));
            }
        }
    }
}
