//! The builder: count the references of each cell, sum the counts, and fill in the references from behind.
//!
//! ```text
//! | header | blocks, if a bitmask | a count per cell, later where its references begin | references | octants |
//! ```
//!
//! At the end the offsets are made narrow, or fewer, where they stand, and the references moved up to them.

use super::{
    HEADER_WORDS, MAX_COUNT,
    cells::{block_words, narrow_offsets, narrow_references, number_words, reference_words},
    cover::Frame,
    open::Header,
    options::{Form, Options},
    resolution::resolution,
};
use crate::{
    arena::Full,
    error::BuildError,
    geometry::Aabb,
    math,
    primitives::{Primitives, bounds_of},
};

pub(super) use super::cells::size;

/// See [`Grid::words`](super::Grid::words).
pub(super) const fn words(primitives: usize, options: &Options) -> usize {
    let cells = options.cells(primitives) as usize;
    let body = match options.bytes(primitives) {
        // As many as can be told: a quarter of that could be had.
        usize::MAX => usize::MAX,
        bytes => bytes.div_ceil(4),
    };
    (HEADER_WORDS + 1 + cells + block_words(options.form, cells)).saturating_add(body)
}

/// Writes a grid over `primitives` to the front of `words`; how many it took.
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    if count > MAX_COUNT {
        return Err(BuildError::TooMany { limit: MAX_COUNT });
    }
    let allowed = options.bytes(count as usize);
    let at_least = options.least_bytes(count as usize);
    if allowed < at_least {
        return Err(BuildError::Budget { at_least, allowed });
    }
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let cells = options.cells(count as usize);
    let frame = Frame::new(&bounds, resolution(&bounds, cells));
    let mut builder = Builder { primitives, options, allowed, bounds, words, frame, references: 0 };
    if !builder.count(cells)? {
        // The greatest density with which it fits; with a single cell it does.
        let (mut fits, mut exceeds) = (1.0, cells as f32);
        for _ in 0..6 {
            let cells = math::sqrt(fits * exceeds);
            *(if builder.count(cells as u32)? { &mut fits } else { &mut exceeds }) = cells;
        }
        builder.count(fits as u32)?;
    }
    Ok(builder.finish())
}

struct Builder<'w, 'p, P: ?Sized> {
    primitives: &'p P,
    options: &'p Options,
    allowed: usize,
    bounds: Aabb,
    words: &'w mut [u32],
    frame: Frame,
    references: usize,
}

impl<P: Primitives + ?Sized> Builder<'_, '_, P> {
    /// Where the counts of the cells stand, and behind them the references.
    const fn table(&self) -> usize {
        HEADER_WORDS + block_words(self.options.form, self.frame.cells())
    }

    /// Makes sure that there is room for the table and so many references.
    fn reserve(&self, references: usize) -> Result<(), Full> {
        let references = reference_words(references, self.primitives.len() as usize);
        let at_least = self.table() + self.frame.cells() + 1 + references;
        let available = self.words.len();
        if at_least <= available { Ok(()) } else { Err(Full { at_least, available }) }
    }

    /// Counts the references of each of at most so many cells; whether the grid is then within the bytes allowed.
    fn count(&mut self, cells: u32) -> Result<bool, Full> {
        self.frame = Frame::new(&self.bounds, resolution(&self.bounds, cells));
        self.reserve(0)?;
        // More do not fit, whatever else there is: a number takes two bytes or four, its octants take one.
        let most = self.allowed / if narrow_references(self.primitives.len() as usize) { 3 } else { 5 };
        let (frame, clip, first) = (&self.frame, self.options.clip, self.table());
        let cells = frame.cells();
        let table = self.words.get_mut(first..=first + cells).unwrap_or_default();
        table.fill(0);
        let mut references = 0;
        for primitive in 0..self.primitives.len() {
            let fits = frame.cover(self.primitives, primitive, clip, |cell, _| {
                references += 1;
                if let Some(count) = table.get_mut(cell as usize) {
                    *count += 1;
                }
                references <= most
            });
            if !fits {
                return Ok(false);
            }
        }
        let occupied = table.iter().filter(|&&count| count > 0).count();
        let size = size(self.options.form, self.primitives.len() as usize, cells, occupied, references);
        if size.saturating_mul(4) > self.allowed {
            return Ok(false);
        }
        self.references = references;
        self.reserve(references)?;
        Ok(true)
    }

