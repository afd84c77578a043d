use super::{HEADER_WORDS, MAX_DEPTH, least_words, node::MAX_WORD};

/// How an [`Octree`](super::Octree) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::octree::Options;
/// let options = Options { leaf_size: 4, ..Options::balanced() };
/// let tight = Options::balanced().fit(64 * 1024);
/// # let _ = (options, tight);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// Where a cell is divided.
    pub split: Split,
    /// Cells with at most this many primitives become leaves.
    pub leaf_size: u32,
    /// The greatest depth, at most [`MAX_DEPTH`].
    pub max_depth: u32,
    /// What testing a primitive costs, in visits to a node: the lever between bytes and speed.
    ///
    /// A cell is divided while that is expected to pay.
    pub intersection_cost: f32,
    /// Whether certified primitives are referenced by their clipped parts: fewer references for a longer build.
    pub clip: bool,
    /// The greatest size in bytes per primitive; cells become leaves where it would be exceeded.
    pub bytes_per_primitive: u32,
    /// The greatest size in bytes: the intersection cost is lowered until the tree fits.
    pub max_bytes: Option<usize>,
}

/// Where a cell is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Split {
    /// In the middle, along all axes: the octree of the textbooks.
    Middle,
    /// Along as many axes, and there, where the surface area heuristic expects the least work.
    Sah,
}

impl Options {
    /// The fewest bytes that still make a tree worth its name: 10 to 20 per triangle.
    #[must_use]
    pub const fn small() -> Self {
        Self { intersection_cost: 0.4, bytes_per_primitive: 48, ..Self::balanced() }
    }

    /// A tenth slower than [`fast`](Self::fast) in half the bytes: 20 to 35 per triangle.
    #[must_use]
    pub const fn balanced() -> Self {
        Self {
            split: Split::Sah,
            leaf_size: 1,
            max_depth: MAX_DEPTH as u32,
            intersection_cost: 0.7,
            clip: true,
            bytes_per_primitive: 96,
            max_bytes: None,
        }
    }

    /// The least time per ray: 35 to 80 bytes per triangle.
    #[must_use]
    pub const fn fast() -> Self {
        Self { intersection_cost: 1.8, bytes_per_primitive: 200, ..Self::balanced() }
    }

    /// The same, but at most `bytes` in all.
    #[must_use]
    pub const fn fit(self, bytes: usize) -> Self {
        Self { max_bytes: Some(bytes), ..self }
    }

    /// The greatest depth.
    pub(super) const fn depth(&self) -> usize {
        if (self.max_depth as usize) < MAX_DEPTH { self.max_depth as usize } else { MAX_DEPTH }
    }

    /// The greatest size in words for `primitives`, header included.
    pub(super) const fn words(&self, primitives: usize) -> usize {
        // A constant beside the rate, so that a handful of primitives can still be divided.
        let rate = primitives.saturating_mul(self.bytes_per_primitive as usize).saturating_add(256) / 4;
        let named = HEADER_WORDS + MAX_WORD as usize;
        let most = if rate < named { rate } else { named };
        // A single leaf is always allowed.
        let least = least_words(primitives);
        let most = if most > least { most } else { least };
        match self.max_bytes {
            Some(bytes) if bytes / 4 < most => bytes / 4,
            _ => most,
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
