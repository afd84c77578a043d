use core::fmt;

use glam::Vec3;

use super::{Hit, Primitives, Probe, Proximity, Span, Surface};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    geometry::{Aabb, PreparedRay, Ray, Triangle},
};

/// Numbers of primitives, in 16 bits where they fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order<'a> {
    /// Numbers up to 65,535.
    Narrow(&'a [u16]),
    /// Numbers up to 2^32 - 1.
    Wide(&'a [u32]),
}

impl<'a> Order<'a> {
    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Narrow(list) => list.len(),
            Self::Wide(list) => list.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number at a place.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, place: u32) -> Option<u32> {
        match self {
            Self::Narrow(list) => list.get(place as usize).map(|&number| u32::from(number)),
            Self::Wide(list) => list.get(place as usize).copied(),
        }
    }

    /// `count` numbers from the front of `words`, and the words behind them.
    fn split(words: &'a [u32], count: u32) -> Option<(Self, &'a [u32])> {
        let count = count as usize;
        if count > 1 << 16 {
            let (list, rest) = words.split_at_checked(count)?;
            return Some((Self::Wide(list), rest));
        }
        let (list, rest) = words.split_at_checked(count.div_ceil(2))?;
        let halves: &[u16] = bytemuck::try_cast_slice(list).ok()?;
        Some((Self::Narrow(halves.get(..count)?), rest))
    }
}

/// The two orders are not each other's inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OrderError {
    /// The first place at which that shows; the number of primitives if the lengths differ from it.
    pub place: u32,
}

impl fmt::Display for OrderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the order of primitives and its inverse differ at place {}", self.place)
    }
}

impl core::error::Error for OrderError {}

/// Both directions of a reordering.
#[derive(Clone, Copy, Debug)]
pub struct Renumbering<'a> {
    /// By place: the caller's number of the primitive that stands there.
    numbers: Order<'a>,
    /// By the caller's number: the place of that primitive.
    places: Order<'a>,
}

impl<'a> Renumbering<'a> {
    /// The reordering that puts the primitive `numbers[place]` to each place, and its inverse.
    ///
    /// # Errors
    ///
    /// [`OrderError`] if it is not the inverse.
    pub fn new(numbers: Order<'a>, places: Order<'a>) -> Result<Self, OrderError> {
        let count = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
        if numbers.len() != places.len() {
            return Err(OrderError { place: count });
        }
        let differs = |place: &u32| numbers.get(*place).and_then(|number| places.get(number)) != Some(*place);
        match (0..count).find(differs) {
            Some(place) => Err(OrderError { place }),
            None => Ok(Self { numbers, places }),
        }
    }
}

/// Primitives that stand in the order of a structure's leaves, with the numbers that their owner gave them.
///
/// A structure whose leaves are ranges needs no list of references. Ties are decided by the owner's numbers, so hits are
/// bit for bit those of the primitives in their old order. Without need for these numbers, use the reordered primitives
/// as they are: 4 to 8 bytes less for each.
///
/// ```
/// use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, primitives::{Order, Renumbering, Reordered}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
/// let near_first = Mesh::new(&vertices, &[[3_u16, 4, 5], [0, 1, 2]])?;
/// let renumbering = Renumbering::new(Order::Narrow(&[1, 0]), Order::Narrow(&[1, 0]))?;
/// let mesh = Reordered::new(near_first, renumbering)?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let hit = scene.closest_hit(&Ray::new(Vec3::new(0.2, 0.2, 5.0), Vec3::NEG_Z)).unwrap();
/// assert_eq!(hit.primitive, 1);
/// assert_eq!(scene.surface(&Ray::new(Vec3::new(0.2, 0.2, 5.0), Vec3::NEG_Z), &hit).point.z, 1.0);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Reordered<'a, P> {
    primitives: P,
    renumbering: Renumbering<'a>,
}

impl<'a, P: Primitives> Reordered<'a, P> {
    /// `primitives`, reordered already, with their old numbers.
    ///
    /// # Errors
    ///
    /// [`OrderError`] if these are more or fewer, or the primitives' hits are not numbered as they are.
    pub fn new(primitives: P, renumbering: Renumbering<'a>) -> Result<Self, OrderError> {
        let count = primitives.len();
        if renumbering.numbers.len() == count as usize && primitives.numbers() == count {
            Ok(Self { primitives, renumbering })
        } else {
            Err(OrderError { place: count })
        }
    }

    /// The number that the primitive at `place` has for its owner.
    #[inline(always)]
    pub(super) fn number(&self, place: u32) -> Option<u32> {
        self.renumbering.numbers.get(place)
    }

    /// The primitives in their new order.
    #[must_use]
    pub const fn inner(&self) -> &P {
        &self.primitives
    }
}

impl<P: Primitives> Primitives for Reordered<'_, P> {
    #[inline(always)]
    fn len(&self) -> u32 {
        self.primitives.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.primitives.bounds(index)
    }

    fn frame(&self) -> Option<Aabb> {
        self.primitives.frame()
    }

    #[inline]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let number = self.renumbering.numbers.get(index)?;
        let hit = self.primitives.intersect(index, ray, &span.renumbered(index, number))?;
        Some(Hit { primitive: number, ..hit })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.renumbering.places.get(hit.primitive) {
            Some(primitive) => self.primitives.surface(ray, &Hit { primitive, ..*hit }),
            None => Surface::facing(ray, hit.t),
        }
    }

    fn mask(&self, index: u32) -> u32 {
        self.primitives.mask(index)
    }

    #[inline(always)]
    fn is_certified(&self, index: u32) -> bool {
        self.primitives.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.primitives.clip(index, cell)
    }

    #[inline]
    fn outline(&self, index: u32) -> Option<Triangle> {
        self.primitives.outline(index)
    }
}

impl<P: Proximity> Proximity for Reordered<'_, P> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        self.primitives.closest_point(self.renumbering.places.get(number)?, point)
    }

    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        let number = self.renumbering.numbers.get(index)?;
        let hit = self.primitives.approach(index, &probe.renumbered(index, number))?;
        Some(Hit { primitive: number, ..hit })
    }
}

/// The section of numbers: how many, then the order and its inverse, each in whole words.
impl<'a> Stored<'a> for Renumbering<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Numbers)?;
        let error = AssetError::Shape { kind: Kind::Numbers, words: words.len() };
        let (&count, words) = words.split_first().ok_or(error)?;
        let (numbers, words) = Order::split(words, count).ok_or(error)?;
        let (places, rest) = Order::split(words, count).ok_or(error)?;
        if rest.is_empty() { Ok(Self::new(numbers, places)?) } else { Err(error.into()) }
    }
}

/// The sections of the reordered primitives and of their numbers.
impl<'a, P: Primitives + Stored<'a>> Stored<'a> for Reordered<'a, P> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        Ok(Self::new(asset.read()?, asset.read()?)?)
    }
}
