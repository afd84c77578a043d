/// How a grid says which primitives are in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Form {
    /// An offset per cell, 2 bytes, or 4 above 65,535 references, and 4 bytes a reference, or 6 above 2^14 primitives, 8 above 2^21, where
    /// other forms have little more than 2: needs no memory beside the grid to be built in.
    Full,
    /// A word per cell, an offset and which octants hold anything: a third less work for queries that do not pause. For less
    /// than 2^24 primitives and references.
    Octants,
    /// A bit per cell, a count per 32 of them, and an offset per cell that is not empty.
    Bitmask,
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Full, Self::Octants, Self::Bitmask];
}

/// How a [`Grid`](super::Grid) is built: a preset, or one with knobs changed.
///
/// ```
/// use hitscan::grid::{Form, Options};
/// let options = Options { density: 2.0, form: Form::Full, ..Options::balanced() };
/// let tight = Options::balanced().fit(64 * 1024);
/// # let _ = (options, tight);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How many cells there are per primitive; fewer where the references would exceed the bytes allowed.
    pub density: f32,
    /// How a grid says which primitives are in a cell.
    pub form: Form,
    /// Whether certified primitives are referenced only where they themselves are, not wherever their bounds are: a third
    /// fewer references for a longer build, 40 times as long where doubles are soft.
    pub clip: bool,
    /// The greatest size in bytes per primitive: there are fewer cells where it would be exceeded.
    pub bytes_per_primitive: u32,
    /// The greatest size in bytes: there are fewer cells where it would be exceeded.
    pub max_bytes: Option<usize>,
}

impl Options {
    /// The fewest bytes that still make a grid worth its name: 4 to 9 per triangle.
    #[must_use]
    pub const fn small() -> Self {
        Self { density: 1.0, bytes_per_primitive: 24, ..Self::balanced() }
    }

    /// Half as many tests as [`small`](Self::small): 6 to 14 bytes per triangle.
    #[must_use]
    pub const fn balanced() -> Self {
        Self { density: 2.5, form: Form::Bitmask, clip: true, bytes_per_primitive: 40, max_bytes: None }
    }

    /// The least work per ray: 21 to 30 bytes per triangle.
    #[must_use]
    pub const fn fast() -> Self {
        Self { density: 4.0, form: Form::Octants, bytes_per_primitive: 64, ..Self::balanced() }
    }

    /// Quickly built where it stands, for what moves: no doubles are computed, and the arena needs no more words than the
    /// grid will have, from about 5,000 primitives on two bytes more per cell. 12 to 20 bytes per triangle.
    #[must_use]
    pub const fn quick() -> Self {
        Self { density: 1.0, form: Form::Full, clip: false, ..Self::balanced() }
    }

    /// The same, but at most `bytes` in all.
    #[must_use]
    pub const fn fit(self, bytes: usize) -> Self {
        Self { max_bytes: Some(bytes), ..self }
    }

    /// The most cells for `primitives`.
    pub(super) const fn cells(&self, primitives: usize) -> u32 {
        // Not a number is none.
        let cells = (self.density * primitives as f32) as u32;
        let bytes = self.bytes(primitives);
        // More would not fit, were they all empty.
        let most = match self.form {
            Form::Full => bytes / 2,
            Form::Octants => bytes / 4,
            Form::Bitmask => bytes.saturating_mul(4),
        };
        let most = if most > super::MAX_COUNT as usize { super::MAX_COUNT } else { most as u32 };
        if cells < 1 {
            1
        } else if cells > most {
            most
        } else {
            cells
        }
    }

    /// The greatest size in bytes for `primitives`.
    pub(super) const fn bytes(&self, primitives: usize) -> usize {
        // A constant beside the rate, so that a handful of primitives can still be divided.
        let rate = primitives.saturating_mul(self.bytes_per_primitive as usize).saturating_add(256);
        // A single cell is always allowed.
        let least = self.least_bytes(primitives);
        let most = if rate > least { rate } else { least };
        match self.max_bytes {
            Some(bytes) if bytes < most => bytes,
            _ => most,
        }
    }

    /// The bytes of a single cell.
    pub(super) const fn least_bytes(&self, primitives: usize) -> usize {
        let occupied = if primitives > 0 { 1 } else { 0 };
        super::build::size(self.form, primitives, 1, occupied, primitives).saturating_mul(4)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::balanced()
    }
}
