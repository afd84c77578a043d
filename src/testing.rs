//! Numbers for unit tests.

/// How many times less is tried under Miri, where all takes as much longer.
const PATIENCE: u32 = 2000;

/// So many cases, or a part of them.
pub(crate) const fn cases(count: u32) -> u32 {
    if cfg!(miri) { count.div_ceil(PATIENCE) } else { count }
}

/// The step that leaves so many.
pub(crate) const fn every(step: usize) -> usize {
    if cfg!(miri) { step * PATIENCE as usize } else { step }
}

/// A small generator of reproducible numbers (xorshift64*, Vigna 2016).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    }

    /// A whole number below `n`.
    pub(crate) fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(n)) >> 32) as u32
    }

    /// A number from 0 up to 1.
    pub(crate) fn unit(&mut self) -> f32 {
        (self.next() >> 8) as f32 / 16_777_216.0
    }
}
