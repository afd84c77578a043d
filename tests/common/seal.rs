//! Damaged words, and the checksum of assets for tests that damage what stands behind it.

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

/// The words with each of their bytes set to every value.
pub fn every_byte(words: &[u32]) -> impl Iterator<Item = Vec<u32>> {
    let places = (0..words.len()).flat_map(|index| [0, 8, 16, 24].map(|shift| (index, shift)));
    places.flat_map(move |(index, shift)| {
        (0..=255).map(move |value| {
            let mut damaged = words.to_vec();
            damaged[index] = damaged[index] & !(0xff << shift) | (value << shift);
            damaged
        })
    })
}

/// An asset's words cut to each length for which its header still stands and says so, with the sum that belongs to them.
pub fn every_length(words: &[u32]) -> impl Iterator<Item = Vec<u32>> {
    (6..words.len()).map(|length| {
        let mut shorter = words[..length].to_vec();
        shorter[3] = length as u32;
        sealed(shorter)
    })
}

/// The words with counts in the place of one that lie: that of another `stride`, some that overflow.
pub fn every_lie(words: &[u32], place: usize, stride: u32) -> impl Iterator<Item = (u32, Vec<u32>)> {
    let count = words[place];
    let lies = [0, count.wrapping_sub(1), count + 1, count + stride, 1 << 30, 0x5555_5555, !0xf, u32::MAX];
    lies.into_iter().map(move |lie| {
        let mut damaged = words.to_vec();
        damaged[place] = lie;
        (lie, sealed(damaged))
    })
}

/// At which word of an asset a section begins.
pub fn place(words: &[u32], section: &[u32]) -> usize {
    words.iter().position(|word| std::ptr::eq(word, section.as_ptr())).expect("a section is a part of it")
}
