use crate::geometry::LatticePath;

/// A node, and the depths between which a ray is in its cell, in whole planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LatticeSegment {
    pub(crate) node: u32,
    pub(crate) enter: i32,
    pub(crate) exit: i32,
}

impl LatticeSegment {
    /// The first node, and the part of the path that is in the lattice.
    #[inline(always)]
    pub(crate) fn whole(path: &impl LatticePath) -> Self {
        let (enter, exit) = path.inside();
        Self { node: 0, enter: i32::from(enter), exit: i32::from(exit) }
    }
}

/// Segments that wait, the nearest on top, in 8 bytes each: depths in the lattice take 16 bits.
#[derive(Clone, Debug)]
pub(crate) struct LatticeWaiting<const N: usize>(heapless::Vec<[u32; 2], N>);

impl<const N: usize> LatticeWaiting<N> {
    /// None. Not filled where it is made, so that it is made where it stays: to move it would take as long as ten nodes.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self(heapless::Vec::new())
    }

    /// Puts one on top; it cannot fail, because no tree is deeper than its stack.
    #[inline(always)]
    pub(crate) fn push(&mut self, node: u32, enter: i32, exit: i32) {
        let _ = self.0.push([node, (enter as u32) << 16 | exit as u32]);
    }

    /// The nearest that begins before the ray is deeper than `end`.
    #[inline(always)]
    pub(crate) fn pop(&mut self, end: i32) -> Option<LatticeSegment> {
        loop {
            let [node, depths] = self.0.pop()?;
            let enter = (depths >> 16) as i32;
            if enter <= end {
                return Some(LatticeSegment { node, enter, exit: (depths & 0xffff) as i32 });
            }
        }
    }
}
