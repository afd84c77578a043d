//! What a sequence of rays came to, down to the last bit.

use core::fmt;

use hitscan::Hit;

/// A digest of the closest hits of some rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Rays cast.
    pub rays: u32,
    /// Rays that hit.
    pub hits: u32,
    /// The sum of all `t`.
    pub sum: f64,
    /// FNV-1a over the bits of every hit.
    pub hash: u32,
}

impl Answer {
    /// Before the first ray.
    pub const NONE: Self = Self { rays: 0, hits: 0, sum: 0.0, hash: 0x811c_9dc5 };

    /// Adds the answer to the next ray.
    pub fn add(&mut self, hit: Option<Hit>) {
        self.rays += 1;
        if let Some(hit) = hit {
            self.hits += 1;
            self.sum += f64::from(hit.t);
        }
        let bits = hit.map_or([u32::MAX; 2], |hit| [hit.t.to_bits(), hit.primitive]);
        for byte in bits.into_iter().flat_map(u32::to_le_bytes) {
            self.hash = (self.hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, hits, sum, hash } = self;
        write!(f, "{hits} of {rays} rays hit, sum of t {sum:.2}, hash {hash:08x}")
    }
}
