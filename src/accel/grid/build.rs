//! The builder: count the references of each cell, sum the counts, and fill in the references from behind.
//!
//! ```text
//! | header | blocks, if a bitmask | a count per cell, later where its references begin | references | octants | lists |
//! ```
//!
//! At the end the offsets are made narrow, or fewer, where they stand, and the references moved up to them.

use super::{
    HEADER_WORDS, MAX_COUNT,
    cells::{OFFSET, block_words, group, list_words, narrow_offsets, narrow_references, number_words, reference_words},
    cover::Frame,
    met,
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
    let most = most_references(options.form, primitives, options.bytes(primitives));
    let narrow = narrow_offsets(options.form, most);
    let scratch = match options.form {
        // The counts become the offsets.
        Form::Full if narrow => 0,
        Form::Full => number_words(cells + 1, narrow),
        // Lists are packed beside what they are made of.
        Form::Octants => reference_words(most, primitives),
        Form::Bitmask => number_words(cells + 1, narrow).saturating_add(reference_words(most, primitives)),
    };
    body.saturating_add(scratch)
}

/// How many references certainly do not fit if there are more: an entry takes two bytes.
const fn most_references(form: Form, primitives: usize, bytes: usize) -> usize {
    let most = bytes / (2 * group(form, primitives) as usize);
    if matches!(form, Form::Octants) && most > OFFSET as usize { OFFSET as usize } else { most }
}

/// Writes a grid over `primitives` to the front of `words`; how many it took.
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    let limit = if options.form == Form::Octants { OFFSET } else { MAX_COUNT };
    if count > limit {
        return Err(BuildError::TooMany { limit });
    }
    let allowed = options.bytes(count as usize);
    let at_least = options.least_bytes(count as usize);
    if allowed < at_least {
        return Err(BuildError::Budget { at_least, allowed });
    }
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let cells = options.cells(count as usize);
    let frame = Frame::new(&bounds, resolution(&bounds, cells));
    let most = most_references(options.form, count as usize, allowed);
    let narrow = narrow_offsets(options.form, most);
    let mut builder =
        Builder { primitives, options, allowed, most, narrow, bounds, words, frame, references: 0, listed: 0 };
    // Without cuts to be made, counting is as quick as an estimate.
    let hopeless = options.clip && !builder.estimate(cells, 2);
    if hopeless || !builder.count(cells)? {
        // About the greatest density with which it fits, by an estimate that cuts nothing; with a single cell it does.
        let (mut fits, mut exceeds) = (1.0, cells as f32);
        for _ in 0..8 {
            let cells = math::sqrt(fits * exceeds);
            *(if builder.estimate(cells as u32, 1) { &mut fits } else { &mut exceeds }) = cells;
        }
        while !builder.count(fits as u32)? {
            fits = math::greatest(fits * 0.6, 1.0);
        }
    }
    Ok(builder.finish())
}

struct Builder<'w, 'p, P: ?Sized> {
    primitives: &'p P,
    options: &'p Options,
    allowed: usize,
    /// More references do not fit.
    most: usize,
    /// Whether the counts take two bytes.
    narrow: bool,
    bounds: Aabb,
    words: &'w mut [u32],
    frame: Frame,
    references: usize,
    /// Entries of all lists.
    listed: usize,
}

impl<P: Primitives + ?Sized> Builder<'_, '_, P> {
    /// Where the counts of the cells stand, and behind them the references.
    const fn table(&self) -> usize {
        HEADER_WORDS + block_words(self.options.form, self.frame.cells())
    }

    /// Makes sure that there is room for the table and so many references.
    fn reserve(&self, references: usize) -> Result<(), Full> {
        let at_least = self.table() + number_words(self.frame.cells() + 1, self.narrow) + self.unpacked(references);
        let available = self.words.len();
        if at_least <= available { Ok(()) } else { Err(Full { at_least, available }) }
    }

    /// Words of so many references as they are filled in.
    fn unpacked(&self, references: usize) -> usize {
        let primitives = self.primitives.len() as usize;
        match self.options.form {
            Form::Full => list_words(Form::Full, references, primitives),
            Form::Octants | Form::Bitmask => reference_words(references, primitives),
        }
    }

