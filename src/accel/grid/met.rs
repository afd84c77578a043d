use crate::accel::leaf::References;

/// The primitives of a cell that are in an octant of it that the ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Met<'a> {
    next: u32,
    end: u32,
    references: References<'a>,
    octants: &'a [u32],
    /// A bit per octant that the ray meets.
    on_the_way: u32,
}

impl<'a> Met<'a> {
    /// `count` references from the one at `first`, as far as they share a bit with `on_the_way`.
    #[inline(always)]
    pub(super) const fn of(
        references: References<'a>,
        octants: &'a [u32],
        first: u32,
        count: u32,
        on_the_way: u32,
    ) -> Self {
        Self { next: first, end: first.saturating_add(count), references, octants, on_the_way }
    }
}

impl Iterator for Met<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        while self.next < self.end {
            let index = self.next;
            self.next += 1;
            let octants = self.octants.get(index as usize / 4).map_or(0, |word| word >> (index % 4 * 8));
            if octants & self.on_the_way != 0 {
                return Some(self.references.get(index));
            }
        }
        None
    }
}
