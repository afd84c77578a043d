use crate::accel::leaf::References;

/// The primitives of a cell that are in an octant of it that the ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Met<'a> {
    next: u32,
    end: u32,
    references: References<'a>,
    octants: &'a [u8],
    /// A bit per octant that the ray meets.
    on_the_way: u32,
}

/// What turns around the bytes of a word where its upper ones come first in memory.
const FOURTH_FIRST: u32 = if cfg!(target_endian = "big") { 3 } else { 0 };

/// In which octants of its cell a reference is.
#[inline(always)]
pub(super) fn octants_of(octants: &[u8], reference: u32) -> Option<u32> {
    octants.get((reference ^ FOURTH_FIRST) as usize).map(|&octants| octants.into())
}

impl<'a> Met<'a> {
    /// Those of the references from `first` up to `end` that share a bit with `on_the_way`.
    #[inline(always)]
    pub(super) const fn new(
        references: References<'a>,
        octants: &'a [u8],
        first: u32,
        end: u32,
        on_the_way: u32,
    ) -> Self {
        Self { next: first, end, references, octants, on_the_way }
    }

    /// Those of the references from `first` up to `end` that share a bit with `on_the_way`, if there are any.
    #[inline(always)]
    pub(super) fn of(
        references: References<'a>,
        octants: &'a [u8],
        first: u32,
        end: u32,
        on_the_way: u32,
    ) -> Option<Self> {
        let mut met = Self::new(references, octants, first, end, on_the_way);
        met.next = met.ahead()?;
        Some(met)
    }

    /// The next reference, if there is one.
    #[inline(always)]
    fn ahead(&self) -> Option<u32> {
        let mut next = self.next;
        while next < self.end {
            if octants_of(self.octants, next)? & self.on_the_way != 0 {
                return Some(next);
            }
            next += 1;
        }
        None
    }
}

impl Iterator for Met<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        let index = self.ahead()?;
        self.next = index + 1;
        Some(self.references.get(index))
    }
}
