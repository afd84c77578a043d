//! What a sequence of rays came to, down to the last bit.

use core::fmt;

use hitscan::Hit;

use crate::hash::Hash;

/// A digest of the closest hits of some rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Rays cast.
    pub rays: u32,
    /// Rays that hit.
    pub hits: u32,
    /// The sum of all `t`.
    pub sum: f64,
    /// Over the bits of every hit.
    pub hash: Hash,
}

impl Answer {
    /// Before the first ray.
    pub const NONE: Self = Self { rays: 0, hits: 0, sum: 0.0, hash: Hash::NONE };

    /// Adds the answer to the next ray.
    pub fn add(&mut self, hit: Option<Hit>) {
        self.rays += 1;
        if let Some(hit) = hit {
            self.hits += 1;
            self.sum += f64::from(hit.t);
        }
        hit.map_or([u32::MAX; 2], |hit| [hit.t.to_bits(), hit.primitive])
            .into_iter()
            .for_each(|bits| self.hash.add(bits));
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, hits, sum, hash: Hash(hash) } = self;
        write!(f, "{hits} of {rays} rays hit, sum of t {sum:.2}, hash {hash:08x}")
    }
}
