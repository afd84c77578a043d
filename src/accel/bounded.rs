use super::{Accelerator, Cell, Entries, Entry, Hierarchy, Inside, LeafOf, Step, Traversal};
use crate::geometry::{Aabb, Bundle, PreparedRay, Volume};

/// A structure behind a volume: rays that miss the volume are not walked at all.
///
/// Over a [`List`](super::List) any volume pays. Other structures begin with the box along the axes themselves: there a
/// sphere saves up to a third where most rays miss the object, and a turned box hardly anything unless it is much the
/// smaller one. Two in a row, the cheaper one first, are a volume as well: `(sphere, obb)`.
///
/// The volume must contain all certified primitives, and the whole bounds of all others; then the answers are, bit for
/// bit, those of the structure itself ([`Volume::may_meet`]).
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, accel::Bounded, geometry::Obb, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let volume = Obb::dito(vertices.iter().copied()).unwrap();
/// let scene = Scene::new(Bounded::new(volume, List::new(&mesh)?), &mesh)?;
/// assert!(scene.any_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bounded<V, A> {
    volume: V,
    accelerator: A,
}

impl<V: Volume, A: Accelerator> Bounded<V, A> {
    /// `accelerator` behind `volume`.
    pub const fn new(volume: V, accelerator: A) -> Self {
        Self { volume, accelerator }
    }

    /// The volume.
    #[must_use]
    pub const fn volume(&self) -> &V {
        &self.volume
    }

    /// The structure.
    #[must_use]
    pub const fn accelerator(&self) -> &A {
        &self.accelerator
    }
}

impl<V: Volume, A: Accelerator> Accelerator for Bounded<V, A> {
    type Traversal = BoundedTraversal<A::Traversal>;

    fn primitives(&self) -> u32 {
        self.accelerator.primitives()
    }

    fn bounds(&self) -> Aabb {
        self.accelerator.bounds()
    }

    #[inline]
    fn traverse(&self, ray: &PreparedRay) -> Self::Traversal {
        let meets = self.volume.may_meet(ray, ray.ray().t_max);
        BoundedTraversal { inner: if meets { Some(self.accelerator.traverse(ray)) } else { None } }
    }

    fn enter(&self, bundle: &Bundle) -> Entries {
        self.accelerator.enter(bundle)
    }

    fn sweep(&self, bundle: &Bundle, visit: impl FnMut(LeafOf<Self>) -> f32) -> bool {
        self.accelerator.sweep(bundle, visit)
    }

    /// Without a look at the volume: the entry's box is the smaller one.
    #[inline]
    fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> Self::Traversal {
        BoundedTraversal { inner: Some(self.accelerator.traverse_from(entry, ray)) }
    }
}

/// The cells of the structure: searches that follow no ray have no use for the volume.
impl<V: Volume, A: Hierarchy> Hierarchy for Bounded<V, A> {
    type Node = A::Node;
    type Leaf = A::Leaf;

    fn root(&self) -> Option<Cell<A::Node>> {
        self.accelerator.root()
    }

    fn open(&self, cell: &Cell<A::Node>) -> Inside<A::Node, A::Leaf> {
        self.accelerator.open(cell)
    }
}

/// The walk behind the volume of a [`Bounded`] structure, or none.
#[derive(Clone, Copy, Debug)]
pub struct BoundedTraversal<T> {
    inner: Option<T>,
}

impl<T: Traversal> Traversal for BoundedTraversal<T> {
    type Leaf = T::Leaf;

    #[inline]
    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<T::Leaf> {
        self.inner.as_mut()?.next_leaf(ray, t_max)
    }

    /// The test of the volume was made at the beginning and costs nothing here.
    #[inline]
    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<T::Leaf> {
        match &mut self.inner {
            Some(inner) => inner.step(ray, t_max, budget),
            None => Step::Done,
        }
    }
}
