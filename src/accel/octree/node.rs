use glam::Vec3;

use crate::{
    accel::{Leaf, leaf::References},
    geometry::{Aabb, Axis},
};

/// A node: one word.
///
/// | | bit 31 | bits 24 … 30 | bits 0 … 23 |
/// |---|---|---|---|
/// | leaf of one | 1 | 1 | the primitive |
/// | leaf of 2 … 127 | 1 | how many | word of the first reference |
/// | any other leaf | 1 | 0 | word that says how many; the references follow |
///
/// | | bit 31 | bits 23 … 30 | bits 0 … 22 |
/// |---|---|---|---|
/// | inner node | 0 | which of the octants have something in them | word where its point begins |
///
/// An inner node's [`Point`] is followed by its children, those that are there. Bit 0 of an octant's number says whether it
/// lies behind the point along x, bit 1 along y and bit 2 along z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Node(pub(super) u32);

/// What a node says; indices are those of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Octants that are there, and where the point begins.
    Inner { octants: u32, block: u32 },
    /// A leaf of one primitive.
    One(u32),
    /// A leaf of so many.
    Few { first: u32, count: u32 },
    /// A leaf whose count stands before the references.
    Many { counted: u32 },
}

/// The greatest word of a block and its children that nodes can name.
pub(super) const MAX_WORD: u32 = (1 << 23) - 1;

/// The greatest number of primitives that leaves of one can name.
pub(super) const MAX_PRIMITIVES: u32 = 1 << 24;

/// The greatest number of references that a leaf itself can tell.
pub(super) const MAX_FEW: u32 = 127;

const LEAF: u32 = 1 << 31;

impl Node {
    pub(super) const fn inner(octants: u32, block: u32) -> Self {
        Self((octants & 255) << 23 | block & MAX_WORD)
    }

    pub(super) const fn leaf(count: u32, index: u32) -> Self {
        Self(LEAF | (count & MAX_FEW) << 24 | index & (MAX_PRIMITIVES - 1))
    }

    #[inline(always)]
    pub(super) const fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// The octants of an inner node that are there.
    #[inline(always)]
    pub(super) const fn octants(self) -> u32 {
        self.0 >> 23
    }

    /// Where an inner node's point begins.
    #[inline(always)]
    pub(super) const fn block(self) -> u32 {
        self.0 & MAX_WORD
    }

    /// The word of an inner node's child.
    #[inline(always)]
    pub(super) const fn child(self, octant: u32) -> u32 {
        // A product adds up the bits below each octant, a digit of four bits each: all at once, before it is known which
        // octant is asked for.
        let ranks = spread(self.octants()).wrapping_mul(0x1111_1110);
        self.block() + Point::WORDS as u32 + (ranks >> (4 * (octant & 7)) & 15)
    }

    /// The primitives of a leaf.
    #[inline(always)]
    pub(super) fn leaf_in(self, body: &[u32], wide: bool) -> Leaf<'_> {
        let (references, halves) = if wide { (References::wide(body), 0) } else { (References::narrow(body), 1) };
        match self.kind() {
            Kind::One(primitive) => Leaf::of(References::IDENTITY, primitive, 1),
            Kind::Few { first, count } => Leaf::of(references, first << halves, count),
            Kind::Many { counted } => {
                let count = body.get(counted as usize).copied().unwrap_or(0);
                Leaf::of(references, (counted + 1) << halves, count)
            }
            Kind::Inner { .. } => Leaf::of(References::IDENTITY, 0, 0),
        }
    }

    /// All of it at once.
    #[inline(always)]
    pub(super) const fn kind(self) -> Kind {
        let index = self.0 & (MAX_PRIMITIVES - 1);
        if !self.is_leaf() {
            return Kind::Inner { octants: self.octants(), block: self.block() };
        }
        match self.0 >> 24 & MAX_FEW {
            0 => Kind::Many { counted: index },
            1 => Kind::One(index),
            count => Kind::Few { first: index, count },
        }
    }
}

/// The octants behind the plane across an axis.
pub(super) const fn behind(axis: Axis) -> u32 {
    match axis {
        Axis::X => 0xaa,
        Axis::Y => 0xcc,
        Axis::Z => 0xf0,
    }
}

/// Eight bits, a digit of four bits each.
#[inline(always)]
const fn spread(octants: u32) -> u32 {
    let halves = (octants | octants << 12) & 0x000f_000f;
    let pairs = (halves | halves << 6) & 0x0303_0303;
    (pairs | pairs << 3) & 0x1111_1111
}

/// How many of eight bits are set: not all processors can say.
#[inline(always)]
pub(super) const fn count(octants: u32) -> u32 {
    let pairs = octants - (octants >> 1 & 0x55);
    let halves = (pairs & 0x33) + (pairs >> 2 & 0x33);
    (halves + (halves >> 4)) & 15
}

/// Where the three planes that divide a cell meet.
///
/// Along an axis that is not divided the plane lies at infinity: everything is before it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Point(pub(super) [f32; 3]);

impl Point {
    /// Words that a point takes.
    pub(super) const WORDS: usize = 3;

    pub(super) fn from_words(words: &[u32]) -> Option<Self> {
        let &[x, y, z] = words.first_chunk::<{ Self::WORDS }>()?;
        Some(Self([f32::from_bits(x), f32::from_bits(y), f32::from_bits(z)]))
    }

    pub(super) fn to_words(self) -> [u32; Self::WORDS] {
        self.0.map(f32::to_bits)
    }

    /// The position of the plane across an axis.
    pub(super) fn along(self, axis: Axis) -> f32 {
        axis.of(Vec3::from_array(self.0))
    }

    /// The part of a cell in an octant.
    pub(super) fn octant(self, cell: &Aabb, octant: u32) -> Aabb {
        let mut part = *cell;
        for axis in Axis::ALL {
            let position = self.along(axis);
            if position < f32::INFINITY {
                let (near, far) = part.split(axis, position);
                part = if 1 << octant & behind(axis) == 0 { near } else { far };
            }
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_keep_their_numbers() {
        for index in [0, 1, MAX_WORD] {
            for octants in 0..256 {
                let node = Node::inner(octants, index);
                assert_eq!(node.kind(), Kind::Inner { octants, block: index });
                let below = |octant: u32| (0..octant).filter(|bit| octants >> bit & 1 != 0).count() as u32;
                (0..8).for_each(|octant| assert_eq!(node.child(octant), index + 3 + below(octant)));
            }
        }
        for index in [0, 1, MAX_PRIMITIVES - 1] {
            assert_eq!(Node::leaf(1, index).kind(), Kind::One(index));
            assert_eq!(Node::leaf(0, index).kind(), Kind::Many { counted: index });
            assert_eq!(Node::leaf(2, index).kind(), Kind::Few { first: index, count: 2 });
            assert_eq!(Node::leaf(127, index).kind(), Kind::Few { first: index, count: 127 });
        }
    }

    #[test]
    fn bits_are_counted() {
        (0..256_u32).for_each(|octants| assert_eq!(count(octants), octants.count_ones()));
    }
}
