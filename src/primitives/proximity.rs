use glam::Vec3;

use super::{Hit, Primitives, Span};
use crate::{
    geometry::{Aabb, in_range},
    math,
};

/// The closest point of a scene: see [`Scene::nearest_point`](crate::Scene::nearest_point).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The point of the primitive.
    pub point: Vec3,
    /// Its distance, computed with more digits than `point` has.
    pub distance: f32,
    /// The primitive's number.
    pub primitive: u32,
}

/// Primitives that know how far away they are.
///
/// One method is required: the closest point of a shape. A shape is what a ray can hit: of a ball, its surface.
///
/// ```
/// use hitscan::{Arena, KdTree, Scene, from_fn, kdtree::Options};
/// use hitscan::{Hit, PreparedRay, Primitives, Span, geometry::Aabb, glam::Vec3, primitives::Proximity};
///
/// /// Posts of height 1 along a road.
/// struct Posts(u32);
///
/// impl Primitives for Posts {
///     fn len(&self) -> u32 {
///         self.0
///     }
///     fn bounds(&self, index: u32) -> Aabb {
///         let foot = Vec3::X * index as f32;
///         Aabb::new(foot, foot + Vec3::Y)
///     }
///     fn intersect(&self, _: u32, _: &PreparedRay, _: &Span) -> Option<Hit> {
///         None // too thin for rays
///     }
/// }
///
/// impl Proximity for Posts {
///     fn closest_point(&self, index: u32, point: Vec3) -> Option<Vec3> {
///         Some(Vec3::new(index as f32, point.y.clamp(0.0, 1.0), 0.0))
///     }
/// }
///
/// let posts = Posts(9);
/// let mut memory = vec![0; KdTree::words(9, &Options::fast())];
/// let tree = KdTree::build(&posts, &mut Arena::new(&mut memory), &Options::fast())?;
/// let nearest = Scene::new(tree, &posts)?.nearest_point(Vec3::new(4.2, 0.5, 1.0), f32::INFINITY).unwrap();
/// assert_eq!((nearest.primitive, nearest.point), (4, Vec3::new(4.0, 0.5, 0.0)));
/// # Ok::<(), hitscan::Error>(())
/// ```
pub trait Proximity: Primitives {
    /// The point closest to `point` on the shape to which the number of a hit belongs; `None` if it has none.
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3>;

    /// The hit with the shape `index` of the ball that grows around the probe's point, if the query accepts it: its `t` is
    /// the radius at which they touch.
    ///
    /// Offer the distance to [`Probe::accept`]. It must be a pure function of shape and point. If the shape is
    /// [certified](Primitives::is_certified), it may be less than the real one only by 2^-20 of itself and 2^-42 of the
    /// largest difference of coordinates; otherwise it is raised to the distance of the shape's bounds.
    ///
    /// The default offers the distance of the [`closest_point`](Self::closest_point) numbered `index`. Collections whose
    /// hits carry other numbers, and certified shapes, have to know better.
    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        let closest = self.closest_point(index, probe.point)?;
        probe.accept(Aabb::new(closest, closest).distance(probe.point), index)
    }
}

impl<P: Proximity + ?Sized> Proximity for &P {
    #[inline(always)]
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        (**self).closest_point(number, point)
    }

    #[inline(always)]
    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        (**self).approach(index, probe)
    }
}

/// A point, and which distances from it a query would still accept: what a [`Span`] is for rays.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    point: Vec3,
    /// How long in the scene that was asked is what has length 1 here; differs from 1 where shapes are placed.
    unit: f32,
    /// In the lengths of the scene that was asked.
    span: Span,
}

impl Probe {
    /// The distances from `point` up to `most`, itself included; `None` if either is not valid.
    pub(crate) fn new(point: Vec3, most: f32) -> Option<Self> {
        if !(in_range(point) && most >= 0.0) {
            return None;
        }
        // No primitive has the number behind all.
        let until = Hit { t: math::least(most, f32::MAX), primitive: u32::MAX };
        Some(Self { point, unit: 1.0, span: Span::new(Hit { t: 0.0, primitive: 0 }, until) })
    }

    /// The point.
    #[inline(always)]
    #[must_use]
    pub const fn point(&self) -> Vec3 {
        self.point
    }

    /// The hit of `primitive` at `distance` if the query accepts it; NaN never is.
    #[inline(always)]
    #[must_use]
    pub fn accept(&self, distance: f32, primitive: u32) -> Option<Hit> {
        // The sum turns -0 into 0.
        self.span.accept(distance * self.unit + 0.0, primitive)
    }

    /// What is accepted.
    #[inline(always)]
    pub(crate) const fn span(&self) -> &Span {
        &self.span
    }

    /// The length of 1 here.
    #[inline(always)]
    pub(crate) const fn unit(&self) -> f32 {
        self.unit
    }

    /// The same point, with the hits from `from` up to `until`.
    #[inline(always)]
    pub(crate) const fn between(self, from: Hit, until: Hit) -> Self {
        Self { span: self.span.between(from, until), ..self }
    }

    /// For a shape that is not certified: not nearer than its bounds.
    #[inline]
    pub(crate) fn outside(self, bounds: &Aabb) -> Self {
        Self { span: self.span.not_before(bounds.distance(self.point) * self.unit), ..self }
    }

    /// For a collection whose number 0 is `base` here.
    #[inline]
    pub(crate) fn numbered_from(self, base: u32) -> Self {
        Self { span: self.span.numbered_from(base), ..self }
    }

    /// For the one primitive `index` whose number here is `number`.
    #[inline]
    pub(crate) fn renumbered(self, index: u32, number: u32) -> Self {
        Self { span: self.span.renumbered(index, number), ..self }
    }

    /// As seen by what was placed here, enlarged `scale` times: there, the point is `point`. `None` beyond all coordinates.
    pub(crate) fn placed(self, point: Vec3, scale: f32) -> Option<Self> {
        in_range(point).then_some(Self { point, unit: self.unit * scale, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_points_and_distances_are_refused() {
        assert!(Probe::new(Vec3::ZERO, 0.0).is_some() && Probe::new(Vec3::ZERO, f32::INFINITY).is_some());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
            assert!(Probe::new(Vec3::new(0.0, bad, 0.0), 1.0).is_none());
        }
        for bad in [f32::NAN, -1.0, f32::NEG_INFINITY] {
            assert!(Probe::new(Vec3::ZERO, bad).is_none());
        }
    }

    #[test]
    fn distances_are_raised_to_those_of_the_bounds() {
        let probe = Probe::new(Vec3::ZERO, 10.0).unwrap();
        let bounds = Aabb::new(Vec3::X * 2.0, Vec3::X * 3.0);
        let outside = probe.outside(&bounds);
        let distance = |probe: Probe, d| probe.accept(d, 7).map(|hit| hit.t.to_bits());
        assert_eq!(distance(outside, 1.0), Some(2.0_f32.to_bits()));
        assert_eq!(distance(outside, -5.0), Some(2.0_f32.to_bits()));
        assert_eq!(distance(outside, 4.0), Some(4.0_f32.to_bits()));
        assert_eq!(distance(outside, f32::NAN), None);
        assert_eq!(distance(probe, -0.0), Some(0));
        let twice = probe.placed(Vec3::ZERO, 2.0).unwrap().outside(&bounds);
        assert_eq!(distance(twice, 1.0), Some(4.0_f32.to_bits()));
        assert_eq!(distance(twice, 5.0), Some(10.0_f32.to_bits()));
        assert_eq!(distance(twice, 5.5), None);
    }
}
