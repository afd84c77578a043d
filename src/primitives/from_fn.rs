use core::fmt;

use super::{Hit, Primitives, Span};
use crate::geometry::{Aabb, PreparedRay, Ray};

/// Primitives from two closures: see [`from_fn`].
#[derive(Clone, Copy)]
pub struct FromFn<B, I> {
    len: u32,
    bounds: B,
    intersect: I,
}

/// `len` shapes, given by the box around one and by where a ray first meets one, if it does.
///
/// ```
/// use hitscan::{List, Ray, Scene, from_fn, geometry::{Aabb, Sphere}, glam::Vec3};
/// let ball = |i: u32| Sphere::new(Vec3::X * i as f32 * 3.0, 1.0);
/// let balls = from_fn(
///     3,
///     |i| ball(i).bounds(),
///     |i, ray| ball(i).intersect(&ray.prepare()?).map(|[enter, _]| enter),
/// );
/// let scene = Scene::new(List::new(&balls)?, &balls)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::new(3.0, 0.0, -5.0), Vec3::Z)).unwrap();
/// assert_eq!((hit.t, hit.primitive), (4.0, 1));
/// # Ok::<(), hitscan::Error>(())
/// ```
pub const fn from_fn<B, I>(len: u32, bounds: B, intersect: I) -> FromFn<B, I>
where
    B: Fn(u32) -> Aabb,
    I: Fn(u32, &Ray) -> Option<f32>,
{
    FromFn { len, bounds, intersect }
}

impl<B, I> Primitives for FromFn<B, I>
where
    B: Fn(u32) -> Aabb,
    I: Fn(u32, &Ray) -> Option<f32>,
{
    fn len(&self) -> u32 {
        self.len
    }

    fn bounds(&self, index: u32) -> Aabb {
        (self.bounds)(index)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        span.accept((self.intersect)(index, ray.ray())?, index)
    }
}

impl<B, I> fmt::Debug for FromFn<B, I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FromFn").field("len", &self.len).finish_non_exhaustive()
    }
}
