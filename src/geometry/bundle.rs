use super::{Aabb, Axis, Ray, ray::WIDENING, slack};
use crate::math::{greatest, least};

/// Rays that are looked at together: those of a tile.
///
/// Kept as slabs, one per axis: the interval of their origins and that of their reciprocal directions. What is computed of
/// them bounds, bit for bit, what a walk computes of each, because roundings keep order.
///
/// ```
/// use hitscan::{Ray, geometry::{Aabb, Bundle}, glam::Vec3};
/// let ray = |x: f32| Ray::new(Vec3::ZERO, Vec3::new(x, 0.1, 1.0));
/// let bundle = Bundle::around([ray(0.1), ray(0.2)]).unwrap();
/// let cube = Aabb::new(Vec3::splat(0.5), Vec3::ONE);
/// assert_eq!(bundle.entry(&cube), None);
/// assert_eq!(bundle.entry(&Aabb::new(Vec3::new(0.1, 0.0, 1.0), Vec3::ONE)), Some(1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bundle {
    slabs: [Slab; 3],
    enter: f32,
}

/// The rays as one axis sees them, by the way they go along it.
#[derive(Clone, Copy, Debug)]
enum Slab {
    Ascending(Way),
    Descending(Way),
    Both([Way; 2]),
}

/// Rays that go the same way along an axis, seen so that they ascend.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// The least and the greatest origin.
    origins: [f32; 2],
    /// At most the least reciprocal, for entries and for exits.
    slow: [f32; 2],
    /// The greatest reciprocal, for exits; infinite if some rays hardly move.
    fast: f32,
}

/// When rays pass a plane; NaN is no bound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage {
    /// Whether they come from higher coordinates; those that do not come from that side stay where they are.
    pub(crate) descends: bool,
    /// None is on the far side before this.
    pub(crate) earliest: f32,
    /// None that passes is on the near side after this.
    pub(crate) latest: f32,
}

impl Way {
    /// Origins and directions from the least to the greatest; none if no ray ascends.
    fn new(origins: [f32; 2], [least, greatest]: [f32; 2]) -> Option<Self> {
        if greatest.is_sign_negative() {
            return None;
        }
        let slow = 1.0 / self::greatest(greatest, f32::MIN_POSITIVE);
        let fast = if least < f32::MIN_POSITIVE { f32::INFINITY } else { 1.0 / least * (1.0 + WIDENING) };
        Some(Self { origins, slow: [slow, slow * (1.0 + WIDENING)], fast })
    }

    /// When the rays are between two planes: no entry that counts is earlier, no exit later. NaN is no bound.
    #[inline(always)]
    fn between(&self, near: f32, far: f32) -> (f32, f32) {
        let [first, last] = self.origins;
        // Where the plane is behind an origin, the parameter is negative and bounds nothing.
        let enter = (near - last) * self.slow[0];
        let left = far - first;
        (enter, left * if left < 0.0 { self.slow[1] } else { self.fast } + slack(0.0))
    }
}

impl Bundle {
    /// All rays whose origins and directions lie between those of `rays`, coordinate by coordinate.
    ///
    /// None if a number is not finite, or if a ray begins below zero: such rays are looked at one by one.
    pub fn around(rays: impl IntoIterator<Item = Ray>) -> Option<Self> {
        let (mut origins, mut directions, mut enter) = (Aabb::EMPTY, Aabb::EMPTY, f32::INFINITY);
        for ray in rays {
            if !(ray.origin.is_finite() && ray.direction.is_finite() && ray.t_min >= 0.0) {
                return None;
            }
            origins = origins.union(&Aabb::new(ray.origin, ray.origin));
            directions = directions.union(&Aabb::new(ray.direction, ray.direction));
            enter = least(ray.t_min, enter);
        }
        if !enter.is_finite() {
            return None;
        }
        let slab = |axis: Axis| {
            let of = |bounds: &Aabb| [axis.of(bounds.min), axis.of(bounds.max)];
            let ([first, last], [low, high]) = (of(&origins), of(&directions));
            let ascending = Way::new([first, last], [low, high]);
            match (ascending, Way::new([-last, -first], [-high, -low])) {
                (Some(way), None) => Some(Slab::Ascending(way)),
                (None, Some(way)) => Some(Slab::Descending(way)),
                (Some(up), Some(down)) => Some(Slab::Both([up, down])),
                (None, None) => None,
            }
        };
        Some(Self { slabs: [slab(Axis::X)?, slab(Axis::Y)?, slab(Axis::Z)?], enter })
    }

    /// All rays that are as these but begin up to `by` away along each axis.
    pub(crate) fn padded(&self, by: f32) -> Self {
        let pad = |way: &Way| {
            let [first, last] = way.origins;
            Way { origins: [first - by, last + by], ..*way }
        };
        let slabs = self.slabs.each_ref().map(|slab| match slab {
            Slab::Ascending(way) => Slab::Ascending(pad(way)),
            Slab::Descending(way) => Slab::Descending(pad(way)),
            Slab::Both(ways) => Slab::Both(ways.each_ref().map(pad)),
        });
        Self { slabs, ..*self }
    }

    /// A parameter before which none of the rays enters the box; `None` if none of them meets it.
    #[must_use]
    pub fn entry(&self, bounds: &Aabb) -> Option<f32> {
        self.interval(bounds).map(|(enter, _)| enter)
    }

    /// When the rays, all of them from `enter` on, pass the plane at `p` of an axis.
    #[inline(always)]
    pub(crate) fn passage(&self, axis: Axis, p: f32, enter: f32) -> Passage {
        let (descends, (earliest, latest)) = match &self.slabs[axis as usize] {
            Slab::Ascending(way) => (false, way.between(p, p)),
            Slab::Descending(way) => (true, way.between(-p, -p)),
            Slab::Both([up, down]) => {
                let (ascending, descending) = (up.between(p, p), down.between(-p, -p));
                if descending.1 < enter {
                    // Those that descend began below the plane, and stay there.
                    (false, (ascending.0, f32::INFINITY))
                } else if ascending.1 < enter {
                    (true, (descending.0, f32::INFINITY))
                } else {
                    (false, (f32::NEG_INFINITY, f32::INFINITY))
                }
            }
        };
        Passage { descends, earliest, latest }
    }

    /// A parameter before which none of the rays enters the box, and one after which none is in it.
    pub(crate) fn interval(&self, bounds: &Aabb) -> Option<(f32, f32)> {
        let (mut enter, mut exit) = (self.enter, f32::INFINITY);
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        for ((slab, min), max) in self.slabs.iter().zip(min).zip(max) {
            let (e, x) = match slab {
                Slab::Ascending(way) => way.between(min, max),
                Slab::Descending(way) => way.between(-max, -min),
                Slab::Both([up, down]) => {
                    let meets = |(e, x): (f32, f32)| !(greatest(e, enter) > least(x, exit));
                    let (up, down) = (up.between(min, max), down.between(-max, -min));
                    match (meets(up), meets(down)) {
                        (true, true) => continue,
                        (true, false) => up,
                        (false, true) => down,
                        (false, false) => return None,
                    }
                }
            };
            enter = greatest(e, enter);
            exit = least(x, exit);
            if enter > exit {
                return None;
            }
        }
        Some((enter, exit))
    }
}
