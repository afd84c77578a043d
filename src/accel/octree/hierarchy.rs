use super::{Octree, node::behind};
use crate::{
    accel::{Cell, Hierarchy, Inside, Leaf},
    geometry::{Aabb, Axis},
};

/// A node, or its octants on some sides of its planes.
#[derive(Clone, Copy, Debug)]
pub struct Octants {
    /// Where it stands.
    pub(super) word: u32,
    /// Which of its octants; without meaning for a leaf.
    pub(super) octants: u32,
}

/// A node is seen as a plane across x, then y, then z.
impl<'a> Hierarchy for Octree<'a> {
    type Node = Octants;
    type Leaf = Leaf<'a>;

    fn root(&self) -> Option<Cell<Octants>> {
        let octants = self.node(0)?.octants();
        Some(Cell { bounds: self.bounds, node: Octants { word: 0, octants } })
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
                let octants = self.node(word)?.octants();
                Some(Cell { bounds, node: Octants { word, octants } })
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
