//! The grid over primitives in the order of its cells.

use core::iter;

use super::{
    Grid,
    cells::{narrow_references, number_words},
};

impl<'a> Grid<'a> {
    /// The primitives in the order of the cells, each as often as cells name it.
    pub fn order(&self) -> impl ExactSizeIterator<Item = u32> + use<'a> {
        let references = self.references;
        (0..self.reference_count as usize).map(move |index| references.get(index as u32))
    }

    /// Whether it is over primitives in the order of the cells, and so holds no references: each cell is a range.
    #[must_use]
    pub const fn is_ordered(&self) -> bool {
        self.references.is_identity()
    }

    /// The words of the same grid over what the caller has put into [`order`](Self::order): without references.
    pub fn ordered_words(&self) -> impl Iterator<Item = u32> + use<'a> {
        let count = self.reference_count as usize;
        let references =
            if self.is_ordered() { 0 } else { number_words(count, narrow_references(self.primitives as usize)) };
        let octants = self.words.len().saturating_sub(count.div_ceil(4));
        // The first word says how many primitives there are.
        let table = self.words.iter().take(octants.saturating_sub(references)).skip(1);
        iter::once(self.reference_count).chain(table.chain(self.words.iter().skip(octants)).copied())
    }
}
