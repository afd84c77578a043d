use super::{HEADER_WORDS, node::PAIR_WORDS};

/// How the hierarchy comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// From the top down, each set divided where the surface area heuristic expects the least work, looked for at the
    /// borders of bins.
    Sah,
    /// From the bottom up, near neighbours joined.
    Ploc,
}

/// How a [`Bvh`](super::Bvh) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::bvh::{Method, Options};
/// let options = Options { method: Method::Ploc, leaf_size: 4, ..Options::balanced() };
/// let tight = Options::balanced().fit(64 * 1024);
/// # let _ = (options, tight);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How the hierarchy comes about.
    pub method: Method,
    /// How often all nodes are taken out and put where they fit best: the second time still makes walks shorter, the
    /// fourth hardly. Each takes about as long as all the rest of the builder.
    pub reinsertions: u32,
    /// The most primitives in a leaf, 1 … 15.
    pub leaf_size: u32,
    /// What testing a primitive costs, in steps through a pair of nodes.
    ///
    /// Subtrees become leaves where that is expected to cost no more.
    pub intersection_cost: f32,
    /// The greatest size in bytes per primitive, the list not counted: more subtrees become leaves where it would be
    /// exceeded, those first that are missed least.
    pub bytes_per_primitive: f32,
    /// The greatest size in bytes, the list not counted.
    pub max_bytes: Option<usize>,
}

impl Options {
    /// The fewest bytes that still make a hierarchy worth its name: 6 per triangle.
    #[must_use]
    pub const fn small() -> Self {
        Self { bytes_per_primitive: 6.0, ..Self::balanced() }
    }

    /// A good deal of both: 10 bytes per triangle.
    #[must_use]
    pub const fn balanced() -> Self {
        Self {
            method: Method::Sah,
            reinsertions: 3,
            leaf_size: 8,
            intersection_cost: 0.55,
            bytes_per_primitive: 10.6,
            max_bytes: None,
        }
    }

    /// The least time per ray: up to 20 bytes per triangle.
    #[must_use]
    pub const fn fast() -> Self {
        Self { intersection_cost: 1.0, bytes_per_primitive: 20.0, ..Self::balanced() }
    }

    /// The same, but at most `bytes` in all.
    #[must_use]
    pub const fn fit(self, bytes: usize) -> Self {
        Self { max_bytes: Some(bytes), ..self }
    }

    /// How many pairs a hierarchy over `primitives` may have.
    pub(super) fn pairs(&self, primitives: usize) -> usize {
        const PAIR_BYTES: usize = PAIR_WORDS * 4;
        // A constant beside the rate, so that a handful of primitives can still be divided.
        let rate = (primitives as f32 * self.bytes_per_primitive) as usize / PAIR_BYTES + 8;
        let most = self.max_bytes.map_or(usize::MAX, |bytes| bytes.saturating_sub(HEADER_WORDS * 4) / PAIR_BYTES);
        rate.min(most)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
