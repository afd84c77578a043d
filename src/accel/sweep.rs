use super::segment::Segment;
use crate::{
    geometry::{Aabb, Axis, Bundle},
    math::{greatest, least},
};

/// What a bundle finds in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ahead {
    /// Primitives.
    Primitives,
    /// Nothing, or nothing that its rays meet.
    Nothing,
    /// One cell.
    One(Segment),
    /// Two, of which the first is met first.
    Two(Segment, Segment),
}

impl Segment {
    /// When rays of a bundle are in a box; none if no ray meets it.
    #[inline(always)]
    pub(super) fn of_bundle(bounds: &Aabb, node: u32, bundle: &Bundle) -> Option<Self> {
        let (enter, exit) = bundle.interval(bounds)?;
        Some(Self { node, enter, exit })
    }

    /// What of the cell is below a plane across an axis, and whether the rays come from above.
    #[inline(always)]
    pub(super) fn below(self, axis: Axis, plane: f32, bundle: &Bundle) -> (Self, bool) {
        let passage = bundle.passage(axis, plane, self.enter);
        let part = if passage.descends { self.from(passage.earliest) } else { self.until(passage.latest) };
        (part, passage.descends)
    }

    /// What of it is above.
    #[inline(always)]
    pub(super) fn above(self, axis: Axis, plane: f32, bundle: &Bundle) -> (Self, bool) {
        let passage = bundle.passage(axis, plane, self.enter);
        let part = if passage.descends { self.until(passage.latest) } else { self.from(passage.earliest) };
        (part, passage.descends)
    }

    #[inline(always)]
    fn from(self, earliest: f32) -> Self {
        Self { enter: greatest(earliest, self.enter), ..self }
    }

    #[inline(always)]
    fn until(self, latest: f32) -> Self {
        Self { exit: least(latest, self.exit), ..self }
    }

    /// The same interval at another node.
    #[inline(always)]
    pub(super) const fn at(self, node: u32) -> Self {
        Self { node, ..self }
    }

    /// Whether no ray meets it; written so that NaN does.
    #[inline(always)]
    pub(super) fn is_missed(&self) -> bool {
        self.enter > self.exit
    }
}

impl Ahead {
    /// The parts of a cell that rays meet.
    #[inline(always)]
    pub(super) fn of(near: Segment, far: Segment) -> Self {
        match (near.is_missed(), far.is_missed()) {
            (false, false) => Self::Two(near, far),
            (false, true) => Self::One(near),
            (true, false) => Self::One(far),
            (true, true) => Self::Nothing,
        }
    }
}

/// Gives `visit` the leaves that a ray of a bundle may enter, front to back; see
/// [`Accelerator::sweep`](super::Accelerator::sweep).
///
/// One walk for all rays.
#[inline(always)]
pub(super) fn sweep<const HEIGHT: usize>(
    whole: Option<Segment>,
    look: impl Fn(Segment) -> Ahead,
    mut visit: impl FnMut(u32) -> f32,
) {
    let mut waiting: heapless::Vec<Segment, HEIGHT> = heapless::Vec::new();
    let (mut next, mut end) = (whole, f32::INFINITY);
    while let Some(segment) = next {
        // Written so that NaN visits.
        if segment.enter > end {
            next = waiting.pop();
            continue;
        }
        next = match look(segment) {
            Ahead::One(part) => Some(part),
            Ahead::Two(near, far) => {
                // It cannot fail, because no structure is deeper than its stack.
                let _ = waiting.push(far);
                Some(near)
            }
            Ahead::Primitives => {
                end = visit(segment.node);
                waiting.pop()
            }
            Ahead::Nothing => waiting.pop(),
        };
    }
}
