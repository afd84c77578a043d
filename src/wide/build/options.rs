/// How a [`WideBvh`](super::super::WideBvh) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::wide::Options;
/// let options = Options { reinsertions: 1, ..Options::balanced() };
/// # let _ = options;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// What a step from a node to its children costs, in tests of a leaf; if it is infinite, sets that fit into a leaf are not
    /// divided.
    pub step_cost: f32,
    /// The most bins per axis at whose borders sets are divided, 2 … 32.
    pub bins: u32,
    /// Sets of at most so many are divided in the best of all ways, 2 … 6.
    pub few: u32,
    /// How often nodes are taken out and put where they fit best.
    pub reinsertions: u32,
    /// The part of all nodes that is taken out each time, those with the largest boxes.
    pub reinserted: f32,
    /// The most references per primitive, 1 … 2: above 1, primitives are cut where large boxes would overlap.
    pub references: f32,
    /// What a byte for each triangle costs, in nodes that all rays visit: the more, the fuller are blocks and nodes. Rays hardly
    /// notice up to about 1.
    pub byte_price: f32,
}

impl Options {
    /// The least time to build: leaves are never divided, and nothing is tried again.
    #[must_use]
    pub const fn fast() -> Self {
        Self {
            step_cost: f32::INFINITY,
            bins: 16,
            few: 4,
            reinsertions: 0,
            reinserted: 0.0,
            references: 1.0,
            byte_price: 0.2,
        }
    }

    /// A good deal of both: a fifth slower to build, and up to a quarter less work for rays where primitives differ in size.
    #[must_use]
    pub const fn balanced() -> Self {
        Self { step_cost: 0.3, bins: 32, reinsertions: 4, reinserted: 0.05, ..Self::fast() }
    }

    /// The least work for rays: the better one of a hierarchy with cuts and one without.
    #[must_use]
    pub const fn best() -> Self {
        Self { references: 1.3, ..Self::balanced() }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
