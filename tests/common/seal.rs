//! The checksum of assets, for tests that damage what stands behind it.

/// FNV-1a by words with a rotation, of all words but the one that holds it, as the format defines it.
pub fn checksum(words: &[u32]) -> u32 {
    let summed = words.iter().enumerate().filter(|(index, _)| *index != 4);
    summed.fold(0x811c_9dc5, |sum: u32, (_, word)| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}

/// Writes the sum anew, if there is room for it.
pub fn seal(words: &mut [u32]) {
    let sum = checksum(words);
    if let Some(place) = words.get_mut(4) {
        *place = sum;
    }
}

/// The same with the sum that belongs to it.
pub fn sealed(mut words: Vec<u32>) -> Vec<u32> {
    seal(&mut words);
    words
}
