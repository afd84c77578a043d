//! Range sensors: a pattern of beams in, a range per beam out.
//!
//! Time-of-flight imagers, lidars and sonars are lists of directions that are cast again and again from wherever the sensor
//! is. The directions are computed once, by [`zones`], [`depth_zones`], [`rings`] or from a data sheet; a ray then costs no
//! square root, and a range comes out in the unit in which the sensor reports it.

mod pattern;
mod pose;

use glam::Vec3;

pub use pattern::{depth_zones, rings, zones};
pub use pose::Pose;

use crate::{
    geometry::Ray,
    primitives::{Hit, unit},
    render::Caster,
};

/// A sensor that measures how far things are along fixed beams.
///
/// Beams stand in the sensor's own coordinates: x to the right, y down, z ahead. A range counts lengths of its beam: of unit
/// vectors it is the distance, of vectors with `z = 1` the depth, which is what imagers with a lens report.
///
/// ```
/// use core::f32::consts::FRAC_PI_4;
/// use hitscan::{List, Mesh, Scene, glam::Vec3, sensor::{Pose, RangeSensor, depth_zones}};
///
/// // A wall 2 m ahead, and the VL53L5CX: 8 x 8 zones in 45 degrees, millimetres up to 4 m.
/// let vertices = [Vec3::new(-9.0, -9.0, 2.0), Vec3::new(9.0, -9.0, 2.0), Vec3::new(0.0, 9.0, 2.0)];
/// let wall = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&wall)?, &wall)?;
/// let beams = depth_zones::<8, 8>([FRAC_PI_4; 2]);
/// let sensor = RangeSensor::new(beams.as_flattened()).in_units_of(0.001).within(20.0, 4000.0);
///
/// let pose = Pose::looking(Vec3::ZERO, Vec3::Z, Vec3::Y);
/// let millimetres = sensor.ranges(&scene, &pose).map(|hit| hit.map(|hit| hit.t.round()));
/// assert!(millimetres.eq([Some(2000.0); 64]));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeSensor<'a> {
    beams: &'a [Vec3],
    unit: f32,
    nearest: f32,
    farthest: f32,
    mask: u32,
}

/// What a beam met.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Echo {
    /// How far away, in the sensor's units.
    pub range: f32,
    /// The primitive's number.
    pub primitive: u32,
    /// The cosine of the angle between the beam and the surface's normal: 1 head-on, 0 grazing. What comes back of the
    /// light grows with it.
    pub cosine: f32,
}

impl<'a> RangeSensor<'a> {
    /// A sensor with these beams, which sees everything at any range, in the scene's units.
    #[must_use]
    pub const fn new(beams: &'a [Vec3]) -> Self {
        Self { beams, unit: 1.0, nearest: 0.0, farthest: f32::INFINITY, mask: u32::MAX }
    }

    /// The same sensor, reporting in units of this `length` in the scene: 0.001 for millimetres where that is in metres.
    #[must_use]
    pub const fn in_units_of(self, length: f32) -> Self {
        Self { unit: length, ..self }
    }

    /// The same sensor for ranges from `nearest` to `farthest` only, themselves included, in its units.
    ///
    /// What is too near to be measured still hides what lies behind it.
    #[must_use]
    pub const fn within(self, nearest: f32, farthest: f32) -> Self {
        Self { nearest, farthest, ..self }
    }

    /// The same sensor, seeing only primitives whose mask shares a bit with `mask`: not its own housing, for example.
    #[must_use]
    pub const fn seeing(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// The beams.
    #[must_use]
    pub const fn beams(&self) -> &'a [Vec3] {
        self.beams
    }

    /// The ray of each beam of the sensor at `pose`; its `t` is the range.
    pub fn rays(&self, pose: &Pose) -> impl ExactSizeIterator<Item = Ray> + use<'a> {
        let (origin, turn) = (pose.position, pose.rotation * self.unit);
        let Self { farthest, mask, .. } = *self;
        self.beams.iter().map(move |&beam| Ray::new(origin, turn * beam).up_to(farthest).seeing(mask))
    }

    /// What each beam of the sensor at `pose` meets, in the order of the beams: the range is the hit's `t`.
    pub fn ranges<'s, S: Caster + ?Sized>(
        &self,
        scene: &'s S,
        pose: &Pose,
    ) -> impl ExactSizeIterator<Item = Option<Hit>> + use<'a, 's, S> {
        let nearest = self.nearest;
        self.rays(pose).map(move |ray| measured(scene, &ray, nearest))
    }

    /// As [`ranges`](Self::ranges), with the angle at which the surface was met.
    pub fn echoes<'s, S: Caster + ?Sized>(
        &self,
        scene: &'s S,
        pose: &Pose,
    ) -> impl ExactSizeIterator<Item = Option<Echo>> + use<'a, 's, S> {
        let nearest = self.nearest;
        self.rays(pose).map(move |ray| {
            let hit = measured(scene, &ray, nearest)?;
            let cosine = scene.surface(&ray, &hit).geometric_normal.dot(unit(ray.direction)).abs();
            Some(Echo { range: hit.t, primitive: hit.primitive, cosine })
        })
    }

    /// The ranges of a full turn to the right in equal `steps`, all beams of a step before those of the next: a spinning
    /// lidar, whose beams are [`rings`].
    ///
    /// For a lidar that moves while it spins, cast each step from its own pose, [`Pose::turned`].
    ///
    /// ```
    /// use hitscan::{List, Scene, glam::{Mat3, Vec3}, primitives::Spheres, geometry::Sphere};
    /// use hitscan::sensor::{Pose, RangeSensor, rings};
    /// let balls = [Sphere::new(Vec3::X * 5.0, 1.0)];
    /// let balls = Spheres::new(&balls)?;
    /// let scene = Scene::new(List::new(&balls)?, &balls)?;
    ///
    /// let beams = rings([-0.1, 0.0, 0.1]);
    /// let lidar = RangeSensor::new(&beams).within(0.5, 100.0);
    /// let level = Pose::new(Vec3::ZERO, Mat3::IDENTITY);
    /// let seen = lidar.sweep(&scene, &level, 360).flatten();
    /// assert!((4.0..4.01).contains(&seen.map(|hit| hit.t).fold(f32::INFINITY, f32::min)));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    pub fn sweep<'s, S: Caster + ?Sized>(
        &self,
        scene: &'s S,
        pose: &Pose,
        steps: u32,
    ) -> impl Iterator<Item = Option<Hit>> + use<'a, 's, S> {
        let (sensor, pose) = (*self, *pose);
        let step = core::f32::consts::TAU / steps as f32;
        (0..steps).flat_map(move |index| sensor.ranges(scene, &pose.turned(index as f32 * step)))
    }
}

/// The first hit, unless that is too near to be measured.
fn measured<S: Caster + ?Sized>(scene: &S, ray: &Ray, nearest: f32) -> Option<Hit> {
    scene.closest_hit(ray, 0).filter(|hit| hit.t >= nearest)
}
