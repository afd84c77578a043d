//! The builder: one skeleton, depth first, without recursion.
//!
//! Dividing a cell puts its items in the order of their octants, those with part in several more than once, and opens a
//! frame, which hands out the children one after the other. What is written is not moved again.

use super::{
    HEADER_WORDS,
    distribute::distribute,
    division::Division,
    leaf_words, least_words,
    node::{self, MAX_FEW, MAX_PRIMITIVES, Node, Point},
    open::Header,
    options::{Options, Split},
    reference_halves,
    split::{SCRATCH_WORDS, choose},
    stage::{FRAMES_WORDS, Frame, ITEM_WORDS, Item, Stage},
};
use crate::{
    arena::Full,
    error::BuildError,
    geometry::Aabb,
    math,
    primitives::{Primitives, bounds_of},
};

/// See [`Octree::words`](super::Octree::words).
pub(super) const fn words(primitives: usize, options: &Options) -> usize {
    let items = most_items(primitives).saturating_mul(ITEM_WORDS);
    let sorted = primitives.saturating_mul(SCRATCH_WORDS);
    FRAMES_WORDS.saturating_add(options.words(primitives)).saturating_add(items).saturating_add(sorted)
}

/// Items that may be pending at a time: cells become leaves where there would be more.
const fn most_items(primitives: usize) -> usize {
    primitives.saturating_mul(2).saturating_add(32)
}

/// Writes a tree over `primitives` to the front of `words`; how many it took.
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    if count > MAX_PRIMITIVES {
        return Err(BuildError::TooMany { limit: MAX_PRIMITIVES });
    }
    let (at_least, allowed) = (least_words(count as usize), options.words(count as usize));
    if allowed < at_least {
        return Err(BuildError::Budget { at_least: at_least * 4, allowed: options.max_bytes.unwrap_or(0) });
    }
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let mut attempt = |options: &Options| Builder::new(primitives, words, options, bounds)?.run();

    let built = attempt(options)?;
    if options.max_bytes.is_none() || !built.cut_short || options.split != Split::Sah {
        return Ok(built.words);
    }
    // The greatest intersection cost at which no cell had to become a leaf for want of bytes.
    let (mut fits, mut exceeds) = (options.intersection_cost / 256.0, options.intersection_cost);
    for _ in 0..7 {
        let cost = math::sqrt(fits * exceeds);
        let cut_short = attempt(&Options { intersection_cost: cost, ..*options })?.cut_short;
        *(if cut_short { &mut exceeds } else { &mut fits }) = cost;
    }
    Ok(attempt(&Options { intersection_cost: fits, ..*options })?.words)
}

/// What an attempt came to.
struct Built {
    words: usize,
    /// Whether a cell became a leaf because its children would have exceeded the budget.
    cut_short: bool,
}

/// A cell to be built, whose items are the topmost.
#[derive(Clone, Copy)]
struct Task {
    cell: Aabb,
    count: usize,
    /// The word of its node.
    slot: usize,
    /// Where the words end that it may take behind its node.
    end: usize,
}

struct Builder<'w, 'p, P: ?Sized> {
    primitives: &'p P,
    options: &'p Options,
    bounds: Aabb,
    /// Half-words per reference.
    halves: u32,

    stage: Stage<'w>,
    nodes: u32,
    references: u32,
    depth: usize,
    cut_short: bool,
}

impl<'w, 'p, P: Primitives + ?Sized> Builder<'w, 'p, P> {
    fn new(primitives: &'p P, words: &'w mut [u32], options: &'p Options, bounds: Aabb) -> Result<Self, Full> {
        let stage = Stage::new(words, primitives.len())?;
        let halves = reference_halves(primitives.len() as usize);
        Ok(Self { primitives, options, bounds, halves, stage, nodes: 0, references: 0, depth: 0, cut_short: false })
    }

    fn run(mut self) -> Result<Built, BuildError> {
        let mut next = self.root()?;
        while let Some(task) = next {
            self.nodes += 1;
            if !self.divide(&task)? {
                self.leaf(&task)?;
            }
            next = self.child();
        }
        let header = Header {
            nodes: self.nodes,
            references: self.references,
            primitives: self.primitives.len(),
            depth: self.depth as u32,
            bounds: self.bounds,
        };
        for (index, word) in header.to_words().into_iter().enumerate() {
            self.stage.set(index, word);
        }
        Ok(Built { words: self.stage.used, cut_short: self.cut_short })
    }

    /// The cell of all primitives, if there are any.
    fn root(&mut self) -> Result<Option<Task>, Full> {
        let primitives = self.primitives;
        let count = primitives.len() as usize;
        if count == 0 {
            return Ok(None);
        }
        self.stage.reserve(1, 0)?;
        for (primitive, item) in self.stage.items(count).0.iter_mut().enumerate() {
            let primitive = primitive as u32;
            *item = Item { bounds: primitives.bounds(primitive), primitive };
        }
        let slot = self.stage.used;
        self.stage.append(0);
        Ok(Some(Task { cell: self.bounds, count, slot, end: self.options.words(count) }))
    }

