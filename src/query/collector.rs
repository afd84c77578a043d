use super::Wanted;
use crate::{
    geometry::PreparedRay,
    primitives::{Hit, Span},
};

/// What to look at after a hit.
pub(crate) enum Next {
    /// The next primitive: no further hit of this one can count.
    Primitive,
    /// The next hit of the same primitive.
    Hit,
    /// Nothing more.
    Nothing,
}

/// A query's part in a search: which hits it wants and what it does with them.
pub(crate) trait Collector {
    /// The least hit wanted.
    fn from(&self) -> Hit;

    /// The hit before which all are wanted; it never moves back.
    fn until(&self) -> Hit;

    /// The hits wanted of those not before `from`.
    #[inline(always)]
    fn span(&self, from: Hit) -> Span {
        Span::new(from, self.until())
    }

    /// Takes a hit between the two, in no particular order and some of them repeatedly.
    fn take(&mut self, hit: Hit) -> Next;
}

/// The least hit in a ray's interval.
#[inline(always)]
pub(crate) const fn start_of(ray: &PreparedRay) -> Hit {
    Hit { t: ray.ray().t_min, primitive: 0 }
}

/// The hit behind all in a ray's interval; no primitive has its number.
#[inline(always)]
pub(crate) const fn end_of(ray: &PreparedRay) -> Hit {
    Hit { t: ray.ray().t_max, primitive: u32::MAX }
}

/// Keeps the least hit.
pub(crate) struct Closest {
    t_min: f32,
    best: Hit,
}

impl Closest {
    #[inline(always)]
    pub(crate) const fn new(ray: &PreparedRay) -> Self {
        Self { t_min: ray.ray().t_min, best: end_of(ray) }
    }

    #[inline(always)]
    pub(crate) fn hit(&self) -> Option<Hit> {
        (self.best.primitive != u32::MAX).then_some(self.best)
    }
}

impl Collector for Closest {
    #[inline(always)]
    fn from(&self) -> Hit {
        // The number is a constant, which does not have to be compared.
        Hit { t: self.t_min, primitive: 0 }
    }

    #[inline(always)]
    fn until(&self) -> Hit {
        self.best
    }

    #[inline(always)]
    fn take(&mut self, hit: Hit) -> Next {
        self.best = hit;
        Next::Primitive
    }
}

/// Keeps the hit that is wanted.
pub(crate) struct First {
    closest: Closest,
    wanted: Wanted,
}

impl First {
    #[inline(always)]
    pub(crate) const fn new(ray: &PreparedRay, wanted: Wanted) -> Self {
        Self { closest: Closest::new(ray), wanted }
    }

    #[inline(always)]
    pub(crate) fn hit(&self) -> Option<Hit> {
        self.closest.hit()
    }
}

impl Collector for First {
    #[inline(always)]
    fn from(&self) -> Hit {
        self.closest.from()
    }

    #[inline(always)]
    fn until(&self) -> Hit {
        self.closest.until()
    }

    #[inline(always)]
    fn take(&mut self, hit: Hit) -> Next {
        match self.wanted {
            Wanted::Closest => self.closest.take(hit),
            Wanted::Any => {
                self.closest.take(hit);
                Next::Nothing
            }
        }
    }
}

/// Keeps the least hit of those that a query further up would accept, clamped as it wants.
pub(crate) struct Inner {
    span: Span,
    found: bool,
}

impl Inner {
    pub(crate) const fn new(span: Span) -> Self {
        Self { span, found: false }
    }

    pub(crate) fn hit(&self) -> Option<Hit> {
        self.found.then_some(self.span.until())
    }
}

impl Collector for Inner {
    fn from(&self) -> Hit {
        self.span.from()
    }

    /// As far as anything can count, which is farther than the best hit if what lies behind it is clamped to it.
    fn until(&self) -> Hit {
        Hit { t: self.span.t_max(), ..self.span.until() }
    }

    fn span(&self, from: Hit) -> Span {
        self.span.between(from, self.span.until())
    }

    fn take(&mut self, hit: Hit) -> Next {
        self.span = self.span.between(self.span.from(), hit);
        self.found = true;
        Next::Primitive
    }
}

/// Stops at the first hit it is offered.
pub(crate) struct Any {
    from: Hit,
    until: Hit,
    found: bool,
}

impl Any {
    #[inline(always)]
    pub(crate) const fn new(ray: &PreparedRay) -> Self {
        Self { from: start_of(ray), until: end_of(ray), found: false }
    }

    /// At any hit of `span`.
    pub(crate) const fn within(span: &Span) -> Self {
        Self { from: span.from(), until: span.until(), found: false }
    }

    #[inline(always)]
    pub(crate) const fn found(&self) -> bool {
        self.found
    }
}

impl Collector for Any {
    #[inline(always)]
    fn from(&self) -> Hit {
        self.from
    }

    #[inline(always)]
    fn until(&self) -> Hit {
        self.until
    }

    #[inline(always)]
    fn take(&mut self, _hit: Hit) -> Next {
        self.found = true;
        Next::Nothing
    }
}

/// Keeps the least hits, sorted, as many as there is room for.
pub(crate) struct Nearest<'h> {
    from: Hit,
    until: Hit,
    hits: &'h mut heapless::VecView<Hit>,
}

impl<'h> Nearest<'h> {
    pub(crate) const fn new(from: Hit, until: Hit, hits: &'h mut heapless::VecView<Hit>) -> Self {
        Self { from, until, hits }
    }
}

impl Collector for Nearest<'_> {
    fn from(&self) -> Hit {
        self.from
    }

    fn until(&self) -> Hit {
        match self.hits.last() {
            Some(&last) if self.hits.is_full() => last,
            _ => self.until,
        }
    }

    fn take(&mut self, hit: Hit) -> Next {
        let place = self.hits.iter().take_while(|other| other.precedes(&hit)).count();
        if self.hits.get(place).is_some_and(|other| !hit.precedes(other)) {
            // Offered before, by another leaf.
            return Next::Hit;
        }
        if self.hits.is_full() {
            self.hits.pop();
        }
        match self.hits.push(hit) {
            Ok(()) => {
                // Each one behind moves on by a place, the last one onto what was just pushed.
                let mut moved = hit;
                self.hits.iter_mut().skip(place).for_each(|other| core::mem::swap(other, &mut moved));
                Next::Hit
            }
            // There is no room for any.
            Err(_) => Next::Nothing,
        }
    }
}

/// Passes on the hits that a closure accepts.
pub(crate) struct Where<C, F> {
    inner: C,
    keep: F,
}

impl<C, F> Where<C, F> {
    #[inline(always)]
    pub(crate) const fn new(inner: C, keep: F) -> Self {
        Self { inner, keep }
    }

    #[inline(always)]
    pub(crate) fn into_inner(self) -> C {
        self.inner
    }
}

impl<C: Collector, F: FnMut(&Hit) -> bool> Collector for Where<C, F> {
    #[inline(always)]
    fn from(&self) -> Hit {
        self.inner.from()
    }

    #[inline(always)]
    fn until(&self) -> Hit {
        self.inner.until()
    }

    #[inline(always)]
    fn span(&self, from: Hit) -> Span {
        self.inner.span(from)
    }

    #[inline(always)]
    fn take(&mut self, hit: Hit) -> Next {
        if (self.keep)(&hit) { self.inner.take(hit) } else { Next::Hit }
    }
}
