/// The primitives of a leaf: references of 16 or 32 bits, resolved to numbers.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<'a> {
    next: u32,
    end: u32,
    references: References<'a>,
}

/// A structure's references, in words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct References<'a> {
    words: &'a [u32],
    /// 1 if there are two per word, the lower half first; 0 if one. As a number, so that it needs no branch.
    halves: u32,
}

impl<'a> References<'a> {
    /// Each reference is its own number: for primitives that stand in the order of the leaves.
    pub(crate) const IDENTITY: Self = Self::wide(&[]);

    /// Two per word.
    pub(crate) const fn narrow(words: &'a [u32]) -> Self {
        Self { words, halves: 1 }
    }

    /// One per word.
    #[inline(always)]
    pub(crate) const fn wide(words: &'a [u32]) -> Self {
        Self { words, halves: 0 }
    }

    /// The number behind a reference.
    #[inline(always)]
    pub(crate) fn get(&self, index: u32) -> u32 {
        match self.words.get((index >> self.halves) as usize) {
            Some(word) => word >> (16 * (index & self.halves)) & u32::MAX >> (16 * self.halves),
            // Checked when opened: only of the identity there are no words.
            None => index,
        }
    }
}

impl<'a> Leaf<'a> {
    /// `count` references from the one at `first`.
    #[inline(always)]
    pub(crate) const fn of(references: References<'a>, first: u32, count: u32) -> Self {
        Self { next: first, end: first.saturating_add(count), references }
    }
}

/// Numbers in a row.
impl From<core::ops::Range<u32>> for Leaf<'_> {
    #[inline(always)]
    fn from(range: core::ops::Range<u32>) -> Self {
        Self { next: range.start, end: range.end, references: References::IDENTITY }
    }
}

impl Iterator for Leaf<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        if self.next >= self.end {
            return None;
        }
        let number = self.references.get(self.next);
        self.next += 1;
        Some(number)
    }
}
