use super::{
    LatticeRay,
    ray::{LAST, MIDDLE},
};
use crate::geometry::Axis;

/// A line through a lattice.
pub(super) struct Line {
    pub(super) major: Axis,
    /// Whether the ray goes towards lower numbers along the major axis.
    pub(super) descends: bool,
    /// Along the two axes after it: where the line crosses the middle plane, and its slope, in 2^-14.
    pub(super) crossings: [(i32, i32); 2],
}

/// How a ray sees triangles: what is left of it for the test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    /// The axes in cyclic order, the major one last.
    pub(super) axes: [Axis; 3],
    /// Whether the ray goes towards lower numbers along the major axis.
    pub(super) descends: bool,
    /// The planes of the first two axes that the ray crosses per plane of the major one, in 2^-14.
    pub(super) slope: [i32; 2],
    /// Where it crosses them at the major axis's plane 0, in 2^-14.
    pub(super) anchor: [i32; 2],
}

impl Sight {
    /// Along a line; `None` if it misses the lattice.
    #[inline(always)]
    pub(super) fn new(line: &Line) -> Option<Self> {
        let Line { major, descends, crossings: [(x, x_slope), (y, y_slope)] } = *line;
        Some(Self {
            axes: [major.next(), major.next().next(), major],
            descends,
            slope: [x_slope, y_slope],
            anchor: [anchor(x, x_slope)?, anchor(y, y_slope)?],
        })
    }

    /// The plane of the major axis at a depth, and the depth of a plane, both in 2^-8.
    #[inline(always)]
    pub(super) const fn plane(&self, depth: i32) -> i32 {
        if self.descends { (LAST << 8) - depth } else { depth }
    }
}

/// Where a line crosses plane 0 that crosses the middle plane at `middle`, if it crosses the lattice.
///
/// The distance of any vertex from the line is then below 2^17, as a number of 2^-14 it fits 32 bits.
fn anchor(middle: i32, slope: i32) -> Option<i32> {
    const END: i32 = LAST << LatticeRay::FRACTION;
    /// Half of the lattice.
    const HALF: i32 = MIDDLE << LatticeRay::FRACTION;
    if !(-HALF..=END + HALF).contains(&middle) {
        return None;
    }
    let (first, last) = (middle - slope * MIDDLE, middle + slope * (LAST - MIDDLE));
    let (least, most) = if slope < 0 { (last, first) } else { (first, last) };
    (least <= END && most >= 0).then_some(first)
}
