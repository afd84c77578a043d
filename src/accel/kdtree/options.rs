use super::{MAX_DEPTH, form::Form};
use crate::math;

/// How a cell is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Split {
    /// In the middle of its longest side.
    Midpoint,
    /// At the median of the primitives' middles, along its longest side.
    Median,
    /// Where the surface area heuristic expects the least work.
    Sah,
}

/// How a [`KdTree`](super::KdTree) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::kdtree::{Options, Split};
/// let options = Options { split: Split::Median, leaf_size: 4, ..Options::balanced() };
/// let tight = Options::balanced().fit(64 * 1024);
/// # let _ = (options, tight);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How a cell is divided.
    pub split: Split,
    /// Cells with at most this many primitives become leaves.
    pub leaf_size: u32,
    /// The greatest depth, at most [`MAX_DEPTH`]; `None` for the rule 8 + 1.3 log2 n (Havran and Bittner 2002).
    pub max_depth: Option<u32>,
    /// What testing a primitive costs, in steps through a node.
    ///
    /// Only the surface area heuristic looks at it: a cell is divided while that is expected to pay.
    pub intersection_cost: f32,
    /// What a byte per primitive costs, in steps of a ray through the whole: the lever between bytes and speed.
    ///
    /// Only the surface area heuristic looks at it: a node must save so much, by the chance that a ray comes to its cell.
    pub byte_cost: f32,
    /// By how much a split that cuts off empty space counts as cheaper, 0 … 1.
    pub empty_bonus: f32,
    /// Whether certified primitives are referenced by their clipped parts ("perfect splits"): fewer references for a
    /// longer build.
    pub clip: bool,
    /// The greatest size in bytes per primitive; cells become leaves where it would be exceeded.
    pub bytes_per_primitive: u32,
    /// The greatest size in bytes: the cost of a byte is raised until the tree fits.
    pub max_bytes: Option<usize>,
}

impl Options {
    /// The fewest bytes that still make a tree worth its name: 8 to 23 per triangle, 6 to 18 in a
    /// [`CompactKdTree`](super::CompactKdTree).
    #[must_use]
    pub const fn small() -> Self {
        Self { byte_cost: 0.65, bytes_per_primitive: 48, ..Self::balanced() }
    }

    /// A twentieth slower than [`fast`](Self::fast) in two thirds of the bytes: 14 to 40 per triangle.
    #[must_use]
    pub const fn balanced() -> Self {
        Self {
            split: Split::Sah,
            leaf_size: 1,
            max_depth: None,
            intersection_cost: 2.0,
            byte_cost: 0.1,
            empty_bonus: 0.2,
            clip: true,
            bytes_per_primitive: 96,
            max_bytes: None,
        }
    }

    /// The least time per ray: 18 to 60 bytes per triangle.
    #[must_use]
    pub const fn fast() -> Self {
        Self { intersection_cost: 2.5, byte_cost: 0.04, bytes_per_primitive: 200, ..Self::balanced() }
    }

    /// The same, but at most `bytes` in all.
    #[must_use]
    pub const fn fit(self, bytes: usize) -> Self {
        Self { max_bytes: Some(bytes), ..self }
    }

    /// The greatest depth for `primitives`.
    pub(super) fn depth(&self, primitives: u32) -> u32 {
        let rule = || (8.0 + 1.3 * math::log2(primitives.max(1) as f32)) as u32;
        self.max_depth.unwrap_or_else(rule).min(MAX_DEPTH as u32)
    }

    /// Whether the cost of a byte is looked for at which the tree fits.
    pub(super) const fn is_searched(&self) -> bool {
        self.max_bytes.is_some() && matches!(self.split, Split::Sah)
    }

    /// The bytes that a tree over `primitives` may take while it is built: twice as many where it has to be made to fit.
    pub(super) const fn room(&self, primitives: usize, form: Form) -> usize {
        let bytes = self.bytes(primitives, form);
        if self.is_searched() { bytes.saturating_mul(2) } else { bytes }
    }

    /// The greatest size in bytes for `primitives`.
    pub(super) const fn bytes(&self, primitives: usize, form: Form) -> usize {
        // A constant beside the rate, so that a handful of primitives can still be divided.
        let rate = primitives.saturating_mul(self.bytes_per_primitive as usize).saturating_add(256);
        // A single leaf is always allowed.
        let least = form.least_bytes(primitives);
        let most = if rate > least { rate } else { least };
        match self.max_bytes {
            Some(bytes) if bytes < most => bytes,
            _ => most,
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
