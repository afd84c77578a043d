//! A hash for answers, words and pictures: here and on the host the same.

/// FNV-1a, 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(pub u32);

impl Hash {
    /// Of nothing.
    pub const NONE: Self = Self(0x811c_9dc5);

    /// Adds the bytes of a word.
    pub fn add(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }

    /// Of some words.
    pub fn of(words: impl IntoIterator<Item = u32>) -> Self {
        let mut hash = Self::NONE;
        words.into_iter().for_each(|word| hash.add(word));
        hash
    }
}
