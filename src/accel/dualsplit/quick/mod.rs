//! The quick builder: in the words that the tree takes, and a kilobyte.
//!
//! ```text
//! | header | nodes → | free | numbers | tasks |
//! ```
//!
//! Boxes are not kept but asked of the primitives, once per level, to fill bins (Wald, *On fast construction of SAH-based
//! bounding volume hierarchies*, 2007). A bin knows what the implied boxes of children depend on, no more: a count,
//! and an extent along its own axis. In which bins a primitive is, is put down in what is free until nodes are written.

mod bins;
mod stage;
mod task;

pub(super) use self::stage::words;
use self::{
    bins::{Cut, Spread},
    stage::{Stage, allowed, kept},
    task::Task,
};
use super::{
    HEADER_WORDS,
    block::Block,
    node::Head,
    open::{Form, Header},
    options::Options,
    split::{Metric, carve},
    stage::NONE,
};
use crate::{
    arena::Full,
    error::BuildError,
    geometry::{Aabb, Axis, Lattice},
    primitives::{Primitives, bounds_of},
};

/// The most splits above a leaf: fewer than a walk can bear, so that tasks take less.
const MAX_DEPTH: u32 = 28;

/// So many codes have a place of their own, so that they need none among the words.
const FEW: usize = 64;

/// The part of all tests that a split of few primitives saves at best.
const HOPE: f32 = 0.33;

/// Writes a tree over `primitives` to the front of `words`; how many it took.
// Out of line, so that the stack holds one builder, not two.
#[inline(never)]
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let (count, most) = (primitives.len(), options.most());
    if count > Head::MAX_PRIMITIVES {
        return Err(BuildError::TooMany { limit: Head::MAX_PRIMITIVES });
    }
    let available = words.len();
    let stage = Stage::new(words, count, most)?;
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let metric = Metric::new(&bounds, count, options.intersection_cost);
    let lattice = Lattice::over(&bounds, [Block::LAST; 3]);
    let mut builder = Builder { primitives, options, metric, lattice, stage, done: 0, depth: 0 };
    if count > 0 {
        builder.run(Task::whole(count, HEADER_WORDS as u32 + allowed(count, most)));
    }
    if let Some(at_least) = builder.stage.lacks(count) {
        return Err(Full { at_least, available }.into());
    }
    let (used, depth) = (builder.stage.used, builder.depth);
    let nodes = (used - HEADER_WORDS) as u32;
    let header = Header { nodes, primitives: count, depth, form: Form::Numbered, bounds };
    for (place, word) in words.iter_mut().zip(header.to_words()) {
        *place = word;
    }
    Ok(stage::close(words, count, most, used))
}

struct Builder<'b, P: ?Sized> {
    primitives: &'b P,
    options: &'b Options,
    metric: Metric,
    lattice: Lattice,
    stage: Stage<'b>,
    /// Primitives in leaves.
    done: u32,
    depth: u32,
}

impl<P: Primitives + ?Sized> Builder<'_, P> {
    fn run(&mut self, mut task: Task) {
        loop {
            if !self.stage.reserve(0) {
                return;
            }
            if task.parent != NONE {
                self.stage.link(task.parent);
            }
            task = match self.divide(task) {
                Some(left) => left,
                None => {
                    self.stage.append(Head::leaf(self.done, task.count()).to_word());
                    self.done += task.count();
                    match self.stage.resume() {
                        Some(right) => right,
                        None => return,
                    }
                }
            };
        }
    }

    /// Writes what stands above the children, and puts the right one aside; the left one, or none if it is to be a leaf.
    fn divide(&mut self, mut task: Task) -> Option<Task> {
        let (most, count) = (self.options.most(), task.count());
        let kept = |count| kept(count, most);
        let levels = MAX_DEPTH.checked_sub(task.depth() + 1)?;
        // Where hardly a way to divide could pay, none is looked for.
        if count <= 1 || count <= most && self.options.intersection_cost * HOPE * count as f32 <= 1.0 {
            return None;
        }
        if count as usize > FEW && !self.stage.reserve(count.div_ceil(2) as usize) {
            return None;
        }
        let Stage { nodes, used, numbers, .. } = &mut self.stage;
        let (first, mut few) = (self.done, [0; FEW]);
        let codes = match few.get_mut(..count as usize) {
            Some(codes) => codes,
            None => {
                let free = bytemuck::try_cast_slice_mut(nodes.get_mut(*used..).unwrap_or_default());
                free.unwrap_or_default().get_mut(..count as usize).unwrap_or_default()
            }
        };
        let boxes = (first..first + count).map(|position| self.primitives.bounds(numbers.get(position)));
        let mut spread = Spread::NONE;
        spread.add(boxes, codes, &task.implied, &self.lattice);
        let sums = spread.sums();

        // Cut off empty space, and divide so that what levels and words remain suffice.
        let mut words = task.limit - *used as u32;
        let threshold = self.options.carve_threshold;
        let carve = carve(&sums.tight(&self.lattice), &task.implied, &self.metric, count, threshold)
            .filter(|_| words >= 2 + kept(count));
        if let Some((_, carved)) = carve {
            words -= 2;
            task.implied = carved;
        }
        let bound = u32::try_from(u64::from(most) << levels).unwrap_or(u32::MAX);
        let cut = sums
            .cut(&task.implied, &self.metric, &self.lattice, bound)
            .filter(|cut| words >= 2 + kept(cut.left) + kept(count - cut.left));
        let cost = |work: f32| self.options.intersection_cost * work;
        let pays = cut.is_some_and(|cut| 1.0 + cost(cut.work) < cost(count as f32));
        let is_leaf = count <= most && !pays;
        if let Some(cut) = cut
            && !is_leaf
        {
            numbers.partition(first, codes, &cut);
        }

        // Codes are done with: nodes may take their place.
        if let Some((faces, carved)) = carve {
            let [low, high] = faces.map(|face| carved.plane(face));
            self.node(Head::carve(faces), low, high);
        }
        if is_leaf {
            return None;
        }
        let (axis, left, low, high) = match cut {
            Some(Cut { axis, left, planes: (low, high), .. }) => (axis, left, low, high),
            // All are in one place, or levels or words run out: in the middle.
            None => {
                let left = count / 2;
                let (low, high) = (self.around(first, left), self.around(first + left, count - left));
                (Axis::X, left, low.max.x, high.min.x)
            }
        };
        let (low, high) = (self.lattice.above(axis, low), self.lattice.below(axis, high));
        let parent = self.stage.used as u32;
        self.node(Head::split(axis, 0), low, high);
        self.depth = self.depth.max(task.depth() + 1);
        // Of the words that remain to each its part; the right one gets also what the left one does not need.
        let (right, words) = (count - left, words - 2);
        let part = (u64::from(words) * u64::from(left) / u64::from(count)) as u32;
        let limit = self.stage.used as u32 + part.max(kept(left)).min(words - kept(right));
        let (min, max) = (task.implied.min(axis), task.implied.max(axis));
        self.stage.postpone(task.child(right, task.implied.between(axis, high, max), parent, task.limit));
        Some(task.child(left, task.implied.between(axis, min, low), NONE, limit))
    }

    /// Writes a node of two planes.
    fn node(&mut self, head: Head, low: u32, high: u32) {
        self.stage.append(head.to_word());
        self.stage.append(low | high << 16);
    }

    /// The box around a range.
    fn around(&self, first: u32, count: u32) -> Aabb {
        let boxes = (first..first + count).map(|position| self.primitives.bounds(self.stage.numbers.get(position)));
        boxes.fold(Aabb::EMPTY, |all, bounds| all.union(&bounds))
    }
}
