//! One ray's way through the tree.

use core::cell::Cell;

use fearless_simd::{Simd, SimdBase, f32x8};

use super::{
    block::Block,
    node::{CHILDREN, Child, Node, WIDTH},
    slabs::{self, Met, Slabs, limit},
    stack::{Stack, Waiting},
    tree::{Asker, Counter, Tree},
};
use crate::{
    geometry::{PreparedRay, Ray, ShearLanes, beyond},
    primitives::{Hit, Sides, Span},
    query::end_of,
};

/// A node's children that are met, at least one: the one to go on with; the others wait, and come nearer meanwhile.
#[inline(always)]
fn descend<S: Simd>(tree: &Tree, node: &Node, met: &Met<S>, stack: &mut Stack) -> Child {
    let children = &node.rows[CHILDREN];
    let mut lanes = met.lanes;
    let first = lane(lanes);
    lanes &= lanes.wrapping_sub(1);
    if lanes == 0 {
        return Child(children[first]);
    }
    let enter: &[f32; WIDTH] = met.enter.as_array();
    let waiting = |lane: usize| Waiting::new(enter[lane], children[lane]);
    let (a, b) = (waiting(first), waiting(lane(lanes)));
    let mut near = a.min(b);
    stack.push(a.max(b));
    tree.touch_later(a.max(b).child());
    loop {
        lanes &= lanes.wrapping_sub(1);
        if lanes == 0 {
            return near.child();
        }
        // Not a full order, but nearer ones come to lie above.
        let other = waiting(lane(lanes));
        stack.push(other.max(near));
        tree.touch_later(other.max(near).child());
        stack.order();
        near = near.min(other);
    }
}

/// The lowest lane in a mask.
#[inline(always)]
fn lane(lanes: u32) -> usize {
    lanes.trailing_zeros() as usize & (WIDTH - 1)
}

/// What the walks of a ray share.
pub(super) struct Query<'q, S: Simd, R> {
    pub simd: S,
    pub tree: &'q Tree,
    pub asker: &'q R,
    pub shear: ShearLanes<S>,
}

impl<S: Simd, R: Asker> Query<'_, S, R> {
    /// The least hit with a block's triangles not before the ray begins, if it comes before `best`.
    #[inline(always)]
    pub(super) fn improve(&self, block: Block<'_>, best: &mut Hit) {
        let &Self { simd, tree, asker, ref shear } = self;
        let possible = block.test(simd, shear);
        let lanes = possible.lanes & block.lanes();
        if lanes == 0 {
            return;
        }
        let from = Hit { t: asker.ray().t_min, primitive: 0 };
        let limits = (f32x8::splat(simd, from.t), f32x8::splat(simd, best.t));
        let crossings = shear.place(simd, &possible, lanes, limits, false);
        let mut proven = crossings.proven;
        if tree.sides == Sides::Front {
            proven &= crossings.front();
        }
        let t = crossings.t.as_array();
        while proven != 0 {
            let lane = lane(proven);
            proven &= proven - 1;
            let number = block.number(lane);
            let hit = Hit { t: t[lane], primitive: number };
            if hit.precedes(best) && tree.is_seen(number, asker.ray().mask) {
                *best = hit;
            }
        }
        let mut open = crossings.open;
        while open != 0 {
            let lane = lane(open);
            open &= open - 1;
            let (front, span) = (crossings.is_front(lane), Span::new(from, *best));
            if let Some(hit) = tree.certify(simd, (block, lane), front, asker, &span) {
                *best = hit;
            }
        }
    }

    /// Whether there is a hit with a block's triangles not before the ray begins, and before `until`.
    #[inline(always)]
    pub(super) fn is_hit(&self, block: Block<'_>, until: Hit) -> bool {
        let &Self { simd, tree, asker, ref shear } = self;
        let possible = block.test(simd, shear);
        let lanes = possible.lanes & block.lanes();
        if lanes == 0 {
            return false;
        }
        let from = Hit { t: asker.ray().t_min, primitive: 0 };
        let limits = (f32x8::splat(simd, from.t), f32x8::splat(simd, until.t));
        let crossings = shear.place(simd, &possible, lanes, limits, true);
        // Wherever they are hit.
        let mut within = crossings.proven | crossings.certain;
        if tree.sides == Sides::Front {
            within &= crossings.front();
        }
        while within != 0 {
            if tree.is_seen(block.number(lane(within)), asker.ray().mask) {
                return true;
            }
            within &= within - 1;
        }
        let mut open = crossings.open;
        while open != 0 {
            let lane = lane(open);
            open &= open - 1;
            let (front, span) = (crossings.is_front(lane), Span::new(from, until));
            if tree.certify(simd, (block, lane), front, asker, &span).is_some() {
                return true;
            }
        }
        false
    }
}