    /// Whether a grid of at most so many cells should be within so many times the bytes allowed.
    fn estimate(&self, cells: u32, times: usize) -> bool {
        let frame = Frame::new(&self.bounds, resolution(&self.bounds, cells));
        let (mut references, primitives) = (0_usize, self.primitives.len());
        for primitive in 0..primitives {
            let clip = self.options.clip && self.primitives.is_certified(primitive);
            references = references.saturating_add(frame.estimate(&self.primitives.bounds(primitive), clip));
        }
        let occupied = frame.cells().min(references);
        // Some entries are jumps.
        let jumps = if self.options.form == Form::Full { 0 } else { references / 8 };
        let listed = references.saturating_add(jumps);
        let size = size(self.options.form, primitives as usize, frame.cells(), occupied, listed);
        size.saturating_mul(4) <= self.allowed.saturating_mul(times)
    }

    /// Counts and fills in the references of each of at most so many cells; whether the grid is then within the bytes allowed.
    fn count(&mut self, cells: u32) -> Result<bool, Full> {
        self.frame = Frame::new(&self.bounds, resolution(&self.bounds, cells));
        let (frame, clip, first, narrow) = (&self.frame, self.options.clip, self.table(), self.narrow);
        let (cells, primitives) = (frame.cells(), self.primitives.len() as usize);
        if size(self.options.form, primitives, cells, 0, 0).saturating_mul(4) > self.allowed {
            return Ok(false);
        }
        self.reserve(0)?;
        let table = self.words.get_mut(first..first + number_words(cells + 1, narrow)).unwrap_or_default();
        table.fill(0);
        let mut references = 0;
        for primitive in 0..self.primitives.len() {
            let fits = frame.cover(self.primitives, primitive, clip, |cell, _| {
                references += 1;
                let cell = cell as usize;
                if let Some(word) = table.get_mut(if narrow { cell / 2 } else { cell }) {
                    *word = word.wrapping_add(if narrow { 1 << (16 * (cell % 2)) } else { 1 });
                }
                references <= self.most
            });
            if !fits {
                return Ok(false);
            }
        }
        let occupied = (0..cells).filter(|&cell| get(table, cell, narrow) > 0).count();
        let fits =
            |listed| size(self.options.form, primitives, cells, occupied, listed).saturating_mul(4) <= self.allowed;
        if !fits(references) {
            return Ok(false);
        }
        self.reserve(references)?;
        (self.references, self.listed) = (references, references);
        self.fill();
        if self.options.form == Form::Full {
            return Ok(true);
        }
        self.list();
        let size = size(self.options.form, primitives, cells, occupied, self.listed);
        if self.listed > self.most || size.saturating_mul(4) > self.allowed {
            return Ok(false);
        }
        let (at_least, available) = (first + self.lists() + self.listed.div_ceil(2), self.words.len());
        if at_least <= available { Ok(true) } else { Err(Full { at_least, available }) }
    }

    /// Where the final lists stand, after the beginning of the table.
    fn lists(&self) -> usize {
        let table = number_words(self.frame.cells() + 1, self.narrow);
        match self.options.form {
            Form::Full => table,
            Form::Octants | Form::Bitmask => table + self.unpacked(self.references),
        }
    }

    /// Packs the references of all cells behind them, as far as there is room; the table then says where the entries begin.
    fn list(&mut self) {
        let (narrow, first, lists, cells) = (self.narrow, self.table(), self.lists(), self.frame.cells());
        let narrow_numbers = narrow_references(self.primitives.len() as usize);
        let (_, body) = self.words.split_at_mut_checked(first).unwrap_or_default();
        let (body, packed) = body.split_at_mut_checked(lists).unwrap_or_default();
        let (table, references) = body.split_at_mut_checked(number_words(cells + 1, narrow)).unwrap_or_default();
        let numbers = number_words(self.references, narrow_numbers);
        let has_octants = self.options.form == Form::Octants;
        let (mut listed, mut next) = (0, get(table, 0, narrow));
        for cell in 0..cells {
            let begin = next;
            next = get(table, cell + 1, narrow);
            let reference =
                |index| (get(references, index as usize, narrow_numbers), octants(references, numbers, index));
            let of_cell = (begin..next).map(reference);
            let octants = if has_octants { of_cell.clone().fold(0, |all, (_, octants)| all | octants) } else { 0 };
            set(table, cell, octants << 24 | listed as u32, narrow);
            met::pack(of_cell, |entry| {
                set(packed, listed, entry, true);
                listed += 1;
            });
        }
        set(table, cells, listed as u32, narrow);
        set(packed, listed, 0, true);
        self.listed = listed;
    }

