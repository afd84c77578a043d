//! The words of a quick builder: nodes from the front, behind what they may take the numbers and the tasks.

use core::mem::size_of;

use super::{
    super::{HEADER_WORDS, is_narrow, node::Head, number_words},
    MAX_DEPTH,
    bins::Cut,
    task::Task,
};
use crate::arena::Full;

/// Words of tasks: each level postpones at most one.
const TASKS_WORDS: usize = MAX_DEPTH as usize * size_of::<Task>() / 4;

/// Words of nodes kept for so many primitives, so that ranges can be halved until leaves of `most` hold them.
pub(super) const fn kept(primitives: u32, most: u32) -> u32 {
    // Halves of what is too much for a leaf, and each leaf but one comes with a split. No more than 5, so that more than
    // `FEW` have room for half a word each.
    let half = most.div_ceil(2);
    match primitives.checked_div(if half < 5 { half } else { 5 }) {
        Some(leaves) if primitives > most => 3 * leaves - 2,
        _ => 1,
    }
}

/// Words of nodes over so many primitives: 4.5 bytes for each, more where leaves are smaller than that allows.
pub(super) const fn allowed(primitives: u32, most: u32) -> u32 {
    let (shared, kept) = (primitives + primitives / 8 + 8, kept(primitives, most));
    if shared > kept { shared } else { kept }
}

/// See [`DualSplit::words`](super::super::DualSplit::words).
pub(in super::super) const fn words(primitives: usize, most: u32) -> usize {
    if primitives > Head::MAX_PRIMITIVES as usize {
        return usize::MAX;
    }
    around(primitives as u32, allowed(primitives as u32, most))
}

/// All words, if so many are for nodes.
const fn around(primitives: u32, nodes: u32) -> usize {
    HEADER_WORDS + nodes as usize + number_words(primitives) + TASKS_WORDS
}

/// Of so many words, those before the numbers: no more than may be of use.
fn front(available: usize, primitives: u32, most: u32) -> usize {
    available.min(words(primitives as usize, most)) - number_words(primitives) - TASKS_WORDS
}

/// The words, and how far they are taken.
pub(super) struct Stage<'w> {
    /// Header and nodes; behind them, what is free.
    pub(super) nodes: &'w mut [u32],
    /// Words of header and nodes.
    pub(super) used: usize,
    /// Words of header, nodes and codes that were needed at once.
    needed: usize,
    pub(super) numbers: Numbers<'w>,
    tasks: &'w mut [Task],
    waiting: usize,
}

impl<'w> Stage<'w> {
    /// As many of `words` as may be of use, if a tree may go in them.
    pub(super) fn new(words: &'w mut [u32], primitives: u32, most: u32) -> Result<Self, Full> {
        let full = Full { at_least: around(primitives, kept(primitives, most)), available: words.len() };
        if full.available < full.at_least {
            return Err(full);
        }
        let (nodes, behind) = words.split_at_mut_checked(front(full.available, primitives, most)).ok_or(full)?;
        let (numbers, behind) = behind.split_at_mut_checked(number_words(primitives)).ok_or(full)?;
        let tasks = bytemuck::try_cast_slice_mut(behind.get_mut(..TASKS_WORDS).ok_or(full)?).map_err(|_| full)?;
        let numbers = Numbers::new(numbers, primitives);
        Ok(Self { nodes, used: HEADER_WORDS, needed: HEADER_WORDS, numbers, tasks, waiting: 0 })
    }

    /// Whether there are so many words behind the nodes, and always were so far.
    pub(super) fn reserve(&mut self, words: usize) -> bool {
        self.needed = self.needed.max(self.used + words);
        self.needed <= self.nodes.len()
    }

    /// How many words would not have been too few so far, if that is more than there are.
    pub(super) fn lacks(&self, primitives: u32) -> Option<usize> {
        (self.needed > self.nodes.len()).then(|| around(primitives, (self.needed - HEADER_WORDS) as u32))
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
        self.reserve(1);
        if let Some(place) = self.nodes.get_mut(self.used) {
            *place = word;
        }
        self.used += 1;
    }

    /// Tells a split, by its word, that its right child begins here.
    pub(super) fn link(&mut self, parent: u32) {
        let right = (self.used - HEADER_WORDS) as u32;
        if let Some(word) = self.nodes.get_mut(parent as usize) {
            *word = Head::from_word(*word).linked_to(right).to_word();
        }
    }
}

/// Which primitive is at which position, as in the finished tree.
pub(super) struct Numbers<'w> {
    words: &'w mut [u32],
    /// 1 if there are two per word, the lower half first; 0 if one.
    halves: u32,
}

impl<'w> Numbers<'w> {
    /// Each at its own.
    fn new(words: &'w mut [u32], primitives: u32) -> Self {
        // With two to a word, the last one may be none.
        words.fill(0);
        let mut numbers = Self { words, halves: u32::from(is_narrow(primitives)) };
        for number in 0..primitives {
            numbers.set(number, number);
        }
        numbers
    }

    #[inline(always)]
    pub(super) fn get(&self, position: u32) -> u32 {
        let word = self.words.get((position >> self.halves) as usize).copied().unwrap_or(0);
        word >> (16 * (position & self.halves)) & u32::MAX >> (16 * self.halves)
    }

    #[inline(always)]
    fn set(&mut self, position: u32, number: u32) {
        let (shift, mask) = (16 * (position & self.halves), u32::MAX >> (16 * self.halves));
        if let Some(word) = self.words.get_mut((position >> self.halves) as usize) {
            *word = *word & !(mask << shift) | number << shift;
        }
    }

    /// Sorts those from the position `first` on that have codes into left and right of a cut.
    pub(super) fn partition(&mut self, first: u32, codes: &[u16], cut: &Cut) {
        let (mut left, mut right) = (0, codes.len());
        let goes_left = |codes: &[u16], at: usize| codes.get(at).is_some_and(|&code| cut.is_left(code));
        loop {
            while left < right && goes_left(codes, left) {
                left += 1;
            }
            while left < right && !goes_left(codes, right - 1) {
                right -= 1;
            }
            if left >= right {
                return;
            }
            // One that goes right stands before one that goes left; behind them no code is asked for again.
            right -= 1;
            let (a, b) = (first + left as u32, first + right as u32);
            let (one, other) = (self.get(a), self.get(b));
            self.set(a, other);
            self.set(b, one);
            left += 1;
        }
    }
}

/// Moves the numbers behind the nodes, of which there are `used` words with the header; the length of all.
pub(super) fn close(words: &mut [u32], primitives: u32, most: u32, used: usize) -> usize {
    let (from, length) = (front(words.len(), primitives, most), number_words(primitives));
    for index in 0..length {
        let word = words.get(from + index).copied().unwrap_or(0);
        if let Some(place) = words.get_mut(used + index) {
            *place = word;
        }
    }
    used + length
}