    /// The next child of the innermost frame that has one.
    fn child(&mut self) -> Option<Task> {
        let (used, halves) = (self.stage.used, self.halves);
        loop {
            let frame = self.stage.frame()?;
            let octant = frame.octants.trailing_zeros();
            if octant > 7 {
                self.stage.depth -= 1;
                continue;
            }
            // Each child may become a leaf; what is left is shared by the numbers of items.
            let (mut least, mut sharing) = (0, 0);
            for (other, &count) in frame.counts.iter().enumerate() {
                if frame.octants >> other & 1 != 0 {
                    least += leaf_words(count as usize, halves);
                    sharing += u64::from(count);
                }
            }
            let count = frame.counts.get(octant as usize).copied().unwrap_or(0);
            let excess = (frame.end as usize).saturating_sub(used + least) as u64;
            let share = (excess * u64::from(count)).checked_div(sharing).unwrap_or(0) as usize;
            let count = count as usize;
            let task = Task {
                cell: frame.point.octant(&frame.cell, octant),
                count,
                slot: frame.slot as usize,
                end: used + leaf_words(count, halves) + share,
            };
            frame.octants &= frame.octants - 1;
            frame.slot += 1;
            return Some(task);
        }
    }

    /// Writes an inner node, distributes the items and opens a frame, if the cell is to be divided.
    fn divide(&mut self, task: &Task) -> Result<bool, BuildError> {
        let count = task.count;
        if count <= self.options.leaf_size as usize || self.stage.depth >= self.options.depth() {
            return Ok(false);
        }
        self.stage.reserve(count * SCRATCH_WORDS, 0)?;
        let options = self.options;
        let (items, scratch) = self.stage.items(count);
        let Some(division) = choose(items, &task.cell, options, scratch) else { return Ok(false) };

        // How many items there will be at most; clipping makes them fewer.
        let mut most = [0_usize; 8];
        for item in items.iter() {
            let octants = division.octants(&item.bounds);
            most.iter_mut().enumerate().for_each(|(octant, most)| *most += (octants >> octant & 1) as usize);
        }
        let sum = most.iter().sum::<usize>();
        let children = || most.iter().filter(|&&most| most > 0);
        let block = Point::WORDS + children().count();
        let leaves = children().map(|&most| leaf_words(most, self.halves)).sum::<usize>();
        let crowded = self.stage.top + sum > most_items(self.primitives.len() as usize) + count;
        if crowded || self.stage.used + block + leaves > task.end {
            self.cut_short = true;
            return Ok(false);
        }
        self.stage.reserve(block, sum - count)?;

        let counts = self.distribute(task, &division, sum);
        let octants = counts.iter().enumerate().fold(0, |mask, (octant, &count)| mask | u32::from(count > 0) << octant);
        if octants == 0 {
            // Clipping has left nothing: an empty leaf.
            return self.leaf(&Task { count: 0, ..*task }).map(|()| true);
        }
        let block = self.stage.used;
        self.stage.set(task.slot, Node::inner(octants, (block - HEADER_WORDS) as u32).0);
        division.point.to_words().into_iter().for_each(|word| self.stage.append(word));
        let slot = self.stage.used as u32;
        (0..node::count(octants)).for_each(|_| self.stage.append(0));
        let end = u32::try_from(task.end).unwrap_or(u32::MAX);
        self.stage.push(Frame { cell: task.cell, point: division.point, slot, octants, end, counts });
        self.depth = self.depth.max(self.stage.depth);
        Ok(true)
    }

    /// Puts the items of a cell in the order of their octants, each as its parts there, of which there are `most` or fewer;
    /// how many are in each octant.
    fn distribute(&mut self, task: &Task, division: &Division, most: usize) -> [u32; 8] {
        let (primitives, clip) = (self.primitives, self.options.clip);
        self.stage.top += most - task.count;
        let (items, _) = self.stage.items(most);
        let counts = distribute(items, most - task.count, division, &task.cell, |item, cell| {
            if clip && primitives.is_certified(item.primitive) {
                Some(primitives.clip(item.primitive, cell)?.intersection(&item.bounds))
            } else {
                Some(item.bounds.intersection(cell))
            }
        });
        self.stage.top -= most - counts.iter().sum::<u32>() as usize;
        counts
    }

    /// Writes a leaf of the cell's items and takes them off the stack.
    fn leaf(&mut self, task: &Task) -> Result<(), BuildError> {
        let count = task.count;
        self.stage.reserve(leaf_words(count, self.halves), 0)?;
        let body = (self.stage.used - HEADER_WORDS) as u32;
        let primitive =
            |stage: &mut Stage<'_>, index: usize| stage.items(count).0.get(index).map_or(0, |item| item.primitive);
        if count == 1 {
            let only = primitive(&mut self.stage, 0);
            self.stage.set(task.slot, Node::leaf(1, only).0);
        } else {
            self.references += count as u32;
            let few = if count as u32 <= MAX_FEW { count as u32 } else { 0 };
            self.stage.set(task.slot, Node::leaf(few, body).0);
            if few == 0 {
                self.stage.append(count as u32);
            }
            let per_word = if self.halves == 1 { 2 } else { 1 };
            for index in (0..count).step_by(per_word) {
                let mut word = primitive(&mut self.stage, index);
                if per_word == 2 && index + 1 < count {
                    word |= primitive(&mut self.stage, index + 1) << 16;
                }
                self.stage.append(word);
            }
        }
        self.stage.top -= count;
        Ok(())
    }
}
