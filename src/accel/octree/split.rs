//! Where to divide a cell: each [`Split`] is one function.

use super::{
    division::Division,
    node::Point,
    options::{Options, Split},
    stage::Item,
};
use crate::{
    accel::sort::{coordinate, key, sort},
    geometry::{Aabb, Axis},
    math::{greatest, sqrt},
};

/// How `cell` is best divided, or none if a leaf is expected to be cheaper.
///
/// `scratch` has [`SCRATCH_WORDS`] per item.
pub(super) fn choose(items: &[Item], cell: &Aabb, options: &Options, scratch: &mut [u32]) -> Option<Division> {
    let candidate = match options.split {
        Split::Middle => middle(cell),
        Split::Sah => sweep_all(items, cell, scratch)?,
    };
    subset(items, cell, options, &candidate)
}

/// The middle of a cell.
fn middle(cell: &Aabb) -> Division {
    let mut division = Division::NONE;
    for (axis, plane) in Axis::ALL.into_iter().zip(&mut division.point.0) {
        let (min, middle, max) = (axis.of(cell.min), axis.of(cell.center()), axis.of(cell.max));
        // A plane on the border would make a child equal to the cell.
        if min < middle && middle < max {
            *plane = middle;
        }
    }
    division
}

/// Words per item to sort in: where it begins, where it ends, and room to sort either.
pub(super) const SCRATCH_WORDS: usize = 3;

/// Sizes of the parts of a cell, relative to its largest, so that nothing overflows.
struct Sizes {
    /// Of the parts before and behind the plane, by axis.
    parts: [[f32; 2]; 3],
    /// Half the surface of the whole.
    whole: f32,
}

/// Half the surface of a box, and a little for its edges so that boxes without surface have chances too.
fn half_area([x, y, z]: [f32; 3]) -> f32 {
    x * y + y * z + z * x + (x + y + z) * 1.0e-6
}

impl Sizes {
    fn new(cell: &Aabb, point: &Point) -> Self {
        let size = cell.size();
        let unit = 1.0 / greatest(size.max_element(), f32::MIN_POSITIVE);
        let part = |axis: Axis| {
            let (min, max, plane) = (axis.of(cell.min), axis.of(cell.max), point.along(axis));
            if plane < f32::INFINITY { [(plane - min) * unit, (max - plane) * unit] } else { [(max - min) * unit, 0.0] }
        };
        let parts = [part(Axis::X), part(Axis::Y), part(Axis::Z)];
        Self { parts, whole: half_area((size * unit).to_array()) }
    }

    /// The chance that a ray through the cell goes through an octant: its surface over the cell's (MacDonald and Booth
    /// 1990).
    fn chance(&self, octant: u32) -> f32 {
        let [x, y, z] = self.parts;
        let side = |[before, behind]: [f32; 2], bit: u32| if octant >> bit & 1 == 0 { before } else { behind };
        half_area([side(x, 0), side(y, 1), side(z, 2)]) / self.whole
    }
}

/// What it costs to enter a child, in visits to a node.
const CHILD: f32 = 0.3;

/// What it costs to have a part more of one of the items of a cell, in tests of it.
///
/// With it and dearer tests, a mesh takes a tenth fewer bytes or tests than without. Where it does not rise with the number of items, the references
/// to triangles through one point rise with its root: so many on both sides of whatever plane will be so again, level by
/// level. A surface has about the root of its triangles there, and hardly notices.
fn copy_cost(items: usize) -> f32 {
    0.25 + 0.001 * sqrt(items as f32)
}

/// How many items have part in each octant, whichever axes are divided.
///
/// Indexed by a digit of two bits an axis: 1 before the plane, 2 behind it, 3 wherever.
struct Counts([u32; 64]);

impl Counts {
    fn new(items: &[Item], division: &Division) -> Self {
        // First, each item by the sides that it has part in, 3 being both.
        let mut counts = [0_u32; 64];
        for item in items {
            let place = Axis::ALL.into_iter().fold(0, |place, axis| place << 2 | division.sides(axis, &item.bounds));
            counts[place as usize & 63] += 1;
        }
        // Then, axis by axis, those on both sides are added to either.
        for shift in [0, 2, 4] {
            for base in (0..64_usize).filter(|place| place >> shift & 3 == 0) {
                let (before, behind, wherever) =
                    ((base | 1 << shift) & 63, (base | 2 << shift) & 63, (base | 3 << shift) & 63);
                let (only_before, only_behind) = (counts[before], counts[behind]);
                counts[before] += counts[wherever];
                counts[behind] += counts[wherever];
                counts[wherever] += only_before + only_behind;
            }
        }
        Self(counts)
    }

