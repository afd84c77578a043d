//! Instancing: one scene placed many times.
//!
//! Placed scenes are [`Primitives`] themselves, so that any structure over them is the top level of two: no traversal knows
//! of levels. Deeper ones are a matter of types: scenes of [`Instances`] can be placed again.

mod similar;

pub use similar::Similar;

use core::fmt;

use crate::{
    accel::Accelerator,
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Transform},
    primitives::{Hit, Primitives, Span, Surface, unit},
    query::Inner,
    scene::Scene,
};

/// A scene's number and where it is placed.
///
/// ```
/// use hitscan::{Instance, geometry::Transform, glam::{Mat3, Vec3}};
/// let twice_as_large = Transform::new(Mat3::from_diagonal(Vec3::splat(2.0)), Vec3::X)?;
/// let instance = Instance::new(0, twice_as_large).with_mask(0b10);
/// assert_eq!(instance.scene(), 0);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Instance {
    transform: Transform,
    scene: u32,
    mask: u32,
    /// The number of its first primitive among those of all instances.
    first: u32,
}

impl Instance {
    /// The scene of this number where `transform` puts it, seen by all rays.
    #[must_use]
    pub const fn new(scene: u32, transform: Transform) -> Self {
        Self { transform, scene, mask: u32::MAX, first: 0 }
    }

    /// The same, seen only by rays that share a bit with `mask`.
    #[must_use]
    pub const fn with_mask(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// The scene's number.
    #[must_use]
    pub const fn scene(&self) -> u32 {
        self.scene
    }

    /// From the scene's coordinates to those of the world.
    #[must_use]
    pub const fn transform(&self) -> &Transform {
        &self.transform
    }

    /// The number of its first primitive among those of all instances.
    #[must_use]
    pub const fn first(&self) -> u32 {
        self.first
    }
}

/// Why instances were refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum InstanceError {
    /// It places a scene that does not exist.
    Scene {
        /// The instance.
        instance: u32,
        /// The scene it names.
        scene: u32,
        /// How many scenes there are.
        scenes: usize,
    },
    /// It is placed where coordinates are not finite or beyond 2^126.
    Place {
        /// The instance.
        instance: u32,
    },
    /// Its first primitive does not follow the last of the instance before.
    Number {
        /// The instance.
        instance: u32,
    },
    /// It changes angles, so that no distance can be measured through it.
    Skewed {
        /// The instance.
        instance: u32,
    },
    /// More than 2^32 - 2 instances or primitives in all.
    TooMany,
}

impl fmt::Display for InstanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene { instance, scene, scenes } => {
                write!(f, "instance {instance} places scene {scene}, but there are {scenes}")
            }
            Self::Place { instance } => {
                write!(f, "instance {instance} lies where coordinates are not finite or beyond 2^126")
            }
            Self::Number { instance } => {
                write!(f, "instance {instance} does not continue the numbers of the one before")
            }
            Self::Skewed { instance } => write!(f, "instance {instance} changes angles, and with them distances"),
            Self::TooMany => write!(f, "at most 2^32 - 2 primitives can be numbered"),
        }
    }
}

impl core::error::Error for InstanceError {}

/// Scenes, placed.
///
/// Hits are numbered through: the primitives of the first instance, then those of the second. `t` is the same in the world
/// and in a scene, whose rays are mapped back (`R⁻¹(o - T)`, rule R6 of ARCHITECTURE.md). Whatever can be inverted is
/// allowed, mirrors and different scales along the axes too; masks are those of the instance and of the primitive.
///
/// ```
/// use hitscan::{Instance, Instances, List, Mesh, Ray, Scene, geometry::Transform, glam::{Mat3, Vec3}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scenes = [Scene::new(List::new(&mesh)?, &mesh)?];
/// let at = |z: f32| Transform::new(Mat3::IDENTITY, Vec3::new(0.0, 0.0, z));
/// let mut placed = [Instance::new(0, at(5.0)?), Instance::new(0, at(3.0)?)];
///
/// let instances = Instances::place(&scenes, &mut placed)?;
/// let world = Scene::new(List::new(&instances)?, &instances)?;
/// let hit = world.closest_hit(&Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.primitive), (3.0, 1));
/// assert_eq!(instances.locate(hit.primitive), Some((1, 0)));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Instances<'a, A, P> {
    scenes: &'a [Scene<A, P>],
    placed: &'a [Instance],
    numbers: u32,
}

// Written out, because a reference can be copied whatever it refers to.
impl<A, P> Clone for Instances<'_, A, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, P> Copy for Instances<'_, A, P> {}

impl<'a, A: Accelerator, P: Primitives> Instances<'a, A, P> {
    /// Numbers `placed` through, in their order.
    ///
    /// # Errors
    ///
    /// [`InstanceError`] names the first instance that places nothing, or where nothing can be.
    pub fn place(scenes: &'a [Scene<A, P>], placed: &'a mut [Instance]) -> Result<Self, InstanceError> {
        let mut first = 0_u32;
        for (index, instance) in placed.iter_mut().enumerate() {
            instance.first = first;
            let more = scenes.get(instance.scene as usize).map_or(0, |scene| scene.primitives().numbers());
            first = first.checked_add(more).filter(|_| index < u32::MAX as usize).ok_or(InstanceError::TooMany)?;
        }
        Self::new(scenes, placed)
    }

