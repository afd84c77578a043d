use glam::{Mat4, Vec4, Vec4Swizzles};

use crate::geometry::Aabb;

/// A box in two vectors: the least coordinates, and the greatest ones negated, so that both grow by minima.
///
/// No coordinate is a negative zero, so that unions have the same bits in whatever order they are made. The fourth lanes
/// carry what the owner likes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Hull {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

/// Added to words, makes them ordinary numbers as floats: with denormal ones in a lane, arithmetic takes many times as long.
const ORDINARY: u32 = 1 << 30;

impl Hull {
    /// The box that contains nothing.
    pub(super) const EMPTY: Self = Self { low: Vec4::INFINITY, high: Vec4::INFINITY };

    /// The box, with words below 2^29 in the fourth lanes.
    #[inline(always)]
    pub(super) fn new(bounds: &Aabb, words: [u32; 2]) -> Self {
        let (min, max) = (bounds.min, bounds.max);
        let low = Vec4::new(min.x + 0.0, min.y + 0.0, min.z + 0.0, 0.0);
        Self { low, high: Vec4::new(0.0 - max.x, 0.0 - max.y, 0.0 - max.z, 0.0) }.with_words(words)
    }

    /// The words in the fourth lanes.
    #[inline(always)]
    pub(super) const fn words(&self) -> [u32; 2] {
        [self.low.to_array()[3].to_bits() ^ ORDINARY, self.high.to_array()[3].to_bits() ^ ORDINARY]
    }

    /// The same with other words in the fourth lanes.
    #[inline(always)]
    pub(super) fn with_words(self, [low, high]: [u32; 2]) -> Self {
        let lane = |word: u32| f32::from_bits(word ^ ORDINARY);
        Self { low: self.low.with_w(lane(low)), high: self.high.with_w(lane(high)) }
    }

    /// The box.
    #[inline(always)]
    pub(super) fn bounds(&self) -> Aabb {
        Aabb::new(self.low.truncate(), (Vec4::ZERO - self.high).truncate())
    }

    /// The least box around both; nothing sensible in the fourth lanes.
    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// The points of both.
    #[inline(always)]
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    /// Twice the middle.
    #[inline(always)]
    pub(super) fn middle(self) -> Vec4 {
        self.low - self.high
    }

    /// The box that contains a point.
    #[inline(always)]
    pub(super) fn around(point: Vec4) -> Self {
        Self { low: point, high: Vec4::ZERO - point }
    }

    /// The edge lengths.
    #[inline(always)]
    pub(super) fn size(self) -> Vec4 {
        Vec4::ZERO - self.low - self.high
    }

    /// The part before a plane.
    #[inline(always)]
    pub(super) fn below(mut self, axis: usize, position: f32) -> Self {
        self.high[axis] = self.high[axis].max(0.0 - position);
        self
    }

    /// The part behind a plane.
    #[inline(always)]
    pub(super) fn above(mut self, axis: usize, position: f32) -> Self {
        self.low[axis] = self.low[axis].max(position + 0.0);
        self
    }

    /// Whether it contains no point.
    #[inline(always)]
    pub(super) fn is_empty(self) -> bool {
        let size = self.size();
        !(size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0)
    }

    /// What makes the longest edge a length of 1, so that no surface overflows.
    #[inline(always)]
    pub(super) fn scale(self) -> f32 {
        1.0 / self.size().truncate().max_element().max(f32::MIN_POSITIVE)
    }

    /// As [`weight`](Self::weight), of three boxes.
    #[inline(always)]
    pub(super) fn weights(hulls: &[Self; 3], scale: f32) -> Vec4 {
        let sizes = hulls.map(|hull| hull.size() * scale + Vec4::splat(1.0e-6));
        let by_axis = Mat4::from_cols(sizes[0], sizes[1], sizes[2], Vec4::ZERO).transpose();
        let (x, y, z) = (by_axis.x_axis, by_axis.y_axis, by_axis.z_axis);
        x * y + y * z + z * x
    }

    /// How likely rays meet it: half the surface, and a little for the lengths so that boxes without surface are told
    /// apart, too.
    #[inline(always)]
    pub(super) fn weight(self, scale: f32) -> f32 {
        let size = self.size() * scale + Vec4::splat(1.0e-6);
        let faces = size * size.yzxw();
        faces.x + faces.y + faces.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_come_back_and_are_ordinary_numbers() {
        for words in [[0, 1], [1 << 23, (1 << 29) - 1]] {
            let hull = Hull::new(&Aabb::EMPTY, words);
            assert_eq!(hull.words(), words);
            assert!(hull.low.w.is_normal() && hull.high.w.is_normal());
        }
    }
}
