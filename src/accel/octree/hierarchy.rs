use super::{Octree, node::behind};
use crate::{
    accel::{Cell, Hierarchy, Inside, Leaf, segment::Segment, sweep::Ahead},
    geometry::{Aabb, Axis, Bundle},
};

/// A node, or its octants on some sides of its planes.
#[derive(Clone, Copy, Debug)]
pub struct Octants {
    /// Where it stands.
    pub(super) word: u32,
    /// Which of its octants; without meaning for a leaf.
    pub(super) octants: u32,
}

impl Octants {
    /// Both in a word, as what a [`Segment`] knows a node by: words have 24 bits.
    pub(super) const fn to_bits(self) -> u32 {
        self.octants << 24 | self.word
    }

    pub(super) const fn from_bits(bits: u32) -> Self {
        Self { word: bits & 0x00ff_ffff, octants: bits >> 24 }
    }
}

impl Octree<'_> {
    /// All octants of a node.
    pub(super) fn whole(&self, word: u32) -> Option<Octants> {
        Some(Octants { word, octants: self.node(word)?.octants() })
    }

    /// What the rays of a bundle find in some octants: across one plane after the other, so that at most three parts of a node
    /// wait.
    #[inline(always)]
    pub(super) fn ahead(&self, segment: Segment, bundle: &Bundle) -> Ahead {
        let Octants { word, octants } = Octants::from_bits(segment.node);
        let Some(node) = self.node(word) else { return Ahead::Nothing };
        if node.is_leaf() {
            return Ahead::Primitives;
        }
        let Some(point) = self.point(node.block()) else { return Ahead::Nothing };
        if octants.is_power_of_two() {
            let child = self.whole(node.child(octants.trailing_zeros()));
            return child.map_or(Ahead::Nothing, |child| Ahead::One(segment.at(child.to_bits())));
        }
        let part = |octants| segment.at(Octants { word, octants }.to_bits());
        for axis in Axis::ALL {
            let behind = octants & behind(axis);
            let before = octants & !behind;
            if before != 0 && behind != 0 {
                let (left, _) = part(before).below(axis, point.along(axis), bundle);
                let (right, descends) = part(behind).above(axis, point.along(axis), bundle);
                return if descends { Ahead::of(right, left) } else { Ahead::of(left, right) };
            }
        }
        Ahead::Nothing
    }
}

/// A node is seen as a plane across x, then y, then z.
impl<'a> Hierarchy for Octree<'a> {
    type Node = Octants;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<Octants>> {
        Some(Cell { bounds: self.bounds, node: self.whole(0)? })
    }

    fn open(&self, cell: &Cell<Octants>) -> Inside<Octants, Leaf<'a>> {
        let Octants { word, octants } = cell.node;
        let Some(node) = self.node(word) else { return Inside::Cells([None; 2]) };
        if node.is_leaf() {
            return Inside::Leaf(node.leaf_in(self.body, self.is_wide()));
        }
        let Some(point) = self.point(node.block()) else { return Inside::Cells([None; 2]) };
        let part = |bounds: Aabb, octants: u32| match octants.count_ones() {
            0 => None,
            1 => {
                let octant = octants.trailing_zeros();
                let (bounds, word) = (point.octant(&bounds, octant), node.child(octant));
                Some(Cell { bounds, node: self.whole(word)? })
            }
            _ => Some(Cell { bounds, node: Octants { word, octants } }),
        };
        for axis in Axis::ALL {
            let behind = octants & behind(axis);
            let before = octants & !behind;
            if before != 0 && behind != 0 {
                let (below, above) = cell.bounds.split(axis, point.along(axis));
                return Inside::Cells([part(below, before), part(above, behind)]);
            }
        }
        Inside::Cells([part(cell.bounds, octants), None])
    }
}
