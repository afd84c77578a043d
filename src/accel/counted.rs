use core::cell::Cell as Count;

use super::{Accelerator, Cell, Hierarchy, Inside, Step, Traversal};
use crate::geometry::{Aabb, PreparedRay};

/// A structure that counts the nodes its walks visit: a decorator, so that nobody else pays.
///
/// What [`Traversal::step`] takes off its budget is what counts; [`primitives::Counted`](crate::primitives::Counted) counts
/// the tests in the leaves.
///
/// ```
/// use core::cell::Cell;
/// use hitscan::{Arena, KdTree, Mesh, Ray, Scene, accel::Counted, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let mut memory = [0; 2000];
/// let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::small())?;
///
/// let nodes = Cell::new(0);
/// let scene = Scene::new(Counted::new(tree, &nodes), &mesh)?;
/// assert!(scene.any_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)));
/// assert_eq!(nodes.get(), 1);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Counted<'c, A> {
    accelerator: A,
    nodes: &'c Count<u64>,
}

impl<'c, A> Counted<'c, A> {
    /// `accelerator`, each node visited added to `nodes`.
    pub const fn new(accelerator: A, nodes: &'c Count<u64>) -> Self {
        Self { accelerator, nodes }
    }
}

impl<'c, A: Accelerator> Accelerator for Counted<'c, A> {
    type Traversal = CountedTraversal<'c, A::Traversal>;

    fn primitives(&self) -> u32 {
        self.accelerator.primitives()
    }

    fn bounds(&self) -> Aabb {
        self.accelerator.bounds()
    }

    fn traverse(&self, ray: &PreparedRay) -> Self::Traversal {
        CountedTraversal { inner: self.accelerator.traverse(ray), nodes: self.nodes }
    }
}

/// The cells of the structure; opening one counts as a node.
impl<A: Hierarchy> Hierarchy for Counted<'_, A> {
    type Node = A::Node;
    type Leaf = A::Leaf;

    fn root(&self) -> Option<Cell<A::Node>> {
        self.accelerator.root()
    }

    fn open(&self, cell: &Cell<A::Node>) -> Inside<A::Node, A::Leaf> {
        add(self.nodes, 1);
        self.accelerator.open(cell)
    }
}

/// The walk over a [`Counted`] structure.
#[derive(Clone, Copy, Debug)]
pub struct CountedTraversal<'c, T> {
    inner: T,
    nodes: &'c Count<u64>,
}

impl<T: Traversal> Traversal for CountedTraversal<'_, T> {
    type Leaf = T::Leaf;

    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<T::Leaf> {
        loop {
            let mut budget = u32::MAX;
            match self.step(ray, t_max, &mut budget) {
                Step::Leaf(leaf) => return Some(leaf),
                Step::Paused => {}
                Step::Done => return None,
            }
        }
    }

    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<T::Leaf> {
        let before = *budget;
        let step = self.inner.step(ray, t_max, budget);
        add(self.nodes, u64::from(before.saturating_sub(*budget)));
        step
    }
}

/// Adds to a count.
fn add(count: &Count<u64>, more: u64) {
    count.set(count.get().saturating_add(more));
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{Arena, KdTree, Mesh, Ray, Scene, kdtree::Options, primitives, query::Progress};

    #[test]
    fn pauses_change_neither_counts_nor_hits() {
        let vertices: [Vec3; 24] = core::array::from_fn(|i| Vec3::new((i * 7 % 24) as f32, (i % 5) as f32, i as f32));
        let triangles: [[u16; 3]; 22] = core::array::from_fn(|i| [i, i + 1, i + 2].map(|corner| corner as u16));
        let mesh = Mesh::new(&vertices, &triangles).unwrap();
        let mut memory = [0; 4000];
        let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::fast()).unwrap();
        let (nodes, tests) = (Count::new(0), Count::new(0));
        let plain = Scene::new(tree, &mesh).unwrap();
        let counted = Scene::new(Counted::new(tree, &nodes), primitives::Counted::new(&mesh, &tests)).unwrap();
        let taken = || (nodes.take(), tests.take());
        for i in 0..50_u8 {
            let ray = Ray::between(Vec3::new(12.0, 2.0, -5.0), Vec3::new(f32::from(i % 24), 2.2, f32::from(i)));
            let hit = counted.closest_hit(&ray);
            assert_eq!(hit, plain.closest_hit(&ray));
            let whole = taken();
            assert!(whole.0 > 0 || hit.is_none());
            let mut query = counted.begin(&ray);
            let paused = loop {
                if let Progress::Done(hit) = query.advance(1) {
                    break hit;
                }
            };
            assert_eq!((paused, taken()), (hit, whole));
        }
    }
}
