use core::ops::Range;

use super::{Accelerator, Cell, Hierarchy, Inside, Step, Traversal};
use crate::{
    error::BuildError,
    geometry::{Aabb, PreparedRay},
    primitives::{Primitives, bounds_of},
};

/// No structure: every ray tests every primitive. The baseline, and the oracle of all others.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// assert!(scene.any_hit(&Ray::between(Vec3::new(0.2, 0.2, -1.0), Vec3::new(0.2, 0.2, 1.0))));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct List {
    len: u32,
    bounds: Aabb,
}

impl List {
    /// The list of all `primitives`.
    ///
    /// # Errors
    ///
    /// [`BuildError::Bounds`] names the first primitive whose bounds are not valid.
    pub fn new<P: Primitives + ?Sized>(primitives: &P) -> Result<Self, BuildError> {
        let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
        Ok(Self { len: primitives.len(), bounds })
    }
}

impl Accelerator for List {
    type Traversal = ListTraversal;

    fn primitives(&self) -> u32 {
        self.len
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn traverse(&self, _ray: &PreparedRay) -> ListTraversal {
        ListTraversal { next: 0, len: self.len }
    }
}

/// One leaf.
impl Hierarchy for List {
    type Node = ();
    type Leaf = Range<u32>;

    fn root(&self) -> Option<Cell<()>> {
        (self.len > 0).then_some(Cell { bounds: self.bounds, node: () })
    }

    fn open(&self, _cell: &Cell<()>) -> Inside<(), Range<u32>> {
        Inside::Leaf(0..self.len)
    }
}

/// The walk over a [`List`]: one leaf, or as many as there are pauses.
#[derive(Clone, Copy, Debug)]
pub struct ListTraversal {
    next: u32,
    len: u32,
}

impl Traversal for ListTraversal {
    type Leaf = Range<u32>;

    #[inline]
    fn next_leaf(&mut self, _ray: &PreparedRay, _t_max: f32) -> Option<Range<u32>> {
        let first = core::mem::replace(&mut self.next, self.len);
        (first < self.len).then_some(first..self.len)
    }

    /// Each primitive counts as a node.
    fn step(&mut self, _ray: &PreparedRay, _t_max: f32, budget: &mut u32) -> Step<Range<u32>> {
        let (first, count) = (self.next, (self.len - self.next).min(*budget));
        if first == self.len {
            return Step::Done;
        }
        if count == 0 {
            return Step::Paused;
        }
        self.next += count;
        *budget -= count;
        Step::Leaf(first..first + count)
    }
}
