//! Words into a grid: looked at once, so that nothing can fail later.

use glam::Vec3;

use super::{
    Grid, HEADER_WORDS, MAX_COUNT, MAX_RESOLUTION,
    cells::{Cells, OFFSET, block_words, group, list_words, narrow_offsets, number_words},
    course::Course,
    cover::Frame,
    met::{Met, octants_of},
    options::Form,
};
use crate::{
    accel::{
        Malformed, Reason,
        leaf::{References, SECOND_FIRST},
    },
    asset,
    geometry::Aabb,
};

/// The header as it stands in the words.
pub(super) struct Header {
    pub(super) primitives: u32,
    /// The last offset.
    pub(super) listed: u32,
    /// Offsets before the last.
    pub(super) entries: u32,
    pub(super) form: Form,
    pub(super) resolution: [u32; 3],
    pub(super) bounds: Aabb,
}

impl Header {
    pub(super) fn to_words(&self) -> [u32; HEADER_WORDS] {
        let [x0, y0, z0] = self.bounds.min.to_array().map(f32::to_bits);
        let [x1, y1, z1] = self.bounds.max.to_array().map(f32::to_bits);
        let [nx, ny, nz] = self.resolution;
        let form = match self.form {
            Form::Full => 0,
            Form::Bitmask => 1,
            Form::Octants => 2,
        };
        [self.primitives, self.listed, self.entries, form, nx, ny, nz, x0, y0, z0, x1, y1, z1]
    }

    fn from_words(words: &[u32]) -> Result<Self, (usize, Reason)> {
        let words = words.first_chunk::<HEADER_WORDS>().ok_or((0, Reason::Length))?;
        let &[primitives, listed, entries, form, nx, ny, nz, x0, y0, z0, x1, y1, z1] = words;
        let form = match form {
            0 => Form::Full,
            1 => Form::Bitmask,
            2 => Form::Octants,
            _ => return Err((3, Reason::Header)),
        };
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let bounds = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        Ok(Self { primitives, listed, entries, form, resolution: [nx, ny, nz], bounds })
    }
}

impl<'a> Grid<'a> {
    /// The grid in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each cell at most once, whatever the words say. Whether they
    /// also say the truth about some primitives, only a checksum over both can tell.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let malformed = |(word, reason)| Malformed { structure: asset::Kind::Grid, word, reason };
        let header = Header::from_words(words).map_err(malformed)?;
        let frame = Frame::new(&header.bounds, header.resolution);
        // Clamped where it is out of range.
        let whole = header.resolution.iter().all(|count| (1..=MAX_RESOLUTION).contains(count));
        if !whole || frame.cells() > MAX_COUNT as usize {
            return Err(malformed((4, Reason::Header)));
        }
        let empty = header.primitives == 0 && header.bounds == Aabb::EMPTY;
        if !(header.bounds.is_valid() || empty) {
            return Err(malformed((7, Reason::Bounds)));
        }
        let grid = Self::view(words).ok_or(malformed((0, Reason::Length)))?;
        grid.check_table(&header, frame.cells()).map_err(malformed)?;
        // Numbers are counted from the beginning of each list.
        let is_sound = (0..frame.cells() as u32).filter_map(|cell| grid.cells.of(cell)).all(|references| {
            Met::new(grid.entries, references, 0xff)
                .is_some_and(|mut met| met.all(|primitive| primitive < header.primitives))
        });
        let lists = words.len().saturating_sub(grid.entries.len() / 2);
        if is_sound { Ok(grid) } else { Err(malformed((lists, Reason::Primitive))) }
    }

    /// One pass over blocks and offsets: ranks equal the occupied cells so far, and offsets never fall.
    fn check_table(&self, header: &Header, cells: usize) -> Result<(), (usize, Reason)> {
        let mut rank = 0;
        for (index, block) in self.cells.blocks.iter().enumerate() {
            let [bits, before] = *block;
            // No cells behind the last.
            let rest = cells.saturating_sub(index * 32);
            let beyond = if rest < 32 { bits >> rest } else { 0 };
            if before != rank || beyond != 0 {
                return Err((HEADER_WORDS + index * 2, Reason::Link));
            }
            rank += bits.count_ones();
        }
        let entries = if self.cells.blocks.is_empty() { cells } else { rank as usize };
        if entries != header.entries as usize {
            return Err((2, Reason::Header));
        }
        let (mut least, mut said) = (0, 0);
        for entry in 0..=header.entries {
            let word = self.cells.offsets.get(entry);
            let offset = word & self.cells.mask;
            let first = entry == 0 && offset != 0;
            let last = entry == header.entries && offset != header.listed;
            if first || last || offset < least || offset > header.listed {
                return Err((HEADER_WORDS + self.cells.blocks.len() * 2, Reason::References));
            }
            if header.form == Form::Octants {
                let at = |index: u32| self.entries.get((index ^ SECOND_FIRST) as usize).copied().unwrap_or(0);
                let octants = (least..offset).fold(0, |all, index| all | octants_of(at(index)));
                if octants != said {
                    return Err((HEADER_WORDS + entry as usize, Reason::References));
                }
                said = word >> 24;
            }
            least = offset;
        }
        // The last word has no cell.
        if said == 0 { Ok(()) } else { Err((HEADER_WORDS, Reason::References)) }
    }

    /// The parts of `words` by their header, if the lengths agree.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let header = Header::from_words(words).ok()?;
        let frame = Frame::new(&header.bounds, header.resolution);
        let (count, entries) = (header.listed as usize, header.entries as usize);
        let (_, rest) = words.split_at_checked(HEADER_WORDS)?;
        let (blocks, rest) = rest.split_at_checked(block_words(header.form, frame.cells()))?;
        let narrow = narrow_offsets(header.form, count);
        let (offsets, entries_of) = rest.split_at_checked(number_words(entries.checked_add(1)?, narrow))?;
        let offsets = if narrow { References::narrow(offsets) } else { References::wide(offsets) };
        if entries_of.len() != list_words(header.form, count, header.primitives as usize) {
            return None;
        }
        let mask = if header.form == Form::Octants { OFFSET } else { u32::MAX };
        Some(Self {
            words,
            cells: Cells {
                blocks: blocks.as_chunks().0,
                offsets,
                mask,
                group: group(header.form, header.primitives as usize),
            },
            entries: bytemuck::must_cast_slice(entries_of),
            reference_count: header.listed,
            primitives: header.primitives,
            resolution: header.resolution,
            bounds: header.bounds,
            lattice: frame.lattice,
            course: Course::new(&frame.lattice, &header.bounds),
        })
    }
}