/// The least hit of `ray`.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, tree: &Tree, ray: &Ray) -> Option<Hit> {
    let prepared = PreparedRay::here(ray);
    let ray = prepared.as_ref()?;
    let slabs = Slabs::new(simd, ray, slabs::Sides::of(ray, &tree.bounds));
    let query = Query { simd, tree, asker: ray.ray(), shear: ShearLanes::new(simd, ray) };
    let best = closest_below(&query, &slabs, tree.root?, end_of(ray));
    (best.primitive != u32::MAX).then_some(best)
}

/// How many blocks [`closest`] looks at.
#[inline(always)]
pub(super) fn tested<S: Simd>(simd: S, tree: &Tree, ray: &Ray) -> usize {
    let (Some(ray), Some(root)) = (ray.prepare(), tree.root) else { return 0 };
    let slabs = Slabs::new(simd, &ray, slabs::Sides::of(&ray, &tree.bounds));
    let counter = Counter { ray: *ray.ray(), tested: Cell::new(0) };
    let query = Query { simd, tree, asker: &counter, shear: ShearLanes::new(simd, &ray) };
    closest_below(&query, &slabs, root, end_of(&ray));
    counter.tested.get()
}

/// The least hit below `child` that comes before `best`, or that.
#[inline(always)]
pub(super) fn closest_below<S: Simd, R: Asker>(
    query: &Query<'_, S, R>,
    slabs: &Slabs<S>,
    mut child: Child,
    mut best: Hit,
) -> Hit {
    let (simd, tree) = (query.simd, query.tree);
    let mut end = limit(simd, best.t);
    let mut stack = Stack::new();
    loop {
        if !child.is_block() {
            let Some(node) = tree.nodes.get(child.0 as usize) else { break };
            let met = slabs.meet(simd, node, end);
            if met.lanes != 0 {
                child = descend(tree, node, &met, &mut stack);
                continue;
            }
        } else if let Some(block) = tree.block(child) {
            let before = best.t;
            query.asker.count();
            query.improve(block, &mut best);
            if best.t < before {
                end = limit(simd, best.t);
            }
        }
        let Some(next) = stack.pop(beyond(best.t)) else { break };
        child = next;
    }
    best
}

/// Whether `ray` has a hit.
#[inline(always)]
pub(super) fn any<S: Simd>(simd: S, tree: &Tree, ray: &Ray) -> bool {
    let prepared = PreparedRay::here(ray);
    let (Some(ray), Some(root)) = (prepared.as_ref(), tree.root) else { return false };
    let slabs = Slabs::new(simd, ray, slabs::Sides::of(ray, &tree.bounds));
    let query = Query { simd, tree, asker: ray.ray(), shear: ShearLanes::new(simd, ray) };
    any_below(&query, &slabs, root, end_of(ray))
}

/// Whether there is a hit below `child` that comes before `until`.
#[inline(always)]
pub(super) fn any_below<S: Simd, R: Asker>(
    query: &Query<'_, S, R>,
    slabs: &Slabs<S>,
    mut child: Child,
    until: Hit,
) -> bool {
    let (simd, tree) = (query.simd, query.tree);
    let end = limit(simd, until.t);
    let mut stack = Stack::new();
    loop {
        if !child.is_block() {
            let Some(node) = tree.nodes.get(child.0 as usize) else { return false };
            let lanes = slabs.meet(simd, node, end).lanes;
            if lanes != 0 {
                child = descend_in_order(node, lanes, &mut stack);
                continue;
            }
        } else if let Some(block) = tree.block(child)
            && query.is_hit(block, until)
        {
            return true;
        }
        let Some(next) = stack.pop(f32::INFINITY) else { return false };
        child = next;
    }
}

/// As [`descend`], the one in the highest lane first.
#[inline(always)]
fn descend_in_order(node: &Node, mut lanes: u32, stack: &mut Stack) -> Child {
    let children = &node.rows[CHILDREN];
    let first = lanes.checked_ilog2().unwrap_or(0);
    lanes ^= 1 << first;
    while lanes != 0 {
        stack.push(Waiting::new(0.0, children[lane(lanes)]));
        lanes &= lanes - 1;
    }
    Child(children[first as usize & (WIDTH - 1)])
}
