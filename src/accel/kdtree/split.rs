//! Where to divide a cell: each [`Split`] is one function.

use super::options::{Options, Split};
use crate::{
    geometry::{Aabb, Axis},
    math::{greatest, least},
};

/// A reference to a primitive, with the bounds of the part of it that lies in the cell.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Item {
    pub(super) bounds: Aabb,
    pub(super) primitive: u32,
}

/// A plane that divides a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) axis: Axis,
    pub(super) position: f32,
    /// On which side primitives in the plane itself go.
    pub(super) flat_left: bool,
}

/// On which side of a plane an item lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Left,
    Right,
    Both,
}

impl Plane {
    #[inline(always)]
    pub(super) fn place(&self, bounds: &Aabb) -> Place {
        let (min, max) = (self.axis.of(bounds.min), self.axis.of(bounds.max));
        if min == self.position && max == self.position {
            if self.flat_left { Place::Left } else { Place::Right }
        } else if max <= self.position {
            Place::Left
        } else if min >= self.position {
            Place::Right
        } else {
            Place::Both
        }
    }
}

/// The plane that divides `cell` best, or none if a leaf is expected to be cheaper.
pub(super) fn choose(items: &[Item], cell: &Aabb, options: &Options) -> Option<Plane> {
    match options.split {
        Split::Midpoint => midpoint(cell),
        Split::Median => median(items, cell),
        Split::Sah => surface_area(items, cell, options),
    }
    // A plane on the border would make a child equal to the cell.
    .filter(|plane| {
        let (min, max) = (plane.axis.of(cell.min), plane.axis.of(cell.max));
        min < plane.position && plane.position < max
    })
}

fn midpoint(cell: &Aabb) -> Option<Plane> {
    let axis = Axis::of_largest(cell.size());
    Some(Plane { axis, position: axis.of(cell.center()), flat_left: true })
}

/// Bins whose counts are narrowed down to the median.
const MEDIAN_BINS: usize = 64;

/// The plane with as many items' middles before it as behind it, found by counting in ever smaller bins.
fn median(items: &[Item], cell: &Aabb) -> Option<Plane> {
    let axis = Axis::of_largest(cell.size());
    let (mut low, mut high) = (axis.of(cell.min), axis.of(cell.max));
    let middle = |item: &Item| axis.of(item.bounds.center());
    for _ in 0..3 {
        let width = (high - low) / MEDIAN_BINS as f32;
        if !(width > 0.0) {
            break;
        }
        let mut before = 0;
        let mut counts = [0_usize; MEDIAN_BINS];
        for item in items {
            let x = middle(item);
            if x < low {
                before += 1;
            } else if let Some(count) = counts.get_mut(((x - low) / width) as usize) {
                *count += 1;
            }
        }
        // The bin in which half of all is reached.
        let mut bin = 0;
        for (index, count) in counts.iter().enumerate() {
            bin = index;
            before += count;
            if before * 2 >= items.len() {
                break;
            }
        }
        (low, high) = (low + width * bin as f32, low + width * (bin + 1) as f32);
    }
    Some(Plane { axis, position: high, flat_left: true })
}

/// Bins per axis where there are many items.
const BINS: usize = 32;

/// Up to this many items all planes through their bounds are tried.
const FEW: usize = 12;

/// A way to divide that costs less than all before it.
struct Best<'o> {
    options: &'o Options,
    cost: f32,
    plane: Option<Plane>,
}

/// How likely a ray through a cell goes through the part of it before or behind a plane across one axis.
///
/// The chance is the part's surface over the cell's (MacDonald and Booth 1990), with sizes relative to the largest so
/// that nothing overflows, and a little for the length so that cells without surface have chances too.
struct Chances {
    min: f32,
    scale: f32,
    /// The chance of a part without length.
    flat: f32,
}

impl Chances {
    fn new(cell: &Aabb, axis: Axis) -> Self {
        let size = cell.size();
        let size = size / greatest(size.max_element(), f32::MIN_POSITIVE);
        let (length, a, b) = (axis.of(size), axis.next().of(size), axis.next().next().of(size));
        let rim = a + b + 1.0e-6;
        let whole = a * b + length * rim;
        let extent = axis.of(cell.size());
        Self { min: axis.of(cell.min), scale: length * rim / (whole * extent), flat: a * b / whole }
    }

