use super::{HEADER_WORDS, met::jumps, options::Form};
use crate::accel::leaf::References;

/// The table of cells: where the references of each begin.
///
/// Cells are numbered along z first, then y, then x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells<'a> {
    /// Pairs of words per 32 cells: which of them are occupied, and how many are in the words before; none if each cell
    /// has an offset.
    pub(super) blocks: &'a [[u32; 2]],
    /// Where the references of each cell, or of each occupied one, begin; and where the last ones end.
    pub(super) offsets: References<'a>,
    /// The bits of an offset; above them may be a bit per octant in which there is something.
    pub(super) mask: u32,
    /// Entries per reference, which offsets count; or 1, and they count entries.
    pub(super) group: u32,
}

/// The number of a cell.
#[inline]
pub(super) const fn index([_, ny, nz]: [u32; 3], [x, y, z]: [u32; 3]) -> u32 {
    x.wrapping_mul(ny).wrapping_add(y).wrapping_mul(nz).wrapping_add(z)
}

/// Words of blocks of the bitmask over `cells`.
pub(super) const fn block_words(form: Form, cells: usize) -> usize {
    match form {
        Form::Full | Form::Octants => 0,
        Form::Bitmask => cells.div_ceil(32).saturating_mul(2),
    }
}

/// Words of `count` numbers, each of two bytes if they are `narrow`.
pub(super) const fn number_words(count: usize, narrow: bool) -> usize {
    if narrow { count.div_ceil(2) } else { count }
}

/// Whether offsets up to `references` take two bytes.
pub(super) const fn narrow_offsets(form: Form, references: usize) -> bool {
    references <= u16::MAX as usize && !matches!(form, Form::Octants)
}

/// The bits of an offset in a word with octants.
pub(super) const OFFSET: u32 = 0x00ff_ffff;

/// Whether numbers of primitives take two bytes.
pub(super) const fn narrow_references(primitives: usize) -> bool {
    primitives <= 1 << 16
}

/// Words of a whole grid whose last offset is `listed`.
pub(super) const fn size(form: Form, primitives: usize, cells: usize, occupied: usize, listed: usize) -> usize {
    let entries = match form {
        Form::Full | Form::Octants => cells,
        Form::Bitmask => occupied,
    };
    let offsets = number_words(entries.saturating_add(1), narrow_offsets(form, listed));
    (HEADER_WORDS + block_words(form, cells))
        .saturating_add(offsets)
        .saturating_add(list_words(form, listed, primitives))
}

/// Entries that offsets count as one.
pub(super) const fn group(form: Form, primitives: usize) -> u32 {
    if matches!(form, Form::Full) { jumps(primitives) + 1 } else { 1 }
}

/// Words of lists whose last offset is `listed`.
pub(super) const fn list_words(form: Form, listed: usize, primitives: usize) -> usize {
    listed.saturating_mul(group(form, primitives) as usize).div_ceil(2)
}

/// Words of numbers with their octants, before they are packed.
pub(super) const fn reference_words(references: usize, primitives: usize) -> usize {
    number_words(references, narrow_references(primitives)).saturating_add(references.div_ceil(4))
}

impl Cells<'_> {
    /// No cells.
    pub(super) const NONE: Self = Self { blocks: &[], offsets: References::IDENTITY, mask: u32::MAX, group: 1 };

    /// The first entry of a cell and the one behind its last, if there are any.
    #[inline(always)]
    pub(super) fn of(&self, cell: u32) -> Option<(u32, u32)> {
        let entry = if self.blocks.is_empty() { cell } else { self.rank(cell)? };
        let (first, end) = self.offsets.pair(entry)?;
        let [first, end] = [first, end].map(|offset| (offset & self.mask).wrapping_mul(self.group));
        (first < end).then_some((first, end))
    }

    /// How many occupied cells there are before an occupied one.
    #[inline(always)]
    pub(super) fn rank(&self, cell: u32) -> Option<u32> {
        let &[bits, before] = self.blocks.get((cell >> 5) as usize)?;
        let bit = 1 << (cell & 31);
        if bits & bit == 0 {
            return None;
        }
        Some(before.wrapping_add((bits & (bit - 1)).count_ones()))
    }
}
