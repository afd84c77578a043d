use super::node::Head;

/// How the tree comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// With the boxes of all primitives at hand, and looking ahead to what can be cut off below: the fewest bytes and the
    /// shortest walks, 16 bytes of scratch per primitive.
    Thorough,
    /// In the words of the tree itself and a kilobyte beside them, several times as fast: for devices. Nodes take at most
    /// 4.5 bytes per primitive, or as many as leaves of fewer than nine need.
    Quick,
}

/// How a [`DualSplit`](super::DualSplit) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::dualsplit::Options;
/// let options = Options { leaf_size: 4, ..Options::balanced() };
/// # let _ = options;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How the tree comes about.
    pub method: Method,
    /// The most primitives of a leaf, 1 … 15; fewer where the surface area heuristic expects that to pay.
    pub leaf_size: u32,
    /// What testing a primitive costs, in steps through a node: the lever between bytes and speed.
    pub intersection_cost: f32,
    /// How many times over a node that cuts off empty space must pay for itself; infinite for none.
    pub carve_threshold: f32,
}

impl Options {
    /// The fewest bytes that still make a tree worth its name: about 3 per triangle, and half as many tests again.
    #[must_use]
    pub const fn small() -> Self {
        Self { intersection_cost: 0.5, ..Self::balanced() }
    }

    /// Few bytes and few tests: 3 to 6 bytes per triangle.
    #[must_use]
    pub const fn balanced() -> Self {
        Self { method: Method::Thorough, leaf_size: 12, intersection_cost: 0.75, carve_threshold: 2.0 }
    }

    /// The least work where a test costs more than a step: 5 to 8 bytes per triangle.
    #[must_use]
    pub const fn fast() -> Self {
        Self { intersection_cost: 1.2, ..Self::balanced() }
    }

    /// Made on the device: about as many bytes and tests as [`balanced`](Self::balanced) for a fraction of the time.
    #[must_use]
    pub const fn quick() -> Self {
        Self { method: Method::Quick, ..Self::balanced() }
    }

    /// The most primitives of a leaf, within what a leaf can hold.
    pub(super) const fn most(&self) -> u32 {
        match self.leaf_size {
            0 => 1,
            size if size > Head::MAX_COUNT => Head::MAX_COUNT,
            size => size,
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