    /// Makes everything small; the length of all.
    fn finish(mut self) -> usize {
        let (entries, end) = self.pack();
        let header = Header {
            primitives: self.primitives.len(),
            listed: self.listed as u32,
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
        let (is_full, count) = (self.options.form == Form::Full, self.primitives.len() as usize);
        let (narrow, narrow_numbers) = (self.narrow, narrow_references(count));
        let (first, cells, used) = (self.table(), frame.cells(), self.unpacked(self.references));
        let (_, body) = self.words.split_at_mut_checked(first).unwrap_or_default();
        let (table, references) = body.split_at_mut_checked(number_words(cells + 1, narrow)).unwrap_or_default();
        let mut sum = 0;
        for cell in 0..=cells {
            sum += get(table, cell, narrow);
            set(table, cell, sum, narrow);
        }
        references.iter_mut().take(used).for_each(|word| *word = 0);
        let numbers = if is_full { used } else { number_words(self.references, narrow_numbers) };
        let (references, octants) = references.split_at_mut_checked(numbers).unwrap_or_default();
        let (jumps, group) = (met::jumps(count), group(Form::Full, count));
        for primitive in (0..self.primitives.len()).rev() {
            frame.cover(self.primitives, primitive, clip, |cell, bits| {
                let end = get(table, cell as usize, narrow).wrapping_sub(1);
                set(table, cell as usize, end, narrow);
                if is_full {
                    let mut place = end.wrapping_mul(group) as usize;
                    met::far(primitive, bits, jumps, |entry| {
                        set(references, place, entry, true);
                        place += 1;
                    });
                } else {
                    set(references, end as usize, primitive, narrow_numbers);
                    if let Some(word) = octants.get_mut(end as usize / 4) {
                        *word |= bits << (end % 4 * 8);
                    }
                }
                true
            });
        }
    }

    /// Writes the blocks, brings the offsets into their final form and the references behind them; how many offsets there
    /// are before the last, and the length of all.
    fn pack(&mut self) -> (u32, usize) {
        let (counts, narrow) = (self.narrow, narrow_offsets(self.options.form, self.listed));
        let lists = self.lists();
        let (table, cells) = (self.table(), self.frame.cells());
        let (front, body) = self.words.split_at_mut_checked(table).unwrap_or_default();
        let (_, blocks) = front.split_at_mut_checked(HEADER_WORDS).unwrap_or_default();
        let mut entries = 0;
        // An entry never stands behind the cell that it is of, so that no offset is overwritten before it is read.
        let mut next = get(body, 0, counts);
        for cell in 0..cells {
            let begin = next;
            next = get(body, cell + 1, counts);
            if self.options.form == Form::Bitmask {
                if cell % 32 == 0 {
                    set(blocks, cell / 32 * 2, 0, false);
                    set(blocks, cell / 32 * 2 + 1, entries as u32, false);
                }
                if begin == next {
                    continue;
                }
                if let Some(bits) = blocks.get_mut(cell / 32 * 2) {
                    *bits |= 1 << (cell % 32);
                }
            }
            set(body, entries, begin, narrow);
            entries += 1;
        }
        set(body, entries, next, narrow);
        if narrow && entries.is_multiple_of(2) {
            // Nothing is left of what stood in the other half.
            set(body, entries + 1, 0, narrow);
        }

        let to = number_words(entries + 1, narrow);
        let length = list_words(self.options.form, self.listed, self.primitives.len() as usize);
        for index in 0..length {
            let word = get(body, lists + index, false);
            set(body, to + index, word, false);
        }
        (entries as u32, table + to + length)
    }
}

/// The octants of a reference, where those of the first stand in the word `first`.
fn octants(words: &[u32], first: usize, index: u32) -> u32 {
    get(words, first + index as usize / 4, false) >> (index % 4 * 8) & 0xff
}

/// A number; there are two in a word if they are `narrow`.
fn get(words: &[u32], index: usize, narrow: bool) -> u32 {
    match words.get(if narrow { index / 2 } else { index }) {
        Some(word) if narrow => word >> (16 * (index % 2)) & 0xffff,
        Some(word) => *word,
        None => 0,
    }
}

/// Sets a number.
fn set(words: &mut [u32], index: usize, number: u32, narrow: bool) {
    if let Some(word) = words.get_mut(if narrow { index / 2 } else { index }) {
        let shift = 16 * (index % 2);
        *word = if narrow { *word & !(0xffff << shift) | number << shift } else { number };
    }
}
