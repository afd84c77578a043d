use super::Entry;
use crate::{
    geometry::{Aabb, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// A node, and the part of a ray that lies in its cell; of a bundle, from the earliest entry of any ray to the latest exit.
///
/// (The entry cannot be had from the exit of the cell just left: a ray in a plane is in both cells all the time.)
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub(crate) node: u32,
    pub(crate) enter: f32,
    pub(crate) exit: f32,
}

impl Segment {
    /// The part of the ray in the bounds of a node where a walk begins; exits are late by `slack`, as in all of the walk.
    #[inline(always)]
    pub(crate) fn within(bounds: &Aabb, node: u32, ray: &PreparedRay, slack: f32) -> Option<Self> {
        let (mut enter, mut exit) = (ray.ray().t_min, beyond(ray.ray().t_max));
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        for ((min, max), view) in min.into_iter().zip(max).zip(&ray.views) {
            let (near, far) = if view.ascends() { (min, max) } else { (max, min) };
            enter = greatest((near - view.origin) * view.entry, enter);
            exit = least((far - view.origin) * view.exit + slack, exit);
        }
        Self::between(enter, exit).map(|segment| Self { node, ..segment })
    }

    /// The part of the ray where one of a bundle that was looked into beforehand begins.
    #[inline(always)]
    pub(crate) fn of_entry(entry: &Entry, ray: &PreparedRay) -> Option<Self> {
        Self::within(&entry.bounds, entry.node, ray, slack_within(&entry.bounds, ray))
    }

    /// From `enter` to `exit`, for the first node; none if it ends before it begins.
    #[inline(always)]
    pub(crate) fn between(enter: f32, exit: f32) -> Option<Self> {
        if enter > exit { None } else { Some(Self { node: 0, enter, exit }) }
    }

    /// The same up to `end`.
    #[inline(always)]
    pub(crate) fn up_to(self, end: f32) -> Self {
        Self { exit: least(self.exit, end), ..self }
    }
}

/// By how much exits are late in a walk through `bounds`: by the slack of where the ray enters them. How far before it begins is
/// no matter; a walk that took that for it would skip little.
#[inline(always)]
pub(crate) fn slack_within(bounds: &Aabb, ray: &PreparedRay) -> f32 {
    if ray.ray().t_min < 0.0 { slack_behind(bounds, ray) } else { slack(0.0) }
}

/// That of a ray that reaches back.
#[cold]
#[inline(never)]
fn slack_behind(bounds: &Aabb, ray: &PreparedRay) -> f32 {
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    let near = min.into_iter().zip(max).zip(&ray.views).map(|((min, max), view)| {
        let near = if view.ascends() { min } else { max };
        (near - view.origin) * view.entry
    });
    slack(near.fold(ray.ray().t_min, |enter, near| greatest(near, enter)))
}

/// Segments that wait, the nearest on top; as many as the tree is deep.
#[derive(Clone, Debug)]
pub(crate) struct Waiting<const N: usize>(heapless::Vec<Segment, N>);

impl<const N: usize> Waiting<N> {
    /// None. Not filled where it is made, so that it is made where it stays: to move it would cost more than a hundred
    /// nodes.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self(heapless::Vec::new())
    }

    /// Puts one on top; it cannot fail, because no tree is deeper than its stack.
    #[inline(always)]
    pub(crate) fn push(&mut self, segment: Segment) {
        let _ = self.0.push(segment);
    }

    /// The nearest that begins before `end`.
    #[inline(always)]
    pub(crate) fn pop(&mut self, end: f32) -> Option<Segment> {
        loop {
            let segment = self.0.pop()?;
            if !(segment.enter > end) {
                return Some(segment);
            }
        }
    }
}
