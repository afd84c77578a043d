//! From the top down: a set of boxes is divided where the surface area heuristic expects the least work.
//!
//! Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007.

use core::mem::size_of;

use super::{build::Item, descend::descend, weight::Weight};
use crate::{
    geometry::{Aabb, Axis},
    primitives::Primitives,
};

/// Bins per axis.
const BINS: usize = 32;

/// Finds the order of `primitives`, and for each pair how many of them are in its left part.
pub(super) fn order<P: Primitives + ?Sized>(
    primitives: &P,
    front: &mut [u32],
    list: &mut [u32],
    lefts: &mut [u32],
) -> Option<()> {
    let count = primitives.len();
    let items = front.get_mut(..count as usize * (size_of::<Item>() / 4))?;
    let items: &mut [Item] = bytemuck::try_cast_slice_mut(items).ok()?;
    for (item, number) in items.iter_mut().zip(0..) {
        *item = Item { bounds: primitives.bounds(number), number };
    }
    descend(
        count,
        |range| {
            let items = items.get_mut(range.first as usize..).and_then(|items| items.get_mut(..range.count as usize));
            items.map_or(0, |items| divide(items, range.most as usize)) as u32
        },
        |range, left| {
            if let Some(place) = lefts.get_mut(range.pair as usize) {
                *place = left;
            }
        },
    );
    for (place, item) in list.iter_mut().zip(items) {
        *place = item.number;
    }
    Some(())
}

/// A part of an axis, and what has its middle there.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

/// The bins of an axis.
#[derive(Clone, Copy)]
struct Bins {
    axis: Axis,
    min: f32,
    scale: f32,
}

impl Bins {
    /// The bin of a box's middle.
    fn of(&self, bounds: &Aabb) -> usize {
        (((self.axis.of(bounds.center()) - self.min) * self.scale) as usize).min(BINS - 1)
    }
}

/// Puts the items of the left part first; how many they are. `most` may be in a part, 0 if that cannot be done.
fn divide(items: &mut [Item], most: usize) -> usize {
    let (mut whole, mut middles) = (Aabb::EMPTY, Aabb::EMPTY);
    for item in items.iter() {
        let middle = item.bounds.center();
        whole = whole.union(&item.bounds);
        middles = middles.union(&Aabb::new(middle, middle));
    }
    let weight = Weight::within(&whole);
    let mut best = None;
    let mut least = f32::INFINITY;
    for axis in Axis::ALL {
        let min = axis.of(middles.min);
        let bins = Bins { axis, min, scale: BINS as f32 / (axis.of(middles.max) - min) };
        // A length of 0, or one so small that it makes no difference here.
        if !bins.scale.is_finite() {
            continue;
        }
        let mut filled = [Bin { bounds: Aabb::EMPTY, count: 0 }; BINS];
        for item in items.iter() {
            if let Some(bin) = filled.get_mut(bins.of(&item.bounds)) {
                bin.bounds = bin.bounds.union(&item.bounds);
                bin.count += 1;
            }
        }
        // What the parts behind each border cost; then the parts before it.
        let mut behind = [0.0; BINS];
        let mut part = Bin { bounds: Aabb::EMPTY, count: 0 };
        for (cost, bin) in behind.iter_mut().zip(&filled).rev() {
            part = Bin { bounds: part.bounds.union(&bin.bounds), count: part.count + bin.count };
            *cost = weight.of(&part.bounds) * part.count as f32;
        }
        let mut part = Bin { bounds: Aabb::EMPTY, count: 0 };
        for (border, (bin, behind)) in (1..).zip(filled.iter().zip(behind.iter().skip(1))) {
            part = Bin { bounds: part.bounds.union(&bin.bounds), count: part.count + bin.count };
            let (left, right) = (part.count, items.len() - part.count);
            let cost = weight.of(&part.bounds) * left as f32 + behind;
            if cost < least && left > 0 && right > 0 && left <= most && right <= most {
                least = cost;
                best = Some((bins, border));
            }
        }
    }
    let Some((bins, border)) = best else { return 0 };
    let mut left = 0;
    for index in 0..items.len() {
        if items.get(index).is_some_and(|item| bins.of(&item.bounds) < border) {
            swap(items, index, left);
            left += 1;
        }
    }
    left
}

/// As `slice::swap`, but without a panic for the linker to keep.
fn swap(items: &mut [Item], i: usize, j: usize) {
    if let (Some(&a), Some(&b)) = (items.get(i), items.get(j)) {
        if let Some(place) = items.get_mut(i) {
            *place = b;
        }
        if let Some(place) = items.get_mut(j) {
            *place = a;
        }
    }
}
