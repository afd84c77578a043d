use core::cell::Cell as Count;

use super::{Accelerator, Cell, Entries, Entry, Hierarchy, Inside, Step, Traversal};
use crate::geometry::{Aabb, Bundle, PreparedRay};

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

    fn enter(&self, bundle: &Bundle) -> Entries {
        self.accelerator.enter(bundle)
    }

    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> Self::Traversal {
        CountedTraversal { inner: self.accelerator.traverse_from(entry, ray), nodes: self.nodes }
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
