use super::{Accelerator, Leaf, Step, Traversal};
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
        ListTraversal { len: self.len }
    }
}

/// The walk over a [`List`]: one leaf.
#[derive(Clone, Copy, Debug)]
pub struct ListTraversal {
    len: u32,
}

impl Traversal for ListTraversal {
    type Leaf = Leaf<'static>;

    #[inline]
    fn next_leaf(&mut self, _ray: &PreparedRay, _t_max: f32) -> Option<Leaf<'static>> {
        let len = core::mem::take(&mut self.len);
        (len > 0).then(|| Leaf::consecutive(0, len))
    }

    /// Each primitive counts as a node.
    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'static>> {
        match self.next_leaf(ray, t_max) {
            None => Step::Done,
            Some(leaf) => {
                *budget = budget.saturating_sub(1);
                Step::Leaf(leaf)
            }
        }
    }
}
