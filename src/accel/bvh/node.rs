use crate::{
    geometry::{Aabb, Axis, Lattice},
    math::greatest,
};

/// A box and what is in it, in 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Node {
    pub(crate) planes: Planes,
    pub(crate) link: Link,
}

/// The two children of a node, side by side: a step of a walk reads these 32 bytes.
pub(crate) type Pair = [Node; 2];

/// Words per pair.
pub(crate) const PAIR_WORDS: usize = size_of::<Pair>() / 4;

/// A box on a lattice: per axis a word, the number of its lower plane in the lower half, of its upper one in the upper.
///
/// Turned by 16 bits, a word shows the plane where a ray along the falling axis enters: no branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(crate) struct Planes([u32; 3]);

/// What is in a box: bits 0 … 3 count the primitives of a leaf, behind them stands the first one's position; if they are
/// 0, behind them stands the number of the pair of children.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(crate) struct Link(u32);

/// The greatest number in a link.
pub(crate) const MAX_NUMBER: u32 = (1 << 28) - 1;

/// The most primitives in a leaf.
pub(crate) const MAX_LEAF: u32 = 15;

impl Node {
    /// Nowhere.
    pub(crate) const NOTHING: Self = Self { planes: Planes([0; 3]), link: Link(0) };
}

impl Link {
    /// To a pair of children.
    pub(crate) const fn inner(pair: u32) -> Self {
        Self(pair << 4)
    }

    /// To `count` primitives from a position, 1 … [`MAX_LEAF`].
    pub(crate) const fn leaf(first: u32, count: u32) -> Self {
        Self(first << 4 | count)
    }

    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    pub(crate) const fn to_bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(crate) const fn is_leaf(self) -> bool {
        self.0 & MAX_LEAF != 0
    }

    /// How many primitives a leaf has.
    #[inline(always)]
    pub(crate) const fn count(self) -> u32 {
        self.0 & MAX_LEAF
    }

    /// The position of a leaf's first primitive, or the number of the pair.
    #[inline(always)]
    pub(crate) const fn number(self) -> u32 {
        self.0 >> 4
    }
}

impl Planes {
    /// The least box on `lattice` that contains `bounds`.
    pub(crate) fn around(bounds: &Aabb, lattice: &Lattice) -> Self {
        // Inside the lattice, whose last planes have 16 bits.
        Self(Axis::ALL.map(|axis| {
            lattice.below(axis, axis.of(bounds.min)) & 0xffff | lattice.above(axis, axis.of(bounds.max)) << 16
        }))
    }

    /// The least box that contains both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self(Axis::ALL.map(|axis| {
            let (a, b) = (self.of(axis), other.of(axis));
            (a & 0xffff).min(b & 0xffff) | (a >> 16).max(b >> 16) << 16
        }))
    }

    /// The two planes of an axis in a word.
    #[inline(always)]
    pub(crate) const fn of(self, axis: Axis) -> u32 {
        match axis {
            Axis::X => self.0[0],
            Axis::Y => self.0[1],
            Axis::Z => self.0[2],
        }
    }

    /// The box in space. (Where planes coincide, the number of a lower one can be the greater.)
    pub(crate) fn bounds(self, lattice: &Lattice) -> Aabb {
        let corner = |shift: u32| {
            let [x, y, z] = Axis::ALL.map(|axis| lattice.position(axis, self.of(axis) >> shift & 0xffff));
            glam::Vec3::new(x, y, z)
        };
        Aabb::new(corner(0), corner(16))
    }
}

/// How likely rays meet a box: its surface, with lengths relative to the largest so that nothing overflows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface([f32; 3]);

impl Surface {
    /// For boxes on the lattice over this one.
    pub(crate) fn within(bounds: &Aabb) -> Self {
        let size = bounds.size() / (greatest(bounds.size().max_element(), f32::MIN_POSITIVE) * 65_535.0);
        Self(size.to_array())
    }

    /// Half the surface, and a little for the lengths so that boxes without surface are told apart, too.
    #[inline]
    pub(crate) fn of(&self, planes: Planes) -> f32 {
        let length = |word: u32, unit: f32| (word >> 16).saturating_sub(word & 0xffff) as i32 as f32 * unit;
        let ([x, y, z], [u, v, w]) = (planes.0, self.0);
        let (x, y, z) = (length(x, u), length(y, v), length(z, w));
        x * y + y * z + z * x + (x + y + z) * 1.0e-6
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::testing::{Random, cases};

    #[test]
    fn links_hold_28_bits_beside_the_count() {
        for number in [0, 1, MAX_NUMBER] {
            let inner = Link::inner(number);
            assert!(!inner.is_leaf() && inner.number() == number);
            for count in 1..=MAX_LEAF {
                let leaf = Link::leaf(number, count);
                assert!(leaf.is_leaf() && leaf.number() == number && leaf.count() == count);
            }
        }
    }

    #[test]
    fn a_box_around_boxes_is_the_union_of_those_around_each() {
        let mut random = Random::new(3);
        let mut point = || Vec3::from_array([0; 3].map(|_| random.unit() * 9.0 - 4.0));
        let whole = Aabb::new(Vec3::splat(-4.0), Vec3::splat(5.0));
        let lattice = Lattice::over(&whole, [65_535; 3]);
        for _ in 0..cases(1000) {
            let (a, b) = (Aabb::around([point(), point()]), Aabb::around([point(), point()]));
            let [one, two, both] = [a, b, a.union(&b)].map(|bounds| Planes::around(&bounds, &lattice));
            assert_eq!(one.union(two), both);
            let bounds = both.bounds(&lattice);
            assert_eq!(bounds.union(&a).union(&b), bounds);
        }
        assert!(Planes([0x0001_0000, 0x0001_0002, 0]).bounds(&lattice).is_empty());
    }
}
