use core::fmt;

use super::{Closest, Collector};
use crate::{
    accel::{Accelerator, Step, Traversal},
    geometry::{PreparedRay, Ray},
    primitives::{Hit, Primitives},
    scene::Scene,
};

/// How far a query in parts has come.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Progress {
    /// The budget is spent; go on with more.
    Paused,
    /// The closest hit, if there is one.
    Done(Option<Hit>),
}

/// A closest-hit query that visits a few nodes at a time: see [`Scene::begin`].
///
/// ```
/// # use hitscan::{Arena, KdTree, Mesh, Ray, Scene, glam::Vec3, kdtree::Options};
/// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// # let mut memory = [0; 2000];
/// # let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::small())?;
/// # let scene = Scene::new(tree, &mesh)?;
/// use hitscan::query::Progress;
/// let mut query = scene.begin(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z));
/// let hit = loop {
///     match query.advance(16) {
///         Progress::Paused => { /* serve the watchdog */ }
///         Progress::Done(hit) => break hit,
///     }
/// };
/// assert_eq!(hit.unwrap().t, 1.0);
/// # Ok::<(), hitscan::Error>(())
/// ```
pub struct PausedQuery<'s, A: Accelerator, P> {
    scene: &'s Scene<A, P>,
    walk: Option<(PreparedRay, A::Traversal, Closest)>,
}

impl<'s, A: Accelerator, P: Primitives> PausedQuery<'s, A, P> {
    pub(crate) fn new(scene: &'s Scene<A, P>, ray: &Ray) -> Self {
        let walk = ray.prepare().map(|ray| (ray, scene.accelerator().traverse(&ray), Closest::new(&ray)));
        Self { scene, walk }
    }

    /// Visits at most `nodes` nodes, and tests all primitives of the leaves among them.
    pub fn advance(&mut self, nodes: u32) -> Progress {
        let Some((ray, traversal, closest)) = &mut self.walk else { return Progress::Done(None) };
        let mut budget = nodes;
        loop {
            match traversal.step(ray, closest.until().t, &mut budget) {
                Step::Leaf(leaf) => {
                    self.scene.offer(leaf, ray, closest);
                }
                Step::Paused => return Progress::Paused,
                Step::Done => return Progress::Done(closest.hit()),
            }
        }
    }
}

impl<A: Accelerator, P> fmt::Debug for PausedQuery<'_, A, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PausedQuery").field("ray", &self.walk.as_ref().map(|walk| walk.0)).finish_non_exhaustive()
    }
}
