//! Builders of the binary hierarchy.

mod bins;
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

#[cfg(test)]
mod probe;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use std::{ops::ControlFlow, vec, vec::Vec};

pub use options::Options;
pub use progress::Progress;

use self::{
    grow::{Grower, Task, extent_parallel},
    item::Item,
    layout::lay_out,
    node::Node,
    partition::CHUNK,
    progress::Monitor,
    reinsert::reinsert,
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
    let mut items = gather(primitives)?;
    let extent = extent_parallel(&items);
    let count = items.len();
    let size = (count as f64 * f64::from(options.references.clamp(1.0, 2.0))) as usize;
    items.resize(size, Item::NOTHING);
    let mut spare = vec![Item::NOTHING; size];
    let mut references = vec![0; size];
    let mut nodes: Vec<Node> = vec![bytemuck::Zeroable::zeroed(); size * 2 - 1];
    let monitor = Monitor::new(size as u32, tell);
    let block = options.block.clamp(1, 8).next_power_of_two().ilog2();
    let grower = Grower { primitives, options, block, whole: extent.hull, monitor: &monitor };
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
    if monitor.is_stopped() {
        return Ok(None);
    }
    let (mut nodes, mut references) = lay_out(&nodes, &references);
    if options.reinsertions > 0 {
        reinsert(&mut nodes, options.reinsertions, options.reinserted);
        (nodes, references) = lay_out(&nodes, &references);
    }
    let nodes = nodes.iter().map(Node::finish).collect();
    Ok(Some(Binary { nodes, references }))
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

/// x
pub(super) fn tune(i: usize) -> f32 {
    static T: std::sync::OnceLock<std::vec::Vec<f32>> = std::sync::OnceLock::new();
    T.get_or_init(|| std::env::var("TUNE").unwrap_or("100 1e-5 0 0 0 0".into()).split(' ').map(|s| s.parse().unwrap()).collect())[i]
}
