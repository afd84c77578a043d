use super::{Aabb, Axis};

/// Equally spaced planes over a box, numbered along each axis: coordinates in 16 bits and less.
///
/// Plane 0 does not lie above the box's least coordinate and the last one not below its greatest, so that a box rounded
/// outward to planes contains what it contained. A plane is the same `f32` wherever it is computed, and never lies below
/// one of a lower number.
///
/// ```
/// use hitscan::{geometry::{Aabb, Axis, Lattice}, glam::Vec3};
/// let lattice = Lattice::over(&Aabb::new(Vec3::ZERO, Vec3::splat(10.0)), [10; 3]);
/// let (below, above) = (lattice.below(Axis::Y, 3.5), lattice.above(Axis::Y, 3.5));
/// assert_eq!((below, above), (3, 4));
/// assert!(lattice.position(Axis::Y, below) <= 3.5 && 3.5 <= lattice.position(Axis::Y, above));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// By axis; the fourth is there so that an index of two bits needs no check.
    origin: [f32; 4],
    step: [f32; 4],
    last: [u32; 3],
}

impl Lattice {
    /// The greatest number of a plane: products with it are exact enough, and it fits a float.
    pub const MAX: u32 = 1 << 20;

    /// The lattice over a valid box, with planes from 0 to `last` (1 … [`MAX`](Self::MAX)) along each axis.
    #[must_use]
    pub fn over(bounds: &Aabb, last: [u32; 3]) -> Self {
        let last = last.map(|last| last.clamp(1, Self::MAX));
        let step = |axis: Axis, last: u32| {
            // A little more than the part, so that three roundings cannot make the last plane fall short.
            let step = axis.of(bounds.size()) / last as f32 * (1.0 + 1.0 / 4_194_304.0);
            if step > f32::MIN_POSITIVE { step } else { f32::MIN_POSITIVE }
        };
        let [x, y, z] = last;
        let step = [step(Axis::X, x), step(Axis::Y, y), step(Axis::Z, z)];
        Self {
            origin: [bounds.min.x, bounds.min.y, bounds.min.z, bounds.min.z],
            step: [step[0], step[1], step[2], step[2]],
            last,
        }
    }

    /// The number of the last plane of an axis.
    #[inline(always)]
    #[must_use]
    pub const fn last(&self, axis: Axis) -> u32 {
        self.last[axis as usize]
    }

    /// Where a plane lies.
    #[inline(always)]
    #[must_use]
    pub fn position(&self, axis: Axis, number: u32) -> f32 {
        self.plane(axis as u32, number)
    }

    /// From the first plane of an axis to the last.
    #[inline(always)]
    pub(crate) fn extent(&self, axis: Axis) -> f32 {
        self.last(axis) as i32 as f32 * self.step[axis as usize]
    }

    /// The first plane of an axis and the distance between planes, by the number of the axis, of which two bits count.
    #[inline(always)]
    pub(crate) fn along(&self, axis: u32) -> (f32, f32) {
        (self.origin[axis as usize & 3], self.step[axis as usize & 3])
    }

    /// As [`position`](Self::position), by the number of the axis, of which two bits count.
    #[inline(always)]
    pub(crate) fn plane(&self, axis: u32, number: u32) -> f32 {
        // As a signed number: chips and hosts convert these in one instruction.
        self.origin[axis as usize & 3] + number as i32 as f32 * self.step[axis as usize & 3]
    }

    /// The greatest number of a plane at or below `x`; 0 if there is none.
    #[must_use]
    pub fn below(&self, axis: Axis, x: f32) -> u32 {
        let last = self.last(axis);
        let fits = |number: u32| self.position(axis, number) <= x;
        let k = axis as usize;
        let guess = (x - self.origin[k]) / self.step[k];
        let guess = if guess > 0.0 { (guess as u32).min(last) } else { 0 };
        let is_last = |number: u32| fits(number) && (number == last || !fits(number + 1));
        for guess in [guess, guess.saturating_sub(1), (guess + 1).min(last)] {
            if is_last(guess) {
                return guess;
            }
        }
        // Where steps are smaller than the roundings of coordinates, many planes coincide.
        let (mut low, mut high) = (0, last);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if fits(middle) { low = middle } else { high = middle - 1 }
        }
        low
    }

    /// The least number of a plane at or above `x`; the last if there is none.
    #[must_use]
    pub fn above(&self, axis: Axis, x: f32) -> u32 {
        let below = self.below(axis, x);
        if self.position(axis, below) >= x {
            // The least of those that coincide.
            let (mut low, mut high) = (0, below);
            if below == 0 || self.position(axis, below - 1) < x {
                return below;
            }
            while low < high {
                let middle = (low + high) / 2;
                if self.position(axis, middle) >= x { high = middle } else { low = middle + 1 }
            }
            low
        } else {
            (below + 1).min(self.last(axis))
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::testing::{Random, cases};

    #[test]
    fn boxes_rounded_outward_contain_what_they_contained() {
        let mut random = Random::new(5);
        let spans = [
            (0.0, 1.0),
            (-3.0, 1.0e-3),
            (1.0e5, 0.25),
            (1.0e5, 0.0078125),
            (0.0, 1.0e-44),
            (-8.0e37, 1.6e38),
            (7.0, 0.0),
        ];
        for (min, size) in spans {
            let max: f32 = min + size;
            let bounds = Aabb::new(Vec3::splat(min), Vec3::splat(max));
            for last in [1, 7, 1000, 65_535, Lattice::MAX] {
                let lattice = Lattice::over(&bounds, [last; 3]);
                assert!(lattice.position(Axis::X, 0) <= min && lattice.position(Axis::Z, last) >= max);
                for _ in 0..cases(200) {
                    let x = (min + size * random.unit()).clamp(min, max);
                    let (below, above) = (lattice.below(Axis::Y, x), lattice.above(Axis::Y, x));
                    let at = |number| lattice.position(Axis::Y, number);
                    assert!(at(below) <= x && (below == last || at(below + 1) > x), "{min} {size} {last} {x}");
                    assert!(at(above) >= x && (above == 0 || at(above - 1) < x), "{min} {size} {last} {x}");
                }
            }
        }
    }
}
