use crate::geometry::{Aabb, PreparedRay};

/// Where a ray hits which primitive.
///
/// Hits are ordered by `t`, then by number: [`precedes`](Self::precedes). The closest hit is the least.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Hit {
    /// The ray's parameter.
    pub t: f32,
    /// The primitive's number.
    pub primitive: u32,
}

impl Hit {
    /// Whether this hit comes before `other`: nearer, or as near with the lower number.
    #[inline(always)]
    #[must_use]
    pub fn precedes(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.primitive < other.primitive)
    }
}

/// The hits that a query would still accept: none before `from`, all before `until`.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    from: Hit,
    until: Hit,
    enter: f32,
    exit: f32,
}

impl Span {
    /// The hits from `from`, itself included, up to `until`, itself excluded.
    #[inline(always)]
    #[must_use]
    pub const fn new(from: Hit, until: Hit) -> Self {
        Self { from, until, enter: f32::NEG_INFINITY, exit: f32::INFINITY }
    }

    /// The same hits of a shape that is not certified: clamped to its bounds, none if the ray misses these (rule R5).
    #[inline]
    pub(crate) fn within(self, bounds: &Aabb, ray: &PreparedRay) -> Option<Self> {
        let (enter, exit) = bounds.interval(ray)?;
        // Clamped to these bounds first, then to those around them: again a clamp, to what the second leaves of the first.
        Some(Self { enter: self.clamp(enter), exit: self.clamp(exit), ..self })
    }

    /// The same hits, none before `t`: what lies before is clamped to it.
    #[inline]
    pub(crate) fn not_before(self, t: f32) -> Self {
        Self { enter: if t > self.enter { t } else { self.enter }, ..self }
    }

    /// The hits from `from` up to `until`, clamped as these are.
    #[inline(always)]
    pub(crate) const fn between(self, from: Hit, until: Hit) -> Self {
        Self { from, until, ..self }
    }

    /// The parameters to which hits are clamped.
    #[inline(always)]
    pub(super) const fn clamp_to(&self) -> (f32, f32) {
        (self.enter, self.exit)
    }

    /// The same hits, clamped to these parameters.
    #[inline(always)]
    pub(super) const fn clamped_to(self, (enter, exit): (f32, f32)) -> Self {
        Self { enter, exit, ..self }
    }

    /// The least hit accepted.
    #[inline(always)]
    pub(crate) const fn from(&self) -> Hit {
        self.from
    }

    /// The hit before which all are accepted.
    #[inline(always)]
    pub(crate) const fn until(&self) -> Hit {
        self.until
    }

    /// The same hits for a collection whose number 0 is `base` here.
    #[inline]
    pub(crate) fn numbered_from(self, base: u32) -> Self {
        // Numbers before the collection's first or after its last decide ties as a whole.
        let from = Hit { primitive: self.from.primitive.saturating_sub(base), ..self.from };
        let until = Hit { primitive: self.until.primitive.saturating_sub(base), ..self.until };
        Self { from, until, ..self }
    }

    /// The same hits for the one primitive `index` whose number here is `number`.
    #[inline]
    pub(crate) fn renumbered(self, index: u32, number: u32) -> Self {
        // Numbers decide ties only: there a limit lies before the primitive or behind it.
        let around = |limit: Hit| {
            let primitive = if number < limit.primitive { index.saturating_add(1) } else { 0 };
            Hit { primitive, ..limit }
        };
        Self { from: around(self.from), until: around(self.until), ..self }
    }

    #[inline(always)]
    fn clamp(&self, t: f32) -> f32 {
        let t = if t < self.enter { self.enter } else { t };
        if t > self.exit { self.exit } else { t }
    }

    /// The hit of `primitive` at `t` if the query accepts it; NaN never is.
    #[inline(always)]
    #[must_use]
    pub fn accept(&self, t: f32, primitive: u32) -> Option<Hit> {
        let hit = Hit { t: self.clamp(t), primitive };
        (!hit.precedes(&self.from) && hit.precedes(&self.until)).then_some(hit)
    }

    /// The least parameter that may be accepted: work on smaller ones is wasted.
    #[inline(always)]
    #[must_use]
    pub const fn t_min(&self) -> f32 {
        // What lies before the bounds is clamped to where they begin; where there are none, nothing is left of this.
        if self.enter == f32::NEG_INFINITY || self.from.t > self.enter { self.from.t } else { f32::MIN }
    }

    /// The greatest parameter that may be accepted: work on larger ones is wasted.
    #[inline(always)]
    #[must_use]
    pub const fn t_max(&self) -> f32 {
        // What lies behind the bounds is clamped to where they end.
        if self.exit == f32::INFINITY || self.until.t < self.exit { self.until.t } else { f32::MAX }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::geometry::Ray;

    #[test]
    fn spans_are_closed_below_and_open_above() {
        let span = Span::new(Hit { t: 1.0, primitive: 3 }, Hit { t: 2.0, primitive: 3 });
        assert!(span.accept(1.0, 2).is_none() && span.accept(1.0, 3).is_some());
        assert!(span.accept(2.0, 2).is_some() && span.accept(2.0, 3).is_none());
        assert!(span.accept(f32::NAN, 0).is_none());
        assert!(span.accept(f32::INFINITY, 0).is_none());
    }

    #[test]
    fn limits_are_not_those_of_what_is_clamped_into_them() {
        let span = Span::new(Hit { t: 1.0, primitive: 0 }, Hit { t: 2.0, primitive: 0 });
        let slab = |min: f32, max: f32| Aabb::new(Vec3::new(-1.0, -1.0, min), Vec3::new(1.0, 1.0, max));
        let ray = Ray::new(Vec3::ZERO, Vec3::Z).prepare().unwrap();
        let inside = span.within(&slab(0.5, 3.0), &ray).unwrap();
        assert_eq!((inside.t_min(), inside.t_max()), (1.0, 2.0));
        let around = span.within(&slab(1.0, 1.9), &ray).unwrap();
        assert_eq!((around.t_min(), around.t_max()), (f32::MIN, f32::MAX));
        // What is behind both is where the outer one ends.
        let nested = around.within(&slab(0.0, 5.0), &ray).unwrap();
        assert_eq!(nested.accept(4.0, 7), around.accept(4.0, 7));
        assert!(nested.accept(4.0, 7).is_some_and(|hit| hit.t < 2.0));
    }

    #[test]
    fn renumbered_ties_are_decided_by_the_callers_numbers() {
        let span = Span::new(Hit { t: 1.0, primitive: 5 }, Hit { t: 2.0, primitive: 5 });
        for number in 0..10 {
            let (own, one) = (span.renumbered(3, number), |t| Hit { t, primitive: 3 });
            for t in [0.5, 1.0, 1.5, 2.0, 2.5] {
                let accepted = own.accept(t, 3) == Some(one(t));
                assert_eq!(accepted, span.accept(t, number).is_some(), "{t} {number}");
            }
        }
    }
}
