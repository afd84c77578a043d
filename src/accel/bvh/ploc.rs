//! From the bottom up: clusters along a space-filling curve, each joined with the one nearby that makes the least box.
//!
//! Meister and Bittner, *Parallel locally-ordered clustering for bounding volume hierarchy construction*, 2018.

use core::mem::size_of;

use super::{build::Item, descend::flatten, weight::Weight};
use crate::{
    geometry::{Aabb, Axis, Lattice},
    primitives::Primitives,
};

/// How far a cluster looks for its nearest neighbour, in both directions.
const RADIUS: usize = 12;

/// Unless one in so many clusters finds a mate in a round, the others may take theirs one-sidedly.
const SLOWEST: usize = 16;

/// Of a neighbour: they will be joined.
const PAIRED: u32 = 1 << 31;

/// Two clusters joined: numbers of primitives, or behind these numbers of nodes.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Node {
    children: [u32; 2],
    /// Primitives in both.
    count: u32,
}

/// Words per node.
pub(super) const NODE_WORDS: usize = size_of::<Node>() / 4;

/// Finds the order of `primitives`, and for each pair how many of them are in its left part.
///
/// `front` has 8 words for each of them, `back` 4.
pub(super) fn order<P: Primitives + ?Sized>(
    primitives: &P,
    bounds: &Aabb,
    front: &mut [u32],
    list: &mut [u32],
    back: &mut [u32],
) -> Option<()> {
    let count = primitives.len() as usize;
    let (items, neighbours) = front.split_at_mut_checked(count * (size_of::<Item>() / 4))?;
    let items: &mut [Item] = bytemuck::try_cast_slice_mut(items).ok()?;

    let (keys, scratch) = back.split_at_mut_checked(count * 2)?;
    let keys: &mut [Key] = bytemuck::try_cast_slice_mut(keys).ok()?;
    let scratch = bytemuck::try_cast_slice_mut(scratch.get_mut(..count * 2)?).ok()?;
    let lattice = Lattice::over(bounds, [1023; 3]);
    for (key, number) in keys.iter_mut().zip(0..) {
        *key = [morton(&primitives.bounds(number), &lattice), number];
    }
    sort(keys, scratch);
    for (item, [_, number]) in items.iter_mut().zip(keys) {
        *item = Item { bounds: primitives.bounds(*number), number: *number };
    }

    let (lefts, nodes) = back.split_at_mut_checked(count)?;
    let nodes: &mut [Node] = bytemuck::try_cast_slice_mut(nodes.get_mut(..count * NODE_WORDS)?).ok()?;
    let root = cluster(items, neighbours, nodes, bounds);
    let node = |number: u32| number.checked_sub(count as u32).and_then(|node| nodes.get(node as usize));
    let sized = |number: u32| (number, node(number).map_or(1, |node| node.count));
    let children = |number| node(number).map_or(Err(number), |node| Ok(Some(node.children.map(sized))));
    flatten(root, children, list, lefts);
    Some(())
}

/// A place on the curve and the primitive there.
type Key = [u32; 2];

/// The place of a box's middle on the curve of Morton, 1966: the bits of three coordinates in turn.
fn morton(bounds: &Aabb, lattice: &Lattice) -> u32 {
    let middle = bounds.center();
    Axis::ALL.iter().fold(0, |code, &axis| code << 1 | spread(lattice.below(axis, axis.of(middle))))
}

/// Ten bits, each followed by two zeros.
const fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

/// Sorts by the first word, equal ones as they were, digit by digit (Knuth, volume 3, §5.2.5); `scratch` is as long.
fn sort(keys: &mut [Key], scratch: &mut [Key]) {
    let (mut from, mut to) = (keys, scratch);
    // An even number of passes ends where it began.
    for shift in [0, 8, 16, 24] {
        let digit = |key: &Key| (key[0] >> shift) as usize & 255;
        let mut places = [0_u32; 256];
        for key in from.iter() {
            places[digit(key)] += 1;
        }
        let mut sum = 0;
        for place in &mut places {
            (*place, sum) = (sum, sum + *place);
        }
        for key in from.iter() {
            let place = &mut places[digit(key)];
            if let Some(slot) = to.get_mut(*place as usize) {
                *slot = *key;
            }
            *place += 1;
        }
        (from, to) = (to, from);
    }
}