    /// How many have part in an octant of a cell that is divided along these axes.
    fn inside(&self, octant: u32, axes: u32) -> u32 {
        let place = (0..3).fold(0, |place, axis| {
            let side = if axes >> axis & 1 == 0 { 3 } else { 1 + (octant >> axis & 1) };
            place << 2 | side
        });
        self.0[place as usize & 63]
    }
}

/// Of a division, the axes along which it is expected to pay; none if a leaf is cheaper.
fn subset(items: &[Item], cell: &Aabb, options: &Options, division: &Division) -> Option<Division> {
    let counts = Counts::new(items, division);
    let copy_cost = copy_cost(items.len());
    let mut best = None;
    let mut least = options.intersection_cost * items.len() as f32;
    for axes in 1..8_u32 {
        let mut part = *division;
        let mut divided = true;
        for (axis, plane) in part.point.0.iter_mut().enumerate() {
            if axes >> axis & 1 == 0 {
                *plane = f32::INFINITY;
            }
            // Where there is no plane, the same was tried without this axis.
            divided &= axes >> axis & 1 == 0 || *plane < f32::INFINITY;
        }
        if !divided {
            continue;
        }
        let sizes = Sizes::new(cell, &part.point);
        let (mut cost, mut parts) = (1.0, 0);
        for octant in (0..8_u32).filter(|octant| octant & !axes == 0) {
            let inside = counts.inside(octant, axes);
            parts += inside as usize;
            if inside > 0 {
                cost += sizes.chance(octant) * (CHILD + options.intersection_cost * inside as f32);
            }
        }
        cost += options.intersection_cost * copy_cost * parts.saturating_sub(items.len()) as f32;
        if cost < least {
            least = cost;
            best = Some(part);
        }
    }
    best
}

/// A plane across an axis that costs less than all before it.
struct Best {
    items: usize,
    copy_cost: f32,
    min: f32,
    max: f32,
    /// The chance of a part without length, and what a length adds.
    flat: f32,
    scale: f32,
    work: f32,
    plane: f32,
    flat_before: bool,
}

impl Best {
    fn new(items: usize, cell: &Aabb, axis: Axis) -> Self {
        let size = cell.size();
        let size = size / greatest(size.max_element(), f32::MIN_POSITIVE);
        let (length, a, b) = (axis.of(size), axis.next().of(size), axis.next().next().of(size));
        let rim = a + b + 1.0e-6;
        let whole = a * b + length * rim;
        Self {
            items,
            copy_cost: copy_cost(items),
            min: axis.of(cell.min),
            max: axis.of(cell.max),
            flat: a * b / whole,
            scale: length * rim / (whole * axis.of(cell.size())),
            work: f32::INFINITY,
            plane: f32::INFINITY,
            flat_before: true,
        }
    }

    #[inline]
    fn offer(&mut self, plane: f32, before: usize, behind: usize, flat_before: bool) {
        // On the border it would not divide.
        if !(plane > self.min && plane < self.max) {
            return;
        }
        let nearer = self.flat + (plane - self.min) * self.scale;
        let farther = 1.0 + self.flat - nearer;
        let copies = (before + behind).saturating_sub(self.items) as f32;
        let work = nearer * before as f32 + farther * behind as f32 + self.copy_cost * copies;
        if work < self.work {
            (self.work, self.plane, self.flat_before) = (work, plane, flat_before);
        }
    }
}

/// The best plane across each axis: all through the items' bounds are tried, the cost is linear between them.
fn sweep_all(items: &[Item], cell: &Aabb, scratch: &mut [u32]) -> Option<Division> {
    let mut division = Division::NONE;
    for axis in Axis::ALL {
        let mut best = Best::new(items.len(), cell, axis);
        // A flat cell has no chances to compare.
        if best.scale > 0.0 {
            sweep(items, axis, &mut best, scratch)?;
        }
        *division.point.0.get_mut(axis as usize)? = best.plane;
        *division.flat_before.get_mut(axis as usize)? = best.flat_before;
    }
    Some(division)
}

/// Sweeps a plane along an axis. Wald and Havran, *On building fast kd-trees for ray tracing, and on doing that in
/// O(N log N)*, 2006, with begins, ends and flat items sorted apart: their numbers are all that is asked for.
fn sweep(items: &[Item], axis: Axis, best: &mut Best, scratch: &mut [u32]) -> Option<()> {
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
        let (before, behind) = (begun + passed, (thick - ended) + (flats.len() - passed - inside));
        let position = coordinate(plane);
        best.offer(position, before + inside, behind, true);
        if inside > 0 {
            best.offer(position, before, behind + inside, false);
        }
        begun += equal(begins, begun);
        passed += inside;
    }
}
