//! Acceleration structures: which primitives a ray may hit, in the order of its way.
//!
//! A structure is a small `Copy` view of words. It answers a ray with a [`Traversal`], a cursor that yields leaves; the
//! queries of [`Scene`](crate::Scene) are short shells over it, written once for all structures.

mod bounded;
pub mod bvh;
mod counted;
pub mod dualsplit;
mod entry;
pub mod grid;
mod hierarchy;
pub mod kdtree;
mod lattice_segment;
mod leaf;
mod list;
mod mailbox;
mod malformed;
pub mod octree;
mod on_lattice;
pub(crate) mod segment;
mod slope;
mod sort;
mod structure;
mod sweep;

pub use bounded::{Bounded, BoundedTraversal};
pub use bvh::Bvh;
pub use counted::{Counted, CountedTraversal};
pub use dualsplit::DualSplit;
pub use entry::{Entries, Entry};
pub use grid::Grid;
pub use hierarchy::{Cell, Hierarchy, Inside, MAX_LEVELS};
pub use kdtree::{CompactKdTree, KdTree};
pub use leaf::Leaf;
pub use list::List;
pub use mailbox::Mailbox;
pub use malformed::{Malformed, Reason};
pub use octree::Octree;
pub use on_lattice::{LatticeAccelerator, LatticeWalk};
pub use structure::{AnyLeaf, AnyNode, AnyTraversal, Plan, Structure};

use crate::geometry::{Aabb, Bundle, PreparedRay};

/// A structure over numbered boxes.
pub trait Accelerator {
    /// The cursor that walks it.
    type Traversal: Traversal;

    /// How many primitives it was built over.
    fn primitives(&self) -> u32;

    /// The box around all of them.
    fn bounds(&self) -> Aabb;

    /// A cursor at the beginning of `ray`, which all later calls must repeat.
    fn traverse(&self, ray: &PreparedRay) -> Self::Traversal;

    /// Where walks of the rays in `bundle` may begin: together, the entries hold all that one of them can meet.
    fn enter(&self, bundle: &Bundle) -> Entries {
        Entries::whole(self.bounds(), bundle)
    }

    /// Gives `visit` all leaves that a ray of `bundle` may enter, the nearest first; from then on only what is entered at or
    /// before the parameter that `visit` returns counts, which must not grow. False if this structure only walks ray by ray.
    fn sweep(&self, _bundle: &Bundle, _visit: impl FnMut(LeafOf<Self>) -> f32) -> bool
    where
        Self: Sized,
    {
        false
    }

    /// As [`traverse`](Self::traverse), of what is in one of the entries that this structure gave for the ray.
    fn traverse_from(&self, _entry: &Entry, ray: &PreparedRay) -> Self::Traversal {
        self.traverse(ray)
    }

    /// Gives all leaves that the ray may enter at or before `t_max` to `visit`, as a cursor would, some perhaps repeatedly; what
    /// `visit` returns is the new `t_max`, and nothing ends it.
    #[inline(always)]
    fn visit(
        &self,
        ray: &PreparedRay,
        t_max: f32,
        visit: impl FnMut(<Self::Traversal as Traversal>::Leaf) -> Option<f32>,
    ) {
        visit_by(self.traverse(ray), ray, t_max, visit);
    }
}

/// See [`Accelerator::visit`].
#[inline(always)]
fn visit_by<T: Traversal>(
    mut traversal: T,
    ray: &PreparedRay,
    mut t_max: f32,
    mut visit: impl FnMut(T::Leaf) -> Option<f32>,
) {
    while let Some(leaf) = traversal.next_leaf(ray, t_max) {
        match visit(leaf) {
            Some(t) => t_max = t,
            None => return,
        }
    }
}

/// The leaves of a structure.
pub type LeafOf<A> = <<A as Accelerator>::Traversal as Traversal>::Leaf;

/// A walk along a ray: a state machine that can stop at any leaf, or any node, and go on later.
pub trait Traversal {
    /// The numbers of the primitives in a leaf.
    type Leaf: Iterator<Item = u32>;

    /// The next leaf that the ray may enter at or before `t_max`, which must not grow from call to call.
    ///
    /// Each primitive that the ray meets at or before `t_max` is in one of the leaves; it may be in several.
    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<Self::Leaf>;

    /// As [`next_leaf`](Self::next_leaf), but visits at most `budget` nodes, which it counts down.
    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Self::Leaf>;
}

/// What a bounded walk came to.
#[derive(Clone, Copy, Debug)]
pub enum Step<L> {
    /// A leaf.
    Leaf(L),
    /// The end of the budget.
    Paused,
    /// The end of the ray.
    Done,
}

impl<L> Step<L> {
    /// The same, with another kind of leaf.
    #[inline(always)]
    pub fn map<M>(self, leaf: impl FnOnce(L) -> M) -> Step<M> {
        match self {
            Self::Leaf(of) => Step::Leaf(leaf(of)),
            Self::Paused => Step::Paused,
            Self::Done => Step::Done,
        }
    }
}
