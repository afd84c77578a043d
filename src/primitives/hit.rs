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
        bounds.interval(ray).map(|(enter, exit)| Self { enter, exit, ..self })
    }

    /// The same hits for a collection whose number 0 is `base` here.
    #[inline]
    pub(crate) fn numbered_from(self, base: u32) -> Self {
        // Numbers before the collection's first or after its last decide ties as a whole.
        let from = match self.from.primitive.checked_sub(base) {
            Some(primitive) => Hit { primitive, ..self.from },
            None => Hit { primitive: 0, ..self.from },
        };
        let until = Hit { primitive: self.until.primitive.saturating_sub(base), ..self.until };
        Self { from, until, ..self }
    }

    /// The hit of `primitive` at `t` if the query accepts it; NaN never is.
    #[inline(always)]
    #[must_use]
    pub fn accept(&self, t: f32, primitive: u32) -> Option<Hit> {
        let t = if t < self.enter { self.enter } else { t };
        let t = if t > self.exit { self.exit } else { t };
        let hit = Hit { t, primitive };
        (!hit.precedes(&self.from) && hit.precedes(&self.until)).then_some(hit)
    }

    /// The least parameter accepted: work on smaller ones is wasted.
    #[inline(always)]
    #[must_use]
    pub const fn t_min(&self) -> f32 {
        self.from.t
    }

    /// The greatest parameter accepted: work on larger ones is wasted.
    #[inline(always)]
    #[must_use]
    pub const fn t_max(&self) -> f32 {
        self.until.t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_closed_below_and_open_above() {
        let span = Span::new(Hit { t: 1.0, primitive: 3 }, Hit { t: 2.0, primitive: 3 });
        assert!(span.accept(1.0, 2).is_none() && span.accept(1.0, 3).is_some());
        assert!(span.accept(2.0, 2).is_some() && span.accept(2.0, 3).is_none());
        assert!(span.accept(f32::NAN, 0).is_none());
        assert!(span.accept(f32::INFINITY, 0).is_none());
    }
}