    /// Fills in the references and makes everything small; the length of all.
    fn finish(mut self) -> usize {
        self.fill();
        let (entries, end) = self.pack();
        let header = Header {
            primitives: self.primitives.len(),
            references: self.references as u32,
            entries,
            form: self.options.form,
            resolution: self.frame.resolution,
            bounds: self.bounds,
        };
        for (place, word) in self.words.iter_mut().zip(header.to_words()) {
            *place = word;
        }
        end
    }

    /// Counts become ends and, reference by reference, beginnings.
    fn fill(&mut self) {
        let (frame, clip) = (&self.frame, self.options.clip);
        let narrow = narrow_references(self.primitives.len() as usize);
        let (first, cells) = (self.table(), frame.cells());
        let (_, body) = self.words.split_at_mut_checked(first).unwrap_or_default();
        let (table, references) = body.split_at_mut_checked(cells + 1).unwrap_or_default();
        let mut sum = 0;
        for count in table.iter_mut() {
            sum += *count;
            *count = sum;
        }
        let used = reference_words(self.references, self.primitives.len() as usize);
        references.iter_mut().take(used).for_each(|word| *word = 0);
        let numbers = number_words(self.references, narrow);
        let (references, octants) = references.split_at_mut_checked(numbers).unwrap_or_default();
        for primitive in (0..self.primitives.len()).rev() {
            frame.cover(self.primitives, primitive, clip, |cell, bits| {
                if let Some(end) = table.get_mut(cell as usize) {
                    *end = end.wrapping_sub(1);
                    put(references, *end as usize, primitive, narrow);
                    if let Some(word) = octants.get_mut(*end as usize / 4) {
                        *word |= bits << (*end % 4 * 8);
                    }
                }
                true
            });
        }
    }

    /// Writes the blocks, brings the offsets into their final form and the references behind them; how many offsets there
    /// are before the last, and the length of all.
    fn pack(&mut self) -> (u32, usize) {
        let narrow = narrow_offsets(self.references);
        let (table, cells) = (self.table(), self.frame.cells());
        let (front, body) = self.words.split_at_mut_checked(table).unwrap_or_default();
        let (_, blocks) = front.split_at_mut_checked(HEADER_WORDS).unwrap_or_default();
        let mut entries = 0;
        // An entry never stands behind the cell that it is of, so that no offset is overwritten before it is read.
        let mut next = body.first().copied().unwrap_or(0);
        for cell in 0..cells {
            let begin = next;
            next = body.get(cell + 1).copied().unwrap_or(0);
            if self.options.form == Form::Bitmask {
                if cell % 32 == 0 {
                    put(blocks, cell / 32 * 2, 0, false);
                    put(blocks, cell / 32 * 2 + 1, entries as u32, false);
                }
                if begin == next {
                    continue;
                }
                if let Some(bits) = blocks.get_mut(cell / 32 * 2) {
                    *bits |= 1 << (cell % 32);
                }
            }
            append(body, entries, begin, narrow);
            entries += 1;
        }
        append(body, entries, next, narrow);

        let offsets = number_words(entries + 1, narrow);
        let references = reference_words(self.references, self.primitives.len() as usize);
        for index in 0..references {
            let word = body.get(cells + 1 + index).copied().unwrap_or(0);
            put(body, offsets + index, word, false);
        }
        (entries as u32, table + offsets + references)
    }
}

/// Sets a number; where there are two in a word, it was 0.
fn put(words: &mut [u32], index: usize, number: u32, narrow: bool) {
    if let Some(word) = words.get_mut(if narrow { index / 2 } else { index }) {
        *word = if narrow { *word | number << (16 * (index % 2)) } else { number };
    }
}

/// Sets a number behind all others: the first of two in a word replaces what was there.
fn append(words: &mut [u32], index: usize, number: u32, narrow: bool) {
    if narrow && index.is_multiple_of(2) {
        put(words, index / 2, number, false);
    } else {
        put(words, index, number, narrow);
    }
}
