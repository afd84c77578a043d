//! What a cell names: a list of entries of 16 bits, of which most are a primitive each.
//!
//! An entry has octants of the cell above, in which the primitive is, and what is to be added to the last number below. One
//! with all octants and the highest bit of what is below is a jump: the last number becomes the 7 bits below that, of jumps in a
//! row the first ones above the others, and 7 bits that are zero.

use crate::accel::leaf::SECOND_FIRST;

/// Jumps are no less.
const JUMP: u32 = 0xff80;

/// How many jumps lead to all numbers below `primitives`.
pub(super) const fn jumps(primitives: usize) -> u32 {
    if primitives <= 1 << 14 {
        1
    } else if primitives <= 1 << 21 {
        2
    } else {
        3
    }
}

/// Gives `emit` the entries of a primitive by so many jumps, wherever it stands.
pub(super) fn far(number: u32, octants: u32, jumps: u32, mut emit: impl FnMut(u32)) {
    for jump in (1..=jumps).rev() {
        emit(JUMP | number >> (7 * jump) & 0x7f);
    }
    emit(octants << 8 | number & 0x7f);
}

/// Gives `emit` the entries of primitives, whose numbers rise.
pub(super) fn pack(primitives: impl Iterator<Item = (u32, u32)>, mut emit: impl FnMut(u32)) {
    let mut last = 0;
    for (number, octants) in primitives {
        let step = number.wrapping_sub(last);
        let entry = octants << 8 | step;
        if step <= 0xff && entry < JUMP {
            emit(entry);
        } else {
            far(number, octants, jumps(number as usize + 1), &mut emit);
        }
        last = number;
    }
}

/// The octants of an entry.
pub(super) const fn octants_of(entry: u16) -> u32 {
    let entry = entry as u32;
    if entry < JUMP { entry >> 8 } else { 0 }
}

/// The primitives of a cell that are in an octant of it that the ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Met<'a> {
    /// The entries of all cells, or of those up to this one.
    entries: &'a [u16],
    next: u32,
    /// Elsewhere the entries end there: a word less to be stored for each cell.
    #[cfg(target_endian = "big")]
    end: u32,
    number: u32,
    /// A bit per octant that the ray meets, where entries have theirs: along x they count 4, along y 2, along z 1.
    on_the_way: u32,
}

impl<'a> Met<'a> {
    /// Those of the entries from `first` up to `end`, if there are such, that share a bit with `on_the_way`.
    #[inline(always)]
    pub(super) fn new(entries: &'a [u16], (first, end): (u32, u32), on_the_way: u32) -> Option<Self> {
        // One comparison for each entry is then enough for both ends.
        let entries = if SECOND_FIRST == 0 { entries.get(..end as usize)? } else { entries };
        Some(Self {
            entries,
            next: first,
            #[cfg(target_endian = "big")]
            end,
            number: 0,
            on_the_way: on_the_way << 8,
        })
    }

    /// None.
    pub(super) const NOTHING: Self = Self {
        entries: &[],
        next: 0,
        #[cfg(target_endian = "big")]
        end: 0,
        number: 0,
        on_the_way: 0,
    };

    /// The next entry.
    #[inline(always)]
    fn entry(&mut self) -> Option<u32> {
        #[cfg(target_endian = "big")]
        if self.next >= self.end {
            return None;
        }
        let &entry = self.entries.get((self.next ^ SECOND_FIRST) as usize)?;
        self.next += 1;
        Some(entry.into())
    }
}

impl Iterator for Met<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        loop {
            let mut entry = self.entry()?;
            if entry >= JUMP {
                self.number = 0;
                while entry >= JUMP {
                    self.number = (self.number | entry & 0x7f) << 7;
                    entry = self.entry()?;
                }
            }
            self.number = self.number.wrapping_add(entry & 0xff);
            if entry & self.on_the_way != 0 {
                return Some(self.number);
            }
        }
    }
}
