use core::borrow::Borrow;

use super::node::WIDTH;
use crate::geometry::Triangle;

/// The different corners of a few triangles, by their bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    /// By axis; behind the last corner what no corner is.
    coordinates: [[u32; WIDTH]; 3],
    count: usize,
}

impl Corners {
    /// No corners.
    pub(super) const NONE: Self = Self { coordinates: [[u32::MAX; WIDTH]; 3], count: 0 };

    /// Those of `triangles`; none if they are more than a block has room for.
    pub(super) fn of<T: Borrow<Triangle>>(triangles: impl IntoIterator<Item = T>) -> Option<Self> {
        let mut corners = Self::NONE;
        for triangle in triangles {
            let &Triangle { a, b, c } = triangle.borrow();
            for corner in [a, b, c] {
                corners.add([corner.x.to_bits(), corner.y.to_bits(), corner.z.to_bits()]);
            }
        }
        corners.checked()
    }

    /// The place of a corner, which is added if it is a new one and there is room.
    #[inline(always)]
    pub(super) fn add(&mut self, corner: [u32; 3]) -> usize {
        let [x, y, z] = &self.coordinates;
        let mut found = 0;
        // All places at once: no branches, and one of them at most is the same.
        for place in 0..WIDTH {
            let is_same = (x[place] == corner[0]) & (y[place] == corner[1]) & (z[place] == corner[2]);
            found |= if is_same { place as u32 + 1 } else { 0 };
        }
        let place = if found == 0 { self.count } else { found as usize - 1 };
        // Whole rows, too: what is written by parts and read as a whole has to be waited for.
        for (row, coordinate) in self.coordinates.iter_mut().zip(corner) {
            for (at, word) in row.iter_mut().enumerate() {
                *word = if at == place { coordinate } else { *word };
            }
        }
        self.count += usize::from(found == 0);
        place
    }

    /// If there was room for all.
    fn checked(self) -> Option<Self> {
        (self.count <= WIDTH).then_some(self)
    }

    /// Those of both, if there is room.
    pub(super) fn union(mut self, other: &Self) -> Option<Self> {
        let [x, y, z] = &other.coordinates;
        for place in 0..other.count {
            self.add([x[place], y[place], z[place]]);
        }
        self.checked()
    }

    /// How many there are.
    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// The bits of their coordinates, by axis.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.coordinates.iter().map(|row| &row[..self.count])
    }
}
