/// The primitives of a leaf: references of 16 or 32 bits, resolved to numbers.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<'a> {
    next: u32,
    end: u32,
    references: References<'a>,
}

/// A structure's references, in words; where there are none, each is its own number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum References<'a> {
    /// Two per word, the lower half first.
    Narrow(&'a [u16]),
    /// One per word.
    Wide(&'a [u32]),
}

impl<'a> References<'a> {
    /// Each reference is its own number: for primitives that stand in the order of the leaves.
    pub(crate) const IDENTITY: Self = Self::Wide(&[]);

    /// Two per word.
    pub(crate) const fn narrow(words: &'a [u32]) -> Self {
        Self::Narrow(bytemuck::must_cast_slice(words))
    }

    /// One per word.
    pub(crate) const fn wide(words: &'a [u32]) -> Self {
        Self::Wide(words)
    }

    /// The number behind a reference.
    #[inline(always)]
    pub(crate) fn get(&self, index: u32) -> u32 {
        // Checked when opened: only of the identity there are no words.
        match self {
            Self::Narrow(halves) => halves.get((index ^ SECOND_FIRST) as usize).map_or(index, |&half| u32::from(half)),
            Self::Wide(words) => words.get(index as usize).map_or(index, |&word| word),
        }
    }
}

impl References<'_> {
    /// The numbers behind a reference and the next one, if there are both.
    #[inline(always)]
    pub(crate) fn pair(&self, index: u32) -> Option<(u32, u32)> {
        match self {
            Self::Narrow(halves) if SECOND_FIRST == 0 => {
                let &[first, second] = halves.get(index as usize..)?.first_chunk()?;
                Some((u32::from(first), u32::from(second)))
            }
            Self::Narrow(_) => Some((self.get(index), self.get(index + 1))),
            Self::Wide(words) => {
                let &[first, second] = words.get(index as usize..)?.first_chunk()?;
                Some((first, second))
            }
        }
    }
}

/// What turns around the halves of a word where its upper half comes first in memory.
pub(crate) const SECOND_FIRST: u32 = cfg!(target_endian = "big") as u32;

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
