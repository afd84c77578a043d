use crate::geometry::{Axis, descends};

/// A node of 8 bytes, after Pharr, Jakob and Humphreys, *Physically Based Rendering*, §4.4.
///
/// | | payload | link, bits 4 … 31 | bits 2, 3 | bits 0, 1 |
/// |---|---|---|---|---|
/// | inner node | position of the plane (`f32`) | number of the right child; the left one follows | 0 | axis 0, 1, 2 |
/// | cut | position of the plane (`f32`) | number of the next node, its only child | 1: empty on the left, 2: on the right | axis |
/// | leaf of one | the primitive | 1 | 0 | 3 |
/// | other leaf | index of the first reference | how many | 0 | 3 |
///
/// A cut spares the empty leaf: of all nodes they would be a quarter.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Node {
    payload: u32,
    link: u32,
}

/// What a node says.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// A plane between the next node and `right`; if one side is empty, they are the same.
    Inner { axis: Axis, position: f32, right: u32, empty: Option<Side> },
    /// Primitives.
    Leaf { first: u32, count: u32 },
}

/// A side of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Of lower coordinates.
    Left = 1,
    /// Of higher coordinates.
    Right = 2,
}

/// The greatest number that a link holds.
pub(crate) const MAX_LINK: u32 = (1 << 28) - 1;

impl Node {
    /// What [`axis_or_leaf`](Self::axis_or_leaf) is of a leaf.
    pub(crate) const LEAF: u32 = 3;

    /// Words per node.
    pub(crate) const WORDS: usize = 2;

    /// A plane; the right child's number is set by [`linked_to`](Self::linked_to).
    pub(crate) const fn inner(axis: Axis, position: f32) -> Self {
        Self { payload: position.to_bits(), link: axis as u32 }
    }

    /// The same plane with its right child.
    pub(crate) const fn linked_to(self, right: u32) -> Self {
        Self { link: right << 4 | self.link & 15, ..self }
    }

    /// The same plane with nothing on one side.
    pub(crate) const fn cutting(self, empty: Side) -> Self {
        Self { link: self.link | (empty as u32) << 2, ..self }
    }

    /// A leaf.
    pub(crate) const fn leaf(first: u32, count: u32) -> Self {
        Self { payload: first, link: count << 4 | Self::LEAF }
    }

    /// Whether one side of a plane is empty.
    #[inline(always)]
    pub(crate) const fn is_cut(self) -> bool {
        self.link & 12 != 0
    }

    /// Whether it is the right side of a cut that is empty.
    #[inline(always)]
    pub(crate) const fn is_empty_on_the_right(self) -> bool {
        self.link & 8 != 0
    }

    /// The number of an inner node's axis, or 3 of a leaf.
    #[inline(always)]
    pub(crate) const fn axis_or_leaf(self) -> u32 {
        self.link & 3
    }

    /// Whether a ray that descends along the axes of `mask` meets the right child first.
    #[inline(always)]
    pub(crate) const fn is_descended(self, mask: u32) -> bool {
        descends(mask, self.link)
    }

    /// The number of an inner node's right child, or of a leaf's primitives.
    #[inline(always)]
    pub(crate) const fn number(self) -> u32 {
        self.link >> 4
    }

    /// The position of an inner node's plane.
    #[inline(always)]
    pub(crate) const fn position(self) -> f32 {
        f32::from_bits(self.payload)
    }

    /// A leaf's first reference, or its only primitive.
    #[inline(always)]
    pub(crate) const fn first(self) -> u32 {
        self.payload
    }

    /// All of it at once, for who is not in a hurry.
    pub(crate) const fn kind(self) -> Kind {
        let axis = match self.axis_or_leaf() {
            0 => Axis::X,
            1 => Axis::Y,
            2 => Axis::Z,
            _ => return Kind::Leaf { first: self.first(), count: self.number() },
        };
        let empty = match self.link >> 2 & 3 {
            0 => None,
            1 => Some(Side::Left),
            _ => Some(Side::Right),
        };
        Kind::Inner { axis, position: self.position(), right: self.number(), empty }
    }

    /// The two words.
    pub(crate) const fn to_words(self) -> [u32; 2] {
        [self.payload, self.link]
    }

    /// The node in two words.
    pub(crate) const fn from_words([payload, link]: [u32; 2]) -> Self {
        Self { payload, link }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_hold_28_bits_beside_axis_and_sides() {
        for number in [0, 1, MAX_LINK] {
            for axis in Axis::ALL {
                for empty in [None, Some(Side::Left), Some(Side::Right)] {
                    let plane = Node::inner(axis, -1.5);
                    let plane = empty.map_or(plane, |side| plane.cutting(side)).linked_to(number);
                    let Kind::Inner { axis: a, position: -1.5, right, empty: side } = plane.kind() else {
                        panic!("{plane:?}");
                    };
                    assert_eq!((a, right, side), (axis, number, empty));
                    assert_eq!(plane.is_cut(), empty.is_some());
                    assert_eq!(plane.is_empty_on_the_right(), empty == Some(Side::Right));
                }
            }
            let leaf = Node::leaf(u32::MAX, number);
            assert!(matches!(leaf.kind(), Kind::Leaf { first: u32::MAX, count } if count == number));
        }
    }
}
