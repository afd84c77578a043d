use glam::Vec3;

use super::{InstanceError, Instances};
use crate::{
    accel::{Accelerator, Hierarchy},
    geometry::{Aabb, PreparedRay, Ray},
    primitives::{Hit, Primitives, Probe, Proximity, Span, Surface},
    query::Inner,
};

/// Instances of which none is skewed: rotated, mirrored and enlarged by one factor, so that what is closest in a scene is
/// closest in the world.
///
/// Distances are measured in the scene, from the point mapped back, and multiplied by the factor. A scene whose coordinates
/// would exceed [`MAX_COORDINATE`](crate::geometry::MAX_COORDINATE) at the point is not near it.
///
/// ```
/// use hitscan::{Instance, Instances, List, Mesh, Scene, geometry::Transform, glam::{Mat3, Vec3}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scenes = [Scene::new(List::new(&mesh)?, &mesh)?];
/// let twice = Transform::new(Mat3::from_diagonal(Vec3::splat(2.0)), Vec3::new(0.0, 0.0, 5.0))?;
/// let mut placed = [Instance::new(0, Transform::IDENTITY), Instance::new(0, twice)];
///
/// let instances = Instances::place(&scenes, &mut placed)?.similar()?;
/// let world = Scene::new(List::new(&instances)?, &instances)?;
/// let nearest = world.nearest_point(Vec3::new(0.5, 1.0, 4.0), 9.0).unwrap();
/// assert_eq!((nearest.point, nearest.distance, nearest.primitive), (Vec3::new(0.5, 1.0, 5.0), 1.0, 1));
///
/// let skewed = Transform::new(Mat3::from_diagonal(Vec3::new(2.0, 1.0, 1.0)), Vec3::ZERO)?;
/// assert!(Instances::place(&scenes, &mut [Instance::new(0, skewed)])?.similar().is_err());
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Similar<'a, A, P>(Instances<'a, A, P>);

impl<A, P> Clone for Similar<'_, A, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, P> Copy for Similar<'_, A, P> {}

impl<'a, A, P> Similar<'a, A, P> {
    /// The instances.
    #[must_use]
    pub const fn instances(&self) -> &Instances<'a, A, P> {
        &self.0
    }
}

impl<'a, A: Accelerator, P: Primitives> Instances<'a, A, P> {
    /// The same instances, if distances can be measured through all of their transforms.
    ///
    /// # Errors
    ///
    /// [`InstanceError::Skewed`] names the first that changes angles, by more than 2^-16.
    pub fn similar(self) -> Result<Similar<'a, A, P>, InstanceError> {
        match self.placed.iter().position(|instance| instance.transform.factor().is_none()) {
            Some(instance) => Err(InstanceError::Skewed { instance: instance as u32 }),
            None => Ok(Similar(self)),
        }
    }
}

/// Those of the instances.
impl<A: Accelerator, P: Primitives> Primitives for Similar<'_, A, P> {
    fn len(&self) -> u32 {
        self.0.len()
    }

    fn numbers(&self) -> u32 {
        self.0.numbers()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.0.bounds(index)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.0.intersect(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.0.surface(ray, hit)
    }

    fn mask(&self, index: u32) -> u32 {
        self.0.mask(index)
    }
}

impl<A: Hierarchy, P: Proximity> Proximity for Similar<'_, A, P> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        let (index, primitive) = self.0.locate(number)?;
        let (instance, scene) = self.0.get(index)?;
        let closest = scene.primitives().closest_point(primitive, instance.transform.point_back(point))?;
        Some(instance.transform.point(closest))
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        let (instance, scene) = self.0.get(index)?;
        let (transform, first) = (&instance.transform, instance.first);
        let local = probe.placed(transform.point_back(probe.point()), transform.factor()?)?.numbered_from(first);
        let mut inner = Inner::new(*local.span());
        scene.grow(&local, &mut inner);
        inner.hit().map(|hit| Hit { primitive: hit.primitive.saturating_add(first), ..hit })
    }
}
