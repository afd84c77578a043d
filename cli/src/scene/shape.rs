use hitscan::accel::{Cell, Hierarchy, Inside};

/// What any structure is made of, found by opening all of its cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// Cells, leaves among them.
    pub nodes: usize,
    /// Primitives named in leaves.
    pub references: usize,
    /// Cells around the deepest leaf.
    pub depth: usize,
    /// Cells that the surface area heuristic expects a ray through the bounds to enter, if it hits nothing.
    pub expected_nodes: f64,
    /// Primitives that it expects it to be tested against.
    pub expected_tests: f64,
}

impl Shape {
    /// Looks at all of `structure`.
    pub fn of<H: Hierarchy>(structure: &H) -> Self {
        let mut shape = Self::default();
        let area = |cell: &Cell<H::Node>| f64::from(cell.bounds.half_area());
        let mut stack: Vec<_> = structure.root().map(|root| (root, 0)).into_iter().collect();
        let whole = stack.first().map_or(0.0, |(root, _)| area(root));
        while let Some((cell, depth)) = stack.pop() {
            let chance = if whole > 0.0 { area(&cell) / whole } else { 1.0 };
            shape.nodes += 1;
            shape.depth = shape.depth.max(depth);
            shape.expected_nodes += chance;
            match structure.open(&cell) {
                Inside::Cells(cells) => stack.extend(cells.into_iter().flatten().map(|cell| (cell, depth + 1))),
                Inside::Leaf(leaf) => {
                    let count = leaf.count();
                    shape.references += count;
                    shape.expected_tests += chance * count as f64;
                }
            }
        }
        shape
    }
}

#[cfg(test)]
mod tests {
    use hitscan::{KdTree, accel::Plan, bake, kdtree::Options};

    use super::*;
    use crate::compare::terrain;

    #[test]
    fn a_tree_is_as_it_says_itself() {
        let geometry = terrain(2000);
        let words = bake::build(&geometry.mesh().unwrap(), &Plan::KdTree(Options::small())).unwrap();
        let tree = KdTree::open(&words).unwrap();
        let shape = Shape::of(&tree);
        assert_eq!((shape.nodes, shape.depth), (tree.node_count(), tree.depth() as usize));
        let (nodes, tests) = tree.expected_work();
        assert!((shape.expected_nodes / f64::from(nodes) - 1.0).abs() < 1.0e-3);
        assert!((shape.expected_tests / f64::from(tests) - 1.0).abs() < 1.0e-3);
    }
}