/// Joins all items into one, whose number is returned; an inner one's is that of its node behind the primitives.
fn cluster(items: &mut [Item], neighbours: &mut [u32], nodes: &mut [Node], bounds: &Aabb) -> u32 {
    let weight = Weight::within(bounds);
    let (primitives, mut made) = (items.len() as u32, 0);
    let mut active = items.len();
    while active > 1 {
        let (Some(items), Some(neighbours)) = (items.get_mut(..active), neighbours.get_mut(..active)) else { break };
        find_neighbours(items, neighbours, &weight);
        pair_up(neighbours);
        let mut kept = 0;
        for index in 0..active {
            let (Some(&item), Some(&mate)) = (items.get(index), neighbours.get(index)) else { continue };
            let mate = (mate & PAIRED != 0).then_some((mate & !PAIRED) as usize);
            let item = match mate.and_then(|mate| items.get(mate)) {
                None => item,
                // The second of a pair is in the first.
                Some(_) if mate < Some(index) => continue,
                Some(mate) => {
                    let size = |number: u32| match number.checked_sub(primitives) {
                        Some(node) => nodes.get(node as usize).map_or(0, |node| node.count),
                        None => 1,
                    };
                    let count = size(item.number) + size(mate.number);
                    let node = Node { children: [item.number, mate.number], count };
                    let joined = Item { bounds: item.bounds.union(&mate.bounds), number: primitives + made };
                    if let Some(place) = nodes.get_mut(made as usize) {
                        *place = node;
                    }
                    made += 1;
                    joined
                }
            };
            if let Some(place) = items.get_mut(kept) {
                *place = item;
            }
            kept += 1;
        }
        active = kept;
    }
    items.first().map_or(0, |item| item.number)
}

/// For each item the one within the radius with which it makes the least box.
///
/// Among equals the one whose number has the most bits in common: so that two agree, and many equal ones make a balanced
/// tree.
fn find_neighbours(items: &[Item], neighbours: &mut [u32], weight: &Weight) {
    for (index, (item, neighbour)) in items.iter().zip(neighbours).enumerate() {
        let first = index.saturating_sub(RADIUS);
        let (mut least, mut nearest) = (f32::INFINITY, index ^ 1);
        for (other, candidate) in items.iter().enumerate().skip(first).take(index + RADIUS + 1 - first) {
            let distance = weight.of(&item.bounds.union(&candidate.bounds));
            let nearer = distance < least || (distance == least && other ^ index < nearest ^ index);
            if nearer && other != index {
                (least, nearest) = (distance, other);
            }
        }
        *neighbour = nearest as u32;
    }
}

/// Marks neighbours that are to be joined.
fn pair_up(neighbours: &mut [u32]) {
    let of = |neighbours: &[u32], index: usize| neighbours.get(index).copied().unwrap_or(PAIRED);
    let join = |neighbours: &mut [u32], i: usize, j: usize| {
        for (place, mate) in [(i, j), (j, i)] {
            if let Some(place) = neighbours.get_mut(place) {
                *place = mate as u32 | PAIRED;
            }
        }
    };
    // Those that found each other.
    let mut joined = 0;
    for index in 0..neighbours.len() {
        let mate = of(neighbours, index) as usize;
        if mate > index && of(neighbours, mate) as usize == index {
            join(neighbours, index, mate);
            joined += 1;
        }
    }
    if joined * SLOWEST >= neighbours.len() {
        return;
    }
    // Each that is left takes its neighbour, if that is left: so the rounds are few whatever the items.
    for index in 0..neighbours.len() {
        let mate = of(neighbours, index);
        if mate & PAIRED == 0 && of(neighbours, mate as usize) & PAIRED == 0 {
            join(neighbours, index, mate as usize);
        }
    }
}
