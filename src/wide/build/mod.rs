//! The builder of the binary hierarchy, on all threads of the caller's pool.
//!
//! Boxes are gathered; sets of them are divided from the top down ([`grow`]) at borders of [`bins`], in the best way if they are
//! [`few`], or at planes that cut triangles ([`spatial`]); then nodes find better places ([`reinsert`]), and all is put in
//! the order of a walk ([`layout`]).
//!
//! The same hierarchy for any number of threads: boxes are unions and counts are sums, which come out alike in any order;
//! items keep their order where they are divided; whether threads share a set depends on its size alone; and of moves found
//! in parallel the order in which they are made is fixed.
//!
//! Depth is at most [`MAX_DEPTH`]: no part may have more items than halving could still divide within what is left, or the
//! set is halved; and no node is moved to where it, or what it is put beside, would get too deep. So each primitive is looked
//! at a bounded number of times, recursion is as deep, and any input takes time near linear.

mod bins;
mod branch;
mod division;
mod few;
mod grow;
mod item;
mod layout;
mod options;
mod partition;
mod progress;
mod reinsert;
mod spatial;
mod task;

#[cfg(test)]
mod tests;

use std::{ops::ControlFlow, vec::Vec};

use rayon::prelude::*;

pub use options::Options;
pub(super) use progress::Monitor;
pub use progress::Progress;

use self::{
    grow::Grower,
    item::Item,
    layout::lay_out,
    partition::CHUNK,
    reinsert::reinsert,
    task::{Task, extent},
};
use super::binary::Binary;
use crate::{error::BuildError, primitives::Primitives};

/// The greatest number of nodes below one another, the root not counted.
pub(super) const MAX_DEPTH: u32 = 64;

/// The most primitives in a leaf: the collapse has more to choose from than among blocks, and two triangles have room in one
/// whatever corners they have.
const LEAF: u32 = 2;

/// A round of finding better places is so many times less work than there are primitives.
const ROUND: u32 = 8;

/// Builds a hierarchy over `primitives`, on the threads of the current `rayon` pool; `monitor` hears of progress, and may
/// break it off. Leaves have [`LEAF`] primitives at most.
pub(super) fn build<P: Primitives + Sync + ?Sized, B: Send>(
    primitives: &P,
    options: &Options,
    monitor: &Monitor<'_, B>,
) -> Result<ControlFlow<B, Binary>, BuildError> {
    let count = primitives.len();
    if count == 0 {
        return Ok(ControlFlow::Continue(Binary::default()));
    }
    let cuts = options.references > 1.0 && (0..count).any(|number| primitives.is_certified(number));
    let size = if cuts { (f64::from(count) * f64::from(options.references.min(2.0))) as usize } else { count as usize };
    // Cuts lead to fewer steps, but not always to less work: large primitives may be better off in one piece near the root.
    let both = cuts && options.reinsertions > 0;
    let sizes = [Some(size), both.then_some(count as usize)];
    for size in sizes.into_iter().flatten() {
        monitor.expect(size as u32 + options.reinsertions.saturating_mul(count / ROUND));
    }
    let growth = Growth { primitives, options, monitor };
    let mut best: Option<Binary> = None;
    for size in sizes.into_iter().flatten() {
        let grown = match growth.grow(gather(primitives, size)?) {
            ControlFlow::Continue(grown) => grown,
            ControlFlow::Break(reason) => return Ok(ControlFlow::Break(reason)),
        };
        best = match best {
            Some(best) if cost(&best) < cost(&grown) => Some(best),
            _ => Some(grown),
        };
    }
    let best = best.unwrap_or_default();
    Ok(ControlFlow::Continue(if options.reinsertions > 0 { lay_out(&best) } else { best }))
}

/// What hierarchies over the same primitives have in common.
struct Growth<'g, P: ?Sized, B> {
    primitives: &'g P,
    options: &'g Options,
    monitor: &'g Monitor<'g, B>,
}

impl<P: Primitives + Sync + ?Sized, B: Send> Growth<'_, P, B> {
    /// The hierarchy over `items`, of as many references at most as there are places; if nodes were put elsewhere, not in the order of a walk.
    fn grow(&self, mut items: Vec<Item>) -> ControlFlow<B, Binary> {
        let &Self { primitives, options, monitor } = self;
        let count = primitives.len() as usize;
        let extent = extent(&items[..count]);
        let mut spare: Vec<Item> = bytemuck::zeroed_vec(items.len());
        let grower = Grower { primitives, options, whole: extent.hull, monitor };
        let task = Task { items: &mut items, count, spare: &mut spare, extent, levels: MAX_DEPTH };
        let mut grown = grower.grow(task)?.join();
        if options.reinsertions > 0 {
            let round = primitives.len() / ROUND;
            reinsert(&mut grown.nodes, options.reinsertions, options.reinserted, || monitor.advance(round))?;
        }
        ControlFlow::Continue(grown)
    }
}

/// The work that the surface area heuristic expects of a ray.
fn cost(binary: &Binary) -> f64 {
    let Some(root) = binary.nodes.first() else { return 0.0 };
    let scale = root.hull().scale();
    // A pair of children costs as much as a leaf.
    binary.nodes.iter().map(|node| f64::from(node.hull().weight(scale))).sum()
}

/// The boxes of all primitives, in as many places as there may be references.
fn gather<P: Primitives + Sync + ?Sized>(primitives: &P, size: usize) -> Result<Vec<Item>, BuildError> {
    let mut items: Vec<Item> = bytemuck::zeroed_vec(size);
    let chunks = items[..primitives.len() as usize].par_chunks_mut(CHUNK).enumerate();
    let bad = chunks.filter_map(|(chunk, items)| {
        let mut bad = None;
        for (number, item) in ((chunk * CHUNK) as u32..).zip(items) {
            let bounds = primitives.bounds(number);
            *item = Item::new(&bounds, number);
            if bad.is_none() && !bounds.is_valid() {
                bad = Some(number);
            }
        }
        bad
    });
    bad.min().map_or(Ok(items), |primitive| Err(BuildError::Bounds { primitive }))
}