    /// Of the parts before and behind the plane at `position`.
    fn of(&self, position: f32) -> (f32, f32) {
        let left = self.flat + (position - self.min) * self.scale;
        (left, 1.0 + self.flat - left)
    }
}

impl Best<'_> {
    fn offer(&mut self, chances: &Chances, axis: Axis, position: f32, left: usize, right: usize, flat_left: bool) {
        let (before, behind) = chances.of(position);
        let mut work = before * left as f32 + behind * right as f32;
        // Cutting off a sliver of empty space does not pay for the node.
        let empty = if left == 0 {
            1.0 - behind
        } else if right == 0 {
            1.0 - before
        } else {
            0.0
        };
        if empty > 0.1 {
            work *= 1.0 - self.options.empty_bonus;
        }
        let cost = 1.0 + self.options.intersection_cost * work;
        if cost < self.cost {
            self.cost = cost;
            self.plane = Some(Plane { axis, position, flat_left });
        }
    }
}

fn surface_area(items: &[Item], cell: &Aabb, options: &Options) -> Option<Plane> {
    let cost = options.intersection_cost * items.len() as f32;
    let mut best = Best { options, cost, plane: None };
    for axis in Axis::ALL {
        let chances = Chances::new(cell, axis);
        // A flat cell has no chances to compare.
        if !(chances.scale > 0.0) {
            continue;
        }
        if items.len() > FEW {
            binned(items, cell, axis, &chances, &mut best)
        } else {
            exact(items, cell, axis, &chances, &mut best)
        }
    }
    best.plane
}

/// Tries the borders of bins: Hunt, Mark and Stoll, *Fast kd-tree construction with an adaptive error-bounded
/// heuristic*, 2006.
fn binned(items: &[Item], cell: &Aabb, axis: Axis, chances: &Chances, best: &mut Best<'_>) {
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    for item in items {
        low = least(axis.of(item.bounds.min), low);
        high = greatest(axis.of(item.bounds.max), high);
    }
    // Empty space before and behind all items.
    if low > axis.of(cell.min) {
        best.offer(chances, axis, low, 0, items.len(), false);
    }
    if high < axis.of(cell.max) {
        best.offer(chances, axis, high, items.len(), 0, true);
    }
    let width = (high - low) / BINS as f32;
    let scale = BINS as f32 / (high - low);
    if !(width > 0.0 && scale.is_finite()) {
        return;
    }
    let bin = |x: f32| (((x - low) * scale) as usize).min(BINS - 1);
    let (mut begins, mut ends) = ([0_u32; BINS], [0_u32; BINS]);
    for item in items {
        if let Some(count) = begins.get_mut(bin(axis.of(item.bounds.min))) {
            *count += 1;
        }
        if let Some(count) = ends.get_mut(bin(axis.of(item.bounds.max))) {
            *count += 1;
        }
    }
    let (mut left, mut right) = (0, items.len());
    for (index, (begin, end)) in begins.iter().zip(&ends).enumerate() {
        if index > 0 {
            best.offer(chances, axis, low + width * index as f32, left, right, true);
        }
        left += *begin as usize;
        right -= (*end as usize).min(right);
    }
}

/// Tries all planes through the items' bounds.
fn exact(items: &[Item], cell: &Aabb, axis: Axis, chances: &Chances, best: &mut Best<'_>) {
    // Unused places are beyond every plane on both sides.
    let (mut mins, mut maxs) = ([f32::INFINITY; FEW], [f32::NEG_INFINITY; FEW]);
    for ((min, max), item) in mins.iter_mut().zip(&mut maxs).zip(items) {
        (*min, *max) = (axis.of(item.bounds.min), axis.of(item.bounds.max));
    }
    for &position in mins.iter().chain(&maxs) {
        if !(position > axis.of(cell.min) && position < axis.of(cell.max)) {
            continue;
        }
        let (mut left, mut right, mut flat) = (0_u32, 0_u32, 0_u32);
        for (&min, &max) in mins.iter().zip(&maxs) {
            left += u32::from(min < position);
            right += u32::from(max > position);
            flat += u32::from(min == position && max == position);
        }
        let (left, right, flat) = (left as usize, right as usize, flat as usize);
        best.offer(chances, axis, position, left + flat, right, true);
        if flat > 0 {
            best.offer(chances, axis, position, left, right + flat, false);
        }
    }
}
