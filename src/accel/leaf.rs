/// The primitives of a leaf, as numbers: consecutive ones, or references of 16 or 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<'a> {
    next: u32,
    end: u32,
    references: References<'a>,
}

/// Where a structure keeps its references, in words.
#[derive(Clone, Copy, Debug)]
pub(crate) enum References<'a> {
    /// Nowhere: the numbers themselves.
    None,
    /// Two per word, the lower half first.
    Narrow(&'a [u32]),
    /// One per word.
    Wide(&'a [u32]),
}

impl References<'_> {
    #[inline(always)]
    pub(crate) fn get(&self, index: u32) -> Option<u32> {
        match self {
            Self::None => Some(index),
            Self::Narrow(words) => words.get(index as usize / 2).map(|word| word >> (16 * (index % 2)) & 0xffff),
            Self::Wide(words) => words.get(index as usize).copied(),
        }
    }
}

impl<'a> Leaf<'a> {
    /// The consecutive numbers from `first`.
    #[inline(always)]
    pub(crate) const fn consecutive(first: u32, count: u32) -> Self {
        Self { next: first, end: first.saturating_add(count), references: References::None }
    }

    /// `count` references from the one at `first`.
    #[inline(always)]
    pub(crate) const fn of(references: References<'a>, first: u32, count: u32) -> Self {
        Self { next: first, end: first.saturating_add(count), references }
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
        number
    }
}
