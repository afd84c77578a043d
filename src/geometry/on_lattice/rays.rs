use glam::Vec3;

use super::{LatticeRay, LatticeSpace, space::Planes};

/// The rays of a row of pixels, left to right: see [`LatticeSpace::rays`].
///
/// None in place of those that miss the lattice.
#[derive(Clone, Debug)]
pub struct LatticeRays<'s> {
    pub(super) space: &'s LatticeSpace,
    pub(super) count: u32,
    pub(super) origin: Vec3,
    pub(super) start: Planes,
    pub(super) speed: Planes,
    /// In the unit of the speed.
    pub(super) step: [i32; 3],
}

impl Iterator for LatticeRays<'_> {
    type Item = Option<LatticeRay>;

    fn next(&mut self) -> Option<Option<LatticeRay>> {
        self.count = self.count.checked_sub(1)?;
        let ray = self.space.first_hits(self.origin, &self.start, &self.speed);
        let ([x, y, z], [dx, dy, dz]) = (self.speed.along, self.step);
        self.speed.along = [x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz)];
        Some(ray)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count as usize, Some(self.count as usize))
    }
}

impl ExactSizeIterator for LatticeRays<'_> {}
