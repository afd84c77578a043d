use super::node::Side;
use crate::{
    accel::{Entries, Entry, segment::Segment, sweep::Ahead},
    geometry::{Aabb, Axis, Bundle},
};

/// What a node of a kD-tree says to all rays of a bundle.
#[derive(Clone, Copy, Debug)]
pub(super) enum Opened {
    /// Primitives, or none.
    Leaf { is_empty: bool },
    /// Children on both sides of a plane, or on one.
    Parted { planes: Planes, left: u32, right: u32, empty: Option<Side> },
}

/// Where the right child begins and the left one ends: one plane, or the faces of a thick one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    pub(super) axis: Axis,
    pub(super) begin: f32,
    pub(super) end: f32,
}

impl Planes {
    /// What of a box is on a side.
    fn cut(&self, bounds: &Aabb, side: Side) -> Aabb {
        match side {
            Side::Left => bounds.split(self.axis, self.end).0,
            Side::Right => bounds.split(self.axis, self.begin).1,
        }
    }
}

/// What a bundle finds at a node.
#[derive(Clone, Copy, Debug)]
enum Found {
    /// Primitives.
    Primitives,
    /// Nothing, or nothing that its rays meet.
    Nothing,
    /// What counts is on one side.
    Half(Segment, Planes, Side),
    /// It may be on both, and the rays are on the right one first.
    Halves { halves: [Segment; 2], planes: Planes, descends: bool },
}

/// Nodes that are visited to tell whether a cell is empty; it counts as one that is not if they, or what may wait, do not
/// suffice.
const PATIENCE: u32 = 64;

/// The smallest cell of a tree that holds all that the rays can meet; none if there is nothing.
///
/// Where they are on both sides of a plane, and there is nothing for them on one, the cell is on the other.
pub(super) fn entries(mut bounds: Aabb, bundle: &Bundle, open: impl Fn(u32) -> Option<Opened>) -> Entries {
    let Some(mut at) = Segment::of_bundle(&bounds, 0, bundle) else { return Entries::default() };
    loop {
        let (next, planes, side) = match look(bundle, at, &open) {
            Found::Nothing => return Entries::default(),
            Found::Primitives => break,
            Found::Half(next, planes, side) => (next, planes, side),
            Found::Halves { halves: [left, right], planes, .. } => {
                match (is_empty(bundle, left, &open), is_empty(bundle, right, &open)) {
                    (true, true) => return Entries::default(),
                    (true, false) => (right, planes, Side::Right),
                    (false, true) => (left, planes, Side::Left),
                    (false, false) => break,
                }
            }
        };
        bounds = planes.cut(&bounds, side);
        at = next;
    }
    Entry { bounds, node: at.node, enter: at.enter }.into()
}

/// Nodes that may wait while it is told: few, because a search must not take more stack than the walks that it is for.
const WAITING: usize = 8;

/// Whether there certainly is nothing in a cell that the rays can meet.
fn is_empty(bundle: &Bundle, at: Segment, open: impl Fn(u32) -> Option<Opened>) -> bool {
    let mut waiting: heapless::Vec<Segment, WAITING> = heapless::Vec::new();
    let mut next = Some(at);
    for _ in 0..PATIENCE {
        let Some(segment) = next else { return true };
        next = match look(bundle, segment, &open) {
            Found::Primitives => return false,
            Found::Nothing => waiting.pop(),
            Found::Half(half, ..) => Some(half),
            Found::Halves { halves: [left, right], .. } => {
                if waiting.push(right).is_err() {
                    return false;
                }
                Some(left)
            }
        };
    }
    false
}

/// One step of all rays at once.
#[inline(always)]
fn look(bundle: &Bundle, segment: Segment, open: impl Fn(u32) -> Option<Opened>) -> Found {
    let (planes, left, right, empty) = match open(segment.node) {
        Some(Opened::Parted { planes, left, right, empty }) => (planes, left, right, empty),
        Some(Opened::Leaf { is_empty: false }) => return Found::Primitives,
        _ => return Found::Nothing,
    };
    let (left, _) = segment.at(left).below(planes.axis, planes.end, bundle);
    let (right, descends) = segment.at(right).above(planes.axis, planes.begin, bundle);
    let without_left = empty == Some(Side::Left) || left.is_missed();
    let without_right = empty == Some(Side::Right) || right.is_missed();
    match (without_left, without_right) {
        (true, true) => Found::Nothing,
        (true, false) => Found::Half(right, planes, Side::Right),
        (false, true) => Found::Half(left, planes, Side::Left),
        (false, false) => Found::Halves { halves: [left, right], planes, descends },
    }
}

/// The same in the order of the rays.
#[inline(always)]
pub(super) fn ahead(bundle: &Bundle, segment: Segment, open: impl Fn(u32) -> Option<Opened>) -> Ahead {
    match look(bundle, segment, open) {
        Found::Primitives => Ahead::Primitives,
        Found::Nothing => Ahead::Nothing,
        Found::Half(half, ..) => Ahead::One(half),
        Found::Halves { halves: [left, right], descends: false, .. } => Ahead::Two(left, right),
        Found::Halves { halves: [left, right], descends: true, .. } => Ahead::Two(right, left),
    }
}