    /// Instances that [`place`](Self::place) has numbered over the same scenes: those of an asset.
    ///
    /// # Errors
    ///
    /// As for [`place`](Self::place), and [`InstanceError::Number`] if they were numbered otherwise.
    pub fn new(scenes: &'a [Scene<A, P>], placed: &'a [Instance]) -> Result<Self, InstanceError> {
        let mut numbers = 0_u32;
        for (index, instance) in placed.iter().enumerate() {
            let index = u32::try_from(index).ok().filter(|&n| n < u32::MAX).ok_or(InstanceError::TooMany)?;
            let scene = scenes.get(instance.scene as usize).ok_or(InstanceError::Scene {
                instance: index,
                scene: instance.scene,
                scenes: scenes.len(),
            })?;
            if instance.first != numbers {
                return Err(InstanceError::Number { instance: index });
            }
            if !(instance.transform.is_finite() && bounds(instance, scene).is_valid()) {
                return Err(InstanceError::Place { instance: index });
            }
            let more = scene.primitives().numbers();
            numbers = numbers.checked_add(more).filter(|&n| n < u32::MAX).ok_or(InstanceError::TooMany)?;
        }
        Ok(Self { scenes, placed, numbers })
    }

    /// The scenes.
    #[must_use]
    pub const fn scenes(&self) -> &'a [Scene<A, P>] {
        self.scenes
    }

    /// The instances, numbered.
    #[must_use]
    pub const fn placed(&self) -> &'a [Instance] {
        self.placed
    }

    /// The instance to which a hit's number belongs, and the primitive's number in its scene.
    #[must_use]
    pub fn locate(&self, number: u32) -> Option<(u32, u32)> {
        if number >= self.numbers {
            return None;
        }
        // Those of empty scenes begin where the next one does.
        let index = self.placed.partition_point(|instance| instance.first <= number).checked_sub(1)?;
        Some((index as u32, number - self.placed.get(index)?.first))
    }

    fn get(&self, index: u32) -> Option<(&'a Instance, &'a Scene<A, P>)> {
        let instance = self.placed.get(index as usize)?;
        Some((instance, self.scenes.get(instance.scene as usize)?))
    }
}

/// The box around a placed scene; where the translation puts it if there is nothing in it.
fn bounds<A: Accelerator, P: Primitives>(instance: &Instance, scene: &Scene<A, P>) -> Aabb {
    if scene.primitives().is_empty() {
        let place = instance.transform.translation();
        return Aabb::new(place, place);
    }
    instance.transform.padded_bounds(&scene.bounds())
}

/// Not certified: each is referenced by its whole bounds, and what is hit in it is clamped to these.
impl<A: Accelerator, P: Primitives> Primitives for Instances<'_, A, P> {
    fn len(&self) -> u32 {
        self.placed.len() as u32
    }

    fn numbers(&self) -> u32 {
        self.numbers
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.get(index).map_or(Aabb::EMPTY, |(instance, scene)| bounds(instance, scene))
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let (instance, scene) = self.get(index)?;
        // Prepared for the whole line: what is hit may not depend on which part of it is still of interest.
        let line = instance.transform.ray_back(ray.ray()).starting_at(f32::NEG_INFINITY).up_to(f32::INFINITY);
        let mut prepared = line.prepare();
        let local = prepared.as_mut()?;
        // What lies before the bounds is clamped to where they begin, so it is looked for, too: from where the scene begins
        // and not from the end of the line, which would put off all exits without end.
        let t_min = if span.t_min() > f32::MIN { span.t_min() } else { scene.bounds().beginning(local)? };
        if t_min > span.t_max() {
            return None;
        }
        local.set_interval(t_min, span.t_max());
        let mut inner = Inner::new(span.numbered_from(instance.first));
        scene.search(local, &mut inner);
        inner.hit().map(|hit| Hit { primitive: hit.primitive.saturating_add(instance.first), ..hit })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let found = self.locate(hit.primitive).and_then(|(index, primitive)| Some((self.get(index)?, primitive)));
        let Some(((instance, scene), primitive)) = found else { return Surface::facing(ray, hit.t) };
        let transform = &instance.transform;
        let surface = scene.surface(&transform.ray_back(ray), &Hit { primitive, ..*hit });
        let point = transform.point(surface.point);
        let own = transform.error(surface.point.abs()).max_element();
        Surface {
            point,
            geometric_normal: unit(transform.normal(surface.geometric_normal)),
            shading_normal: unit(transform.normal(surface.shading_normal)),
            error: surface.error * transform.stretch() + own,
            ..surface
        }
    }

    fn mask(&self, index: u32) -> u32 {
        self.placed.get(index as usize).map_or(0, |instance| instance.mask)
    }
}

/// The section of instances.
impl<'a> Stored<'a> for &'a [Instance] {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Instances)?;
        let error = AssetError::Shape { kind: Kind::Instances, words: words.len() };
        Ok(bytemuck::try_cast_slice(words).map_err(|_| error)?)
    }
}
