//! Where to divide a cell: each [`Split`] is one function.

use super::options::{Options, Split};
use crate::{
    accel::sort::{coordinate, key, sort},
    geometry::{Aabb, Axis, Lattice},
    math::{greatest, sqrt},
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
    /// Where the right part begins.
    pub(super) position: f32,
    /// Where the left part ends: there, too, or on a lattice one step behind, so that neither a primitive that ends
    /// within the step nor one that begins there is on both sides.
    pub(super) end: f32,
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
        match (max <= self.end, min >= self.position) {
            (true, true) if self.flat_left => Place::Left,
            (true, false) => Place::Left,
            (_, true) => Place::Right,
            (false, false) => Place::Both,
        }
    }

    /// The parts of `cell` on either side.
    pub(super) fn parts(&self, cell: &Aabb) -> (Aabb, Aabb) {
        (cell.split(self.axis, self.end).0, cell.split(self.axis, self.position).1)
    }
}

/// What a builder looks at when it divides a cell.
pub(super) struct Rules<'o> {
    pub(super) options: &'o Options,
    /// The planes there are, if not all.
    pub(super) lattice: Option<&'o Lattice>,
    /// What a half-word costs in this cell, in steps through a node.
    pub(super) price: f32,
    /// Half-words of a node, and of a reference.
    pub(super) sizes: [u32; 2],
}

/// The plane that divides `cell` best, or none if a leaf is expected to be cheaper.
///
/// `scratch` has [`SCRATCH_WORDS`] per item.
pub(super) fn choose(items: &[Item], cell: &Aabb, rules: &Rules<'_>, scratch: &mut [u32]) -> Option<Plane> {
    match rules.options.split {
        Split::Midpoint => midpoint(cell).map(|plane| rules.nearby(plane)),
        Split::Median => median(items, cell).map(|plane| rules.nearby(plane)),
        Split::Sah => surface_area(items, cell, rules, scratch),
    }
    // A plane on the border would make a child equal to the cell.
    .filter(|plane| {
        let (min, max) = (plane.axis.of(cell.min), plane.axis.of(cell.max));
        min < plane.position && plane.end < max
    })
}

impl Rules<'_> {
    /// A plane that there is, in or just before the place of `plane`.
    fn nearby(&self, plane: Plane) -> Plane {
        match self.lattice {
            None => plane,
            Some(lattice) => {
                let number = lattice.below(plane.axis, plane.position);
                let [position, end] = [number, number + 1].map(|number| lattice.position(plane.axis, number));
                Plane { position, end, ..plane }
            }
        }
    }

    /// Keys of the last plane that an item from `min` to `max` lies behind, and of the first that it lies before.
    #[inline(always)]
    fn keys(&self, axis: Axis, min: f32, max: f32) -> (u32, u32) {
        match self.lattice {
            None => (key(min), key(max)),
            // The left part ends a step behind.
            Some(lattice) => (lattice.below(axis, min), lattice.above(axis, max).saturating_sub(1)),
        }
    }

    /// Half-words of a leaf with so many items: an empty one takes nothing, a single one stands in the node.
    #[inline(always)]
    fn leaf_size(&self, items: usize) -> f32 {
        let [node, reference] = self.sizes;
        match items {
            0 => 0.0,
            1 => node as f32,
            _ => node as f32 + reference as f32 * items as f32,
        }
    }

    /// Where behind the plane of a key the right part begins and where the left one ends.
    #[inline(always)]
    fn positions(&self, axis: Axis, key: u32) -> (f32, f32) {
        match self.lattice {
            None => (coordinate(key), coordinate(key)),
            Some(lattice) => (lattice.position(axis, key), lattice.position(axis, key + 1)),
        }
    }
}

fn midpoint(cell: &Aabb) -> Option<Plane> {
    let axis = Axis::of_largest(cell.size());
    let position = axis.of(cell.center());
    Some(Plane { axis, position, end: position, flat_left: true })
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
    Some(Plane { axis, position: high, end: high, flat_left: true })
}

/// Words per item to sort in: where it begins, where it ends, and room to sort either.
pub(super) const SCRATCH_WORDS: usize = 3;

/// What it costs to have a primitive of a cell on both sides of a plane, in tests of it.
///
/// Where it is nothing, triangles through one point are divided for little gain: 1.5 times the build, 1.7 times the bytes.
/// Where it does not rise with the number of items, their references rise with its root: so many on both sides of whatever
/// plane will be so again, level by level. A surface has about the root of its triangles there, and hardly notices.
fn copy_cost(items: usize) -> f32 {
    0.15 + 0.002 * sqrt(items as f32)
}

/// A way to divide that costs less than all before it.
struct Best<'o> {
    rules: &'o Rules<'o>,
    items: usize,
    copy_cost: f32,
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
    fn offer(&mut self, chances: &Chances, plane: Plane, left: usize, right: usize) {
        let Plane { position, end, .. } = plane;
        // On the border it would not divide.
        if !(position > chances.min && end < chances.max) {
            return;
        }
        let (before, behind) = chances.of(position);
        let mut work = before * left as f32 + behind * right as f32;
        // To cut off a little empty space does not help the rays that begin within the rest.
        let empty = if left == 0 {
            1.0 - behind
        } else if right == 0 {
            1.0 - before
        } else {
            0.0
        };
        if empty > 0.3 {
            work *= 1.0 - self.rules.options.empty_bonus;
        }
        let half_words = self.rules.leaf_size(left) + self.rules.leaf_size(right) + self.rules.sizes[0] as f32;
        work += self.copy_cost * (left + right).saturating_sub(self.items) as f32;
        let cost = 1.0 + self.rules.options.intersection_cost * work + self.rules.price * half_words;
        if cost < self.cost {
            self.cost = cost;
            self.plane = Some(plane);
        }
    }
}

/// All planes through the items' bounds are tried: the cost is linear between them.
fn surface_area(items: &[Item], cell: &Aabb, rules: &Rules<'_>, scratch: &mut [u32]) -> Option<Plane> {
    let cost = rules.options.intersection_cost * items.len() as f32 + rules.price * rules.leaf_size(items.len());
    let copy_cost = copy_cost(items.len());
    let mut best = Best { rules, items: items.len(), copy_cost, cost, plane: None };
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
        let (min, max) = best.rules.keys(axis, axis.of(item.bounds.min), axis.of(item.bounds.max));
        // Of planes that coincide, the last may be behind the first.
        if min >= max {
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
        let (position, end) = best.rules.positions(axis, plane);
        let plane = Plane { axis, position, end, flat_left: true };
        best.offer(chances, plane, left + inside, right);
        if inside > 0 {
            best.offer(chances, Plane { flat_left: false, ..plane }, left, right + inside);
        }
        begun += equal(begins, begun);
        passed += inside;
    }
}
