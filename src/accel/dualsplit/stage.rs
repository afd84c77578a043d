//! The words in which a tree is built:
//!
//! ```text
//! | header | nodes → | 3 words of block per primitive | their numbers | tasks |
//! ```
//!
//! Ranges are permuted in place and finished from the left, so nodes may take the place of the blocks of primitives that
//! are in leaves; the numbers end in the order of the leaves.

use core::mem::size_of;

use super::{HEADER_WORDS, MAX_DEPTH, block::Block, split::Cut};
use crate::arena::Full;

/// Words of tasks: each level postpones at most one.
const TASKS_WORDS: usize = (MAX_DEPTH + 1) * size_of::<Task>() / 4;

/// Words of nodes that are written before the blocks that they replace are done with: two for each split above, and
/// those of [`SPARE`] carves.
const AHEAD_WORDS: usize = 2 * MAX_DEPTH + 2 * SPARE as usize;

/// Carves that need not be paid for by leaves of more than one primitive.
pub(super) const SPARE: u32 = 64;

/// See [`DualSplit::words`](super::DualSplit::words).
pub(super) const fn words(primitives: usize) -> usize {
    primitives.saturating_mul(Block::WORDS + 1).saturating_add(HEADER_WORDS + AHEAD_WORDS + TASKS_WORDS)
}

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// A range of primitives that waits to be divided.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Task {
    /// What the planes above leave of the whole.
    pub(super) implied: Block,
    pub(super) first: u32,
    pub(super) count: u32,
    /// How many splits are above.
    pub(super) depth: u32,
    /// The word of the split whose right child it is.
    pub(super) parent: u32,
}

/// The words, and how far they are taken.
pub(super) struct Stage<'w> {
    nodes: &'w mut [u32],
    /// Words of header and nodes.
    pub(super) used: usize,
    /// Words of nodes before the first block.
    ahead: usize,
    primitives: usize,
    tasks: &'w mut [Task],
    waiting: usize,
}

impl<'w> Stage<'w> {
    /// The first words of `words`, if they are enough.
    pub(super) fn new(words: &'w mut [u32], primitives: u32) -> Result<Self, Full> {
        let primitives = primitives as usize;
        let full = Full { at_least: self::words(primitives), available: words.len() };
        let words = words.get_mut(..full.at_least).ok_or(full)?;
        let (nodes, tasks) = words.split_at_mut_checked(words.len() - TASKS_WORDS).ok_or(full)?;
        let tasks = bytemuck::try_cast_slice_mut(tasks).map_err(|_| full)?;
        Ok(Self { nodes, used: HEADER_WORDS, ahead: HEADER_WORDS + AHEAD_WORDS, primitives, tasks, waiting: 0 })
    }

    /// Puts a task aside; there is room for one per level.
    pub(super) fn postpone(&mut self, task: Task) {
        if let Some(place) = self.tasks.get_mut(self.waiting) {
            *place = task;
            self.waiting += 1;
        }
    }

    /// The task put aside last.
    pub(super) fn resume(&mut self) -> Option<Task> {
        self.waiting = self.waiting.checked_sub(1)?;
        self.tasks.get(self.waiting).copied()
    }

    /// Adds a word of a node.
    pub(super) fn append(&mut self, word: u32) {
        self.set(self.used, word);
        self.used += 1;
    }

    /// A word.
    pub(super) fn word(&self, index: usize) -> u32 {
        self.nodes.get(index).copied().unwrap_or(0)
    }

    /// Sets a word.
    pub(super) fn set(&mut self, index: usize, word: u32) {
        if let Some(place) = self.nodes.get_mut(index) {
            *place = word;
        }
    }

    /// Where the numbers begin.
    pub(super) const fn numbers(&self) -> usize {
        self.ahead + self.primitives * Block::WORDS
    }

    /// The blocks of a range.
    pub(super) fn blocks(&mut self, first: u32, count: u32) -> &mut [Block] {
        let words = self.nodes.get_mut(self.ahead + first as usize * Block::WORDS..);
        let words = words.and_then(|words| words.get_mut(..count as usize * Block::WORDS));
        bytemuck::try_cast_slice_mut(words.unwrap_or_default()).unwrap_or_default()
    }

    /// Sorts a task's blocks, and the numbers with them, into those that go left and those that do not.
    pub(super) fn partition(&mut self, task: &Task, cut: &Cut) {
        let numbers = self.numbers() + task.first as usize;
        let (mut left, mut right) = (0, task.count as usize);
        while left < right {
            let blocks = self.blocks(task.first, task.count);
            let Some(&block) = blocks.get(left) else { return };
            if cut.is_left(&block) {
                left += 1;
                continue;
            }
            right -= 1;
            let Some(other) = blocks.get_mut(right) else { return };
            let other = core::mem::replace(other, block);
            if let Some(place) = blocks.get_mut(left) {
                *place = other;
            }
            let (a, b) = (self.word(numbers + left), self.word(numbers + right));
            self.set(numbers + left, b);
            self.set(numbers + right, a);
        }
    }
}
