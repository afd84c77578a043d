//! The words in which a tree is built, used from both ends:
//!
//! ```text
//! | header | stream: nodes, each leaf's references behind it → | free | ← items of pending cells | tasks |
//! ```
//!
//! A cell's items lie on top of those of the cells that wait.

use core::mem::size_of;

use super::{HEADER_WORDS, MAX_DEPTH, node::Node, split::Item};
use crate::{arena::Full, geometry::Aabb};

/// Words per item.
pub(super) const ITEM_WORDS: usize = size_of::<Item>() / 4;

/// Words of tasks: each level postpones at most one.
pub(super) const TASKS_WORDS: usize = (MAX_DEPTH + 1) * size_of::<Task>() / 4;

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// A cell that waits to be divided.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Task {
    pub(super) cell: Aabb,
    /// Its first item, counted from the end of the items.
    pub(super) top: u32,
    pub(super) count: u32,
    pub(super) depth: u32,
    /// Half-words that its subtree may take.
    pub(super) budget: u32,
    /// Where in the stream the node stands whose right child it is.
    pub(super) parent: u32,
}

impl Task {
    /// The same, for a cell whose place nobody needs to be told.
    pub(super) const fn without_parent(self) -> Self {
        Self { parent: NONE, ..self }
    }
}

/// The words, and how far they are taken.
pub(super) struct Stage<'w> {
    /// Stream and items.
    pub(super) words: &'w mut [u32],
    /// Words of stream.
    pub(super) used: usize,
    /// Items of pending cells, without those of the cell at hand.
    pub(super) top: usize,
    tasks: &'w mut [Task],
    waiting: usize,
}

impl<'w> Stage<'w> {
    /// All of `words`, if they are enough to begin with so many primitives.
    pub(super) fn new(words: &'w mut [u32], primitives: u32) -> Result<Self, Full> {
        let available = words.len();
        let items = primitives as usize * ITEM_WORDS;
        let at_least = HEADER_WORDS + TASKS_WORDS + Node::WORDS + items;
        let full = Full { at_least, available };
        let body = available.checked_sub(TASKS_WORDS).filter(|_| available >= at_least).ok_or(full)?;
        let (words, tasks) = words.split_at_mut_checked(body).ok_or(full)?;
        let tasks = bytemuck::try_cast_slice_mut(tasks).map_err(|_| full)?;
        Ok(Self { words, used: HEADER_WORDS, top: 0, tasks, waiting: 0 })
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

    /// The stream, and all that may hold items, those on top of the stack first.
    pub(super) fn parts(&mut self) -> (&mut [u32], &mut [Item]) {
        let (stream, free) = self.words.split_at_mut_checked(self.used).unwrap_or_default();
        let ragged = free.len() % ITEM_WORDS;
        let items = free.split_at_mut_checked(ragged).map(|(_, items)| items).unwrap_or_default();
        (stream, bytemuck::try_cast_slice_mut(items).unwrap_or_default())
    }

    /// The items of a cell, which are the topmost.
    pub(super) fn items(&mut self, task: &Task) -> &mut [Item] {
        self.scratch(task).1
    }

    /// What is free above the items of a cell, and these.
    pub(super) fn scratch(&mut self, task: &Task) -> (&mut [u32], &mut [Item]) {
        let first = self.words.len().saturating_sub(task.top as usize * ITEM_WORDS);
        let (front, items) = self.words.split_at_mut_checked(first).unwrap_or_default();
        let free = front.get_mut(self.used..).unwrap_or_default();
        let items = items.get_mut(..task.count as usize * ITEM_WORDS).unwrap_or_default();
        (free, bytemuck::try_cast_slice_mut(items).unwrap_or_default())
    }

    /// Makes sure that `words` can be added to the stream.
    pub(super) fn reserve(&self, words: usize) -> Result<(), Full> {
        let needed = self.used + words + self.top * ITEM_WORDS;
        if needed <= self.words.len() {
            return Ok(());
        }
        let tasks = TASKS_WORDS;
        Err(Full { at_least: needed + tasks, available: self.words.len() + tasks })
    }

    /// Adds words to the stream; the room was reserved.
    pub(super) fn append(&mut self, word: u32) {
        if let Some(place) = self.words.get_mut(self.used) {
            *place = word;
            self.used += 1;
        }
    }

    /// A word, wherever it is.
    pub(super) fn word(&self, index: usize) -> u32 {
        self.words.get(index).copied().unwrap_or(0)
    }

    /// Sets a word, wherever it is.
    pub(super) fn set(&mut self, index: usize, word: u32) {
        if let Some(place) = self.words.get_mut(index) {
            *place = word;
        }
    }
}

/// As `slice::swap`, but without a panic for the linker to keep.
pub(super) fn swap(items: &mut [Item], i: usize, j: usize) {
    if i != j
        && let (Some(&a), Some(&b)) = (items.get(i), items.get(j))
    {
        if let Some(place) = items.get_mut(i) {
            *place = b;
        }
        if let Some(place) = items.get_mut(j) {
            *place = a;
        }
    }
}
