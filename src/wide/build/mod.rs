//! The builder of the binary hierarchy, on all threads of the caller's pool.
//!
//! Boxes are gathered; sets of them are divided from the top down ([`grow`]) at borders of [`bins`], between sorted items
//! ([`sweep`]) or at planes that cut triangles ([`spatial`]); then nodes find better places ([`reinsert`]), and all is put in
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
mod division;
mod grow;
mod hull;
mod item;
mod layout;
mod node;
mod options;
mod partition;
mod progress;
mod reinsert;
mod spatial;
mod sweep;
mod task;

#[cfg(test)]
mod tests;

use std::{ops::ControlFlow, vec::Vec};

use rayon::prelude::*;

pub use options::Options;
pub use progress::Progress;

use self::{
    grow::Grower,
    item::Item,
    layout::lay_out,
    node::Node,
    partition::CHUNK,
    progress::Monitor,
    reinsert::reinsert,
    task::{Task, extent},
};
use super::binary::Binary;
use crate::{error::BuildError, primitives::Primitives};

/// The greatest number of nodes below one another, the root not counted.
pub(super) const MAX_DEPTH: u32 = 64;

/// The most primitives: what stands for the nodes can still be numbered.
const MAX_PRIMITIVES: u32 = (1 << 30) - 1;

/// Builds a hierarchy over `primitives`, on the threads of the current `rayon` pool; `tell` hears of progress, and may
/// break it off.
pub(super) fn build<P: Primitives + Sync + ?Sized>(
    primitives: &P,
    options: &Options,
    tell: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<Option<Binary>, BuildError> {
    let count = primitives.len();
    if count > MAX_PRIMITIVES {
        return Err(BuildError::TooMany { limit: MAX_PRIMITIVES });
    }
    if count == 0 {
        return Ok(Some(Binary::default()));
    }
    let items = gather(primitives)?;
    let cuts = options.references > 1.0 && (0..count).any(|number| primitives.is_certified(number));
    let size = if cuts { (f64::from(count) * f64::from(options.references.min(2.0))) as usize } else { items.len() };
    // Cuts lead to fewer steps, but not always to less work: large primitives may be better off in one piece near the root.
    let both = cuts && options.reinsertions > 0;
    let total = if both { size + items.len() } else { size };
    let monitor = Monitor::new(total as u32, tell);
    let grower = Growth { primitives, options, monitor: &monitor };
    let whole = both.then(|| grower.grow(items.clone(), items.len()));
    let best = grower.grow(items, size);
    let best = match whole {
        Some(whole) if whole.cost() <= best.cost() => whole,
        _ => best,
    };
    Ok((!monitor.is_stopped()).then(|| best.finish()))
}

/// What hierarchies over the same primitives have in common.
struct Growth<'g, P: ?Sized> {
    primitives: &'g P,
    options: &'g Options,
    monitor: &'g Monitor<'g>,
}

impl<P: Primitives + Sync + ?Sized> Growth<'_, P> {
    /// The hierarchy over `items`, of at most `size` references.
    fn grow(&self, mut items: Vec<Item>, size: usize) -> Grown {
        let &Self { primitives, options, monitor } = self;
        let count = items.len();
        let extent = extent(&items);
        items.resize(size, Item::NOTHING);
        let mut spare: Vec<Item> = bytemuck::zeroed_vec(size);
        let mut references = bytemuck::zeroed_vec(size);
        let mut nodes: Vec<Node> = bytemuck::zeroed_vec(size * 2 - 1);
        let leaf = options.leaf_size.clamp(1, 8).next_power_of_two().ilog2();
        let grower = Grower { primitives, options, leaf, whole: extent.hull, monitor };
        if let Some((root, below)) = nodes.split_first_mut() {
            *root = grower.grow(Task {
                items: &mut items,
                count,
                spare: &mut spare,
                references: &mut references,
                nodes: below,
                first: 0,
                base: 1,
                extent,
                levels: MAX_DEPTH,
            });
        }
        let mut grown = Grown { nodes, references };
        if options.reinsertions > 0 && !monitor.is_stopped() {
            let (nodes, references) = lay_out(&grown.nodes, &grown.references, |node| node);
            grown = Grown { nodes, references };
            reinsert(&mut grown.nodes, options.reinsertions, options.reinserted);
        }
        grown
    }
}

/// A hierarchy that has not been brought into order.
struct Grown {
    nodes: Vec<Node>,
    references: Vec<u32>,
}

impl Grown {
    /// The work that the surface area heuristic expects of a ray, where there are no nodes that nothing links to.
    fn cost(&self) -> f64 {
        let Some(root) = self.nodes.first() else { return 0.0 };
        let scale = root.hull().scale();
        // A pair of children costs as much as a leaf.
        self.nodes.iter().map(|node| f64::from(node.hull().weight(scale))).sum()
    }

    fn finish(&self) -> Binary {
        let (nodes, references) = lay_out(&self.nodes, &self.references, Node::finish);
        Binary { nodes, references }
    }
}

/// The boxes of all primitives.
fn gather<P: Primitives + Sync + ?Sized>(primitives: &P) -> Result<Vec<Item>, BuildError> {
    let numbers = (0..primitives.len()).into_par_iter().with_min_len(CHUNK);
    let items: Vec<Item> = numbers.clone().map(|number| Item::new(&primitives.bounds(number), number)).collect();
    match numbers.find_first(|&number| !primitives.bounds(number).is_valid()) {
        Some(primitive) => Err(BuildError::Bounds { primitive }),
        None => Ok(items),
    }
}
