use bytemuck::{Pod, Zeroable};

use crate::geometry::Aabb;

/// How many children a node has room for, and how many triangles and how many corners a block.
pub(super) const WIDTH: usize = 8;

/// Eight boxes by their planes, and what is in them: four lines of a cache.
///
/// The rows are the least and the greatest coordinates along x, y and z, the children, and the orders of these.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub rows: [[u32; WIDTH]; 8],
}

/// The row of the children.
pub(super) const CHILDREN: usize = 6;

/// The row of the orders in which rays meet the children, one for each octant of directions: the last one met first, four
/// bits each.
pub(super) const ORDERS: usize = 7;

impl Node {
    /// A node without children. Rays miss their boxes, unless they lie in planes or reach back where no axis decides.
    pub(super) const fn empty() -> Self {
        let (min, max) = ([f32::INFINITY.to_bits(); WIDTH], [f32::NEG_INFINITY.to_bits(); WIDTH]);
        Self { rows: [min, max, min, max, min, max, [Child::NONE.0; WIDTH], [0; WIDTH]] }
    }

    /// Something of each line.
    #[inline(always)]
    pub(super) const fn touch(&self) -> u32 {
        self.rows[0][0] ^ self.rows[2][0] ^ self.rows[4][0] ^ self.rows[6][0]
    }

    /// Puts a child into its place.
    pub(super) fn set(&mut self, place: usize, bounds: &Aabb, child: Child) {
        let (min, max) = (bounds.min, bounds.max);
        let words = [min.x, max.x, min.y, max.y, min.z, max.z].map(f32::to_bits);
        for (row, word) in self.rows.iter_mut().zip(words.into_iter().chain([child.0])) {
            row[place] = word;
        }
    }

    /// Finds the orders of the children; all are in their places.
    pub(super) fn order(&mut self) {
        for octant in 0..WIDTH {
            // How far along the diagonal of the octant the corner is that is met first; none of an empty place.
            let mut keys = [0.0; WIDTH];
            for axis in 0..3 {
                let descends = octant >> axis & 1;
                let sign = if descends == 0 { 1.0 } else { -1.0 };
                for (key, &word) in keys.iter_mut().zip(&self.rows[2 * axis + descends]) {
                    *key += f32::from_bits(word) * sign;
                }
            }
            let mut ranks = [0; WIDTH];
            for (other, key) in keys.iter().enumerate() {
                for (place, rank) in ranks.iter_mut().enumerate() {
                    // Of those that are met at once the later ones come first.
                    *rank += u32::from(*key > keys[place]) + u32::from(*key == keys[place] && other < place);
                }
            }
            let order = (0..WIDTH as u32).zip(ranks).fold(0, |order, (place, rank)| order | place << (4 * rank));
            self.rows[ORDERS][octant] = order;
        }
    }
}

/// Where a child is, in a word: a node, or a block of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub u32);

impl Child {
    /// Set for blocks.
    pub(super) const LEAF: u32 = 1 << 31;

    const CORNERS: u32 = 28;

    /// Words in which blocks can begin, at even ones.
    pub(super) const MAX_WORDS: usize = (2 << Self::CORNERS) - 2;

    /// No child: a block where none can begin.
    pub(super) const NONE: Self = Self(u32::MAX);

    /// A node.
    pub(super) const fn node(index: u32) -> Self {
        Self(index)
    }

    /// The block of so many corners, 1 to 8, that begins at this word, an even one.
    pub(super) const fn block(first: usize, corners: usize) -> Self {
        Self(Self::LEAF | (corners as u32 - 1) << Self::CORNERS | (first / 2) as u32)
    }

    /// Whether it is a block.
    #[inline(always)]
    pub(super) const fn is_block(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// The first word of a block.
    #[inline(always)]
    pub(super) const fn first(self) -> usize {
        (self.0 & ((1 << Self::CORNERS) - 1)) as usize * 2
    }

    /// How many corners a block has.
    #[inline(always)]
    pub(super) const fn corners(self) -> usize {
        (self.0 >> Self::CORNERS & 7) as usize + 1
    }
}
