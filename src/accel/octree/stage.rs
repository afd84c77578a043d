//! The words in which a tree is built, used from both ends:
//!
//! ```text
//! | header | nodes, each leaf's references behind it → | free | ← items of pending cells | frames |
//! ```
//!
//! A cell's items lie on top of those of the cells that wait.

use core::mem::size_of;

use super::{HEADER_WORDS, MAX_DEPTH, node::Point};
use crate::{arena::Full, geometry::Aabb};

/// A reference to a primitive, with the bounds of the part of it that lies in the cell.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Item {
    pub(super) bounds: Aabb,
    /// While items are distributed, the octant stands in the upper bits.
    pub(super) primitive: u32,
}

/// Words per item.
pub(super) const ITEM_WORDS: usize = size_of::<Item>() / 4;

/// Words of frames, one a level.
pub(super) const FRAMES_WORDS: usize = MAX_DEPTH * size_of::<Frame>() / 4;

/// A cell that was divided, some children of which are still to come.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Frame {
    pub(super) cell: Aabb,
    pub(super) point: Point,
    /// The word of the next child.
    pub(super) slot: u32,
    /// The octants still to come.
    pub(super) octants: u32,
    /// Where the words end that the cell may take.
    pub(super) end: u32,
    /// Items per octant.
    pub(super) counts: [u32; 8],
}

/// The words, and how far they are taken.
pub(super) struct Stage<'w> {
    words: &'w mut [u32],
    /// Words of header and nodes.
    pub(super) used: usize,
    /// Items of pending cells, those of the cell at hand included.
    pub(super) top: usize,
    frames: &'w mut [Frame],
    /// How many frames are taken.
    pub(super) depth: usize,
}

impl<'w> Stage<'w> {
    /// All of `words`, if they are enough to begin with so many primitives.
    pub(super) fn new(words: &'w mut [u32], primitives: u32) -> Result<Self, Full> {
        let available = words.len();
        let at_least = HEADER_WORDS + FRAMES_WORDS + primitives as usize * ITEM_WORDS;
        let full = Full { at_least, available };
        let front = available.checked_sub(FRAMES_WORDS).filter(|_| available >= at_least).ok_or(full)?;
        let (words, frames) = words.split_at_mut_checked(front).ok_or(full)?;
        let frames = bytemuck::try_cast_slice_mut(frames).map_err(|_| full)?;
        Ok(Self { words, used: HEADER_WORDS, top: primitives as usize, frames, depth: 0 })
    }

    /// Opens a frame; there is one for each level.
    pub(super) fn push(&mut self, frame: Frame) {
        if let Some(place) = self.frames.get_mut(self.depth) {
            *place = frame;
            self.depth += 1;
        }
    }

    /// The innermost frame.
    pub(super) fn frame(&mut self) -> Option<&mut Frame> {
        self.frames.get_mut(self.depth.checked_sub(1)?)
    }

    /// The topmost items, and what is free above them.
    pub(super) fn items(&mut self, count: usize) -> (&mut [Item], &mut [u32]) {
        let first = self.words.len().saturating_sub(self.top * ITEM_WORDS);
        let (front, items) = self.words.split_at_mut_checked(first).unwrap_or_default();
        let free = front.get_mut(self.used..).unwrap_or_default();
        let items = items.get_mut(..count * ITEM_WORDS).unwrap_or_default();
        (bytemuck::try_cast_slice_mut(items).unwrap_or_default(), free)
    }

    /// Makes sure that `words` can be added, with `items` on top of those that are there.
    pub(super) fn reserve(&self, words: usize, items: usize) -> Result<(), Full> {
        let needed = self.used + words + (self.top + items) * ITEM_WORDS;
        if needed <= self.words.len() {
            return Ok(());
        }
        Err(Full { at_least: needed + FRAMES_WORDS, available: self.words.len() + FRAMES_WORDS })
    }

    /// Adds a word; the room was reserved.
    pub(super) fn append(&mut self, word: u32) {
        self.set(self.used, word);
        self.used += 1;
    }

    /// Sets a word.
    pub(super) fn set(&mut self, index: usize, word: u32) {
        if let Some(place) = self.words.get_mut(index) {
            *place = word;
        }
    }
}

/// As `slice::swap`, but without a panic for the linker to keep.
pub(super) fn swap(items: &mut [Item], i: usize, j: usize) {
    if let (Some(&a), Some(&b)) = (items.get(i), items.get(j)) {
        if let Some(place) = items.get_mut(i) {
            *place = b;
        }
        if let Some(place) = items.get_mut(j) {
            *place = a;
        }
    }
}
