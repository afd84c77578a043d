//! Where to divide a cell: each [`Split`] is one function.

use super::options::{Options, Split};
use crate::{
    accel::sort::{coordinate, key, sort},
    geometry::{Aabb, Axis},
    math::greatest,
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
///
/// `scratch` has [`SCRATCH_WORDS`] per item.
pub(super) fn choose(items: &[Item], cell: &Aabb, options: &Options, scratch: &mut [u32]) -> Option<Plane> {
    match options.split {
        Split::Midpoint => midpoint(cell),
        Split::Median => median(items, cell),
        Split::Sah => surface_area(items, cell, options, scratch),
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

/// Words per item to sort in: where it begins, where it ends, and room to sort either.
pub(super) const SCRATCH_WORDS: usize = 3;

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
    max: f32,
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
        Self {
            min: axis.of(cell.min),
            max: axis.of(cell.max),
            scale: length * rim / (whole * extent),
            flat: a * b / whole,
        }
    }

    /// Of the parts before and behind the plane at `position`.
    fn of(&self, position: f32) -> (f32, f32) {
        let left = self.flat + (position - self.min) * self.scale;
        (left, 1.0 + self.flat - left)
    }
}

impl Best<'_> {
    #[inline]
    fn offer(&mut self, chances: &Chances, axis: Axis, position: f32, left: usize, right: usize, flat_left: bool) {
        // On the border it would not divide.
        if !(position > chances.min && position < chances.max) {
            return;
        }
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

/// All planes through the items' bounds are tried: the cost is linear between them.
fn surface_area(items: &[Item], cell: &Aabb, options: &Options, scratch: &mut [u32]) -> Option<Plane> {
    let cost = options.intersection_cost * items.len() as f32;
    let mut best = Best { options, cost, plane: None };
    for axis in Axis::ALL {
        let chances = Chances::new(cell, axis);
        // A flat cell has no chances to compare.
        if chances.scale > 0.0 {
            sweep(items, axis, &chances, &mut best, scratch)?;
        }
    }
    best.plane
}

/// Sweeps a plane along an axis. Wald and Havran, *On building fast kd-trees for ray tracing, and on doing that in
/// O(N log N)*, 2006, with begins, ends and flat items sorted apart: their numbers are all that is asked for.
fn sweep(items: &[Item], axis: Axis, chances: &Chances, best: &mut Best<'_>, scratch: &mut [u32]) -> Option<()> {
    let (begins, scratch) = scratch.split_at_mut_checked(items.len())?;
    let (ends, scratch) = scratch.split_at_mut_checked(items.len())?;
    // Begins from the front, flat items from the back.
    let (mut thick, mut flat) = (0, items.len());
    for item in items {
        let (min, max) = (key(axis.of(item.bounds.min)), key(axis.of(item.bounds.max)));
        if min == max {
            flat -= 1;
            *begins.get_mut(flat)? = min;
        } else {
            *begins.get_mut(thick)? = min;
            *ends.get_mut(thick)? = max;
            thick += 1;
        }
    }
    let (begins, flats) = begins.split_at_mut_checked(thick)?;
    let (ends, _) = ends.split_at_mut_checked(thick)?;
    for keys in [&mut *begins, &mut *ends, &mut *flats] {
        sort(keys, scratch);
    }

    // How many items begin before the plane, lie flat before it, and end before or in it.
    let (mut begun, mut passed, mut ended) = (0, 0, 0);
    loop {
        let next = |keys: &[u32], index: usize| keys.get(index).copied().unwrap_or(u32::MAX);
        let plane = next(begins, begun).min(next(ends, ended)).min(next(flats, passed));
        if plane == u32::MAX {
            return Some(());
        }
        let equal = |keys: &[u32], from: usize| keys.iter().skip(from).take_while(|&&key| key == plane).count();
        ended += equal(ends, ended);
        let inside = equal(flats, passed);
        let (left, right) = (begun + passed, (thick - ended) + (flats.len() - passed - inside));
        let position = coordinate(plane);
        best.offer(chances, axis, position, left + inside, right, true);
        if inside > 0 {
            best.offer(chances, axis, position, left, right + inside, false);
        }
        begun += equal(begins, begun);
        passed += inside;
    }
}
