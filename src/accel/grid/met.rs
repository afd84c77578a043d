use crate::accel::leaf::{References, SECOND_FIRST};

/// What the cells of a grid name, cell by cell.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lists<'a> {
    /// Numbers, and for each a byte: in which octants of the cell the primitive is. Along x it counts 4, along y 2, along z 1.
    Plain(References<'a>, &'a [u8]),
    /// See [`pack`].
    Packed(&'a [u16]),
}

/// The octants that an entry of a packed list cannot have: it is a jump, and what is to be added stands 8 bits higher, or
/// more if further jumps follow.
const JUMP: u32 = 0xff00;

/// Gives `emit` a cell's primitives, which ascend, with their octants as entries of 16 bits: octants above what is added to
/// the last number, which is 0 at first.
pub(super) fn pack(references: impl Iterator<Item = (u32, u32)>, mut emit: impl FnMut(u32)) {
    let mut last = 0;
    for (number, octants) in references {
        let step = number.wrapping_sub(last);
        last = number;
        for shift in [24, 16, 8] {
            if step >> shift != 0 {
                emit(JUMP | step >> shift & 0xff);
            }
        }
        let step = step & 0xff;
        if octants == 0xff {
            emit(0xf000 | step);
            emit(0x0f00);
        } else {
            emit(octants << 8 | step);
        }
    }
}

/// The primitives of a cell that are in an octant of it that the ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Met<'a> {
    next: u32,
    end: u32,
    lists: Lists<'a>,
    /// The last number of a packed list.
    number: u32,
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
    /// Those of the entries from `first` up to `end` that share a bit with `on_the_way`.
    #[inline(always)]
    pub(super) fn new(lists: Lists<'a>, first: u32, end: u32, on_the_way: u32) -> Self {
        Self { next: first, end, lists, number: 0, on_the_way }
    }

    /// The next entry of a packed list.
    #[inline(always)]
    fn entry(&self, list: &[u16]) -> Option<u32> {
        if self.next < self.end {
            list.get((self.next ^ SECOND_FIRST) as usize).map(|&entry| entry.into())
        } else {
            None
        }
    }
}

impl Iterator for Met<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        match self.lists {
            Lists::Plain(references, octants) => {
                while self.next < self.end {
                    let index = self.next;
                    self.next += 1;
                    if octants_of(octants, index)? & self.on_the_way != 0 {
                        return Some(references.get(index));
                    }
                }
                None
            }
            Lists::Packed(list) => loop {
                let entry = self.entry(list)?;
                self.next += 1;
                if entry >> 8 & self.on_the_way == 0 {
                    self.number = self.number.wrapping_add(entry & 0xff);
                } else if entry < JUMP {
                    self.number = self.number.wrapping_add(entry & 0xff);
                    return Some(self.number);
                } else {
                    let mut far = entry & 0xff;
                    while let Some(entry) = self.entry(list).filter(|&entry| entry >= JUMP) {
                        self.next += 1;
                        far = far << 8 | entry & 0xff;
                    }
                    self.number = self.number.wrapping_add(far << 8);
                }
            },
        }
    }
}
