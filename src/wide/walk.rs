//! One ray's way through the tree.

use fearless_simd::{Simd, SimdBase, f32x8};

use super::{
    binary::MAX_DEPTH,
    node::{CHILDREN, Child, Node, TRIANGLE_WORDS, WIDTH},
    slabs::{Met, Slabs, limit, row},
    tree::{Block, Tree},
};
use crate::{
    geometry::{PreparedRay, Ray, ShearLanes, beyond},
    primitives::{Hit, Sides, Span},
    query::{end_of, start_of},
};

/// The most children that wait: of each node on the way all but one, and the last one's.
const STACK: usize = (WIDTH - 1) * MAX_DEPTH as usize + WIDTH;

/// A child that waits: where it is entered in the upper half, so that nearer ones are less, and what it is in the lower.
type Waiting = u64;

/// What of the tree is still to be looked at.
type Stack = heapless::Vec<Waiting, STACK>;

#[inline(always)]
fn waiting(enter: f32, child: u32) -> Waiting {
    u64::from(enter.to_bits()) << 32 | u64::from(child)
}

/// A node's children that are met: the one to go on with; the others are pushed.
#[inline(always)]
fn descend<S: Simd>(node: &Node, met: &Met<S>, stack: &mut Stack) -> Child {
    let children = &node.rows[CHILDREN];
    let mut lanes = met.lanes;
    let mut next = || {
        let lane = lanes.trailing_zeros() as usize & 7;
        lanes &= lanes.wrapping_sub(1);
        lane
    };
    let first = next();
    if met.lanes & met.lanes.wrapping_sub(1) == 0 {
        return Child(children[first]);
    }
    let enter: &[f32; WIDTH] = met.enter.as_array();
    let key = |lane: usize| waiting(enter[lane], children[lane]);
    let (a, b) = (key(first), key(next()));
    let (mut near, far) = (a.min(b), a.max(b));
    let _ = stack.push(far);
    let mut left = met.lanes.count_ones() - 2;
    while left > 0 {
        let other = key(next());
        let _ = stack.push(other.max(near));
        near = near.min(other);
        // The nearer ones come to lie above.
        if let Some([.., below, above]) = stack.as_mut_slice().get_mut(..) {
            (*below, *above) = ((*below).max(*above), (*below).min(*above));
        }
        left -= 1;
    }
    Child(near as u32)
}

/// The coordinates of a block's corners.
#[inline(always)]
fn corners<S: Simd>(simd: S, block: &Block, count: usize, axes: [usize; 3]) -> [[f32x8<S>; 3]; 3] {
    [0, 1, 2].map(|corner| {
        axes.map(|axis| {
            let from = (3 * corner + axis) * count;
            let words = block.get(from..).and_then(|words| words.first_chunk()).unwrap_or(&[0; WIDTH]);
            row(simd, words)
        })
    })
}

/// The least hit with a block's triangles, if one comes before `best`.
#[inline(always)]
fn improve<S: Simd>(
    simd: S,
    tree: &Tree,
    block: &Block,
    count: usize,
    (ray, shear): (&PreparedRay, &ShearLanes<S>),
    from: Hit,
    best: &mut Hit,
) {
    let possible = shear.test(simd, corners(simd, block, count, shear.axes));
    let lanes = possible.lanes & (0xff >> (WIDTH - count));
    if lanes == 0 {
        return;
    }
    let crossings = shear.place(simd, &possible, lanes, (from.t, best.t));
    let mut proven = crossings.proven;
    if tree.sides == Sides::Front {
        proven &= crossings.front();
    }
    let t = crossings.t.as_array();
    while proven != 0 {
        let lane = proven.trailing_zeros() as usize & 7;
        proven &= proven - 1;
        let number = block.get((TRIANGLE_WORDS - 1) * count + lane).copied().unwrap_or(0);
        let hit = Hit { t: t[lane], primitive: number };
        if hit.precedes(best) && tree.is_seen(number, ray) {
            *best = hit;
        }
    }
    let mut open = crossings.open;
    while open != 0 {
        let lane = open.trailing_zeros() as usize & 7;
        open &= open - 1;
        if let Some(hit) = tree.certify(block, (lane, count), crossings.is_front(lane), ray, &Span::new(from, *best)) {
            *best = hit;
        }
    }
}

/// The least hit of `ray`.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, tree: &Tree, ray: &Ray) -> Option<Hit> {
    let prepared = PreparedRay::here(ray);
    let ray = prepared.as_ref()?;
    let slabs = Slabs::new(simd, ray);
    let shear = ShearLanes::new(simd, ray);
    let from = start_of(ray);
    let mut best = end_of(ray);
    let mut end = limit(simd, best.t);
    let mut stack = Stack::new();
    let mut child = tree.root?;
    loop {
        if !child.is_block() {
            let Some(node) = tree.nodes.get(child.0 as usize) else { break };
            let met = slabs.meet(simd, node, end);
            if met.lanes != 0 {
                child = descend(node, &met, &mut stack);
                continue;
            }
        } else {
            let Some(block) = tree.block(child) else { break };
            let before = best.t;
            improve(simd, tree, block, child.count(), (ray, &shear), from, &mut best);
            if best.t < before {
                end = limit(simd, best.t);
            }
        }
        let behind = beyond(best.t);
        child = loop {
            let Some(next) = stack.pop() else { return (best.primitive != u32::MAX).then_some(best) };
            if !(f32::from_bits((next >> 32) as u32) > behind) {
                break Child(next as u32);
            }
        };
    }
    (best.primitive != u32::MAX).then_some(best)
}

/// Whether `ray` has a hit.
#[inline(always)]
pub(super) fn any<S: Simd>(simd: S, tree: &Tree, ray: &Ray) -> bool {
    let prepared = PreparedRay::here(ray);
    let Some(ray) = prepared.as_ref() else { return false };
    let slabs = Slabs::new(simd, ray);
    let shear = ShearLanes::new(simd, ray);
    let (from, until) = (start_of(ray), end_of(ray));
    let end = limit(simd, until.t);
    let mut stack: heapless::Vec<u32, STACK> = heapless::Vec::new();
    let Some(mut child) = tree.root else { return false };
    loop {
        if !child.is_block() {
            let Some(node) = tree.nodes.get(child.0 as usize) else { return false };
            let mut lanes = slabs.meet(simd, node, end).lanes;
            if lanes != 0 {
                let children = &node.rows[CHILDREN];
                child = Child(children[lanes.trailing_zeros() as usize & 7]);
                lanes &= lanes - 1;
                while lanes != 0 {
                    let _ = stack.push(children[lanes.trailing_zeros() as usize & 7]);
                    lanes &= lanes - 1;
                }
                continue;
            }
        } else {
            let Some(block) = tree.block(child) else { return false };
            let mut best = until;
            improve(simd, tree, block, child.count(), (ray, &shear), from, &mut best);
            if best.primitive != until.primitive {
                return true;
            }
        }
        let Some(next) = stack.pop() else { return false };
        child = Child(next);
    }
}
