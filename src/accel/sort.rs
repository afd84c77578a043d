//! Sorting coordinates in borrowed memory, in linear time, without a panic to link.

/// Up to this many keys, to compare each with each is faster than to count digits.
const FEW: usize = 64;

/// Values of a digit.
const DIGITS: usize = 256;

/// A finite coordinate as a key that sorts like it; both zeros are one.
#[inline(always)]
pub(crate) fn key(x: f32) -> u32 {
    let bits = (x + 0.0).to_bits();
    bits ^ ((bits as i32 >> 31) as u32 | 0x8000_0000)
}

/// The coordinate of a key.
#[inline(always)]
pub(crate) fn coordinate(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 0 { !key } else { key ^ 0x8000_0000 })
}

/// Sorts `keys`; `scratch` is at least as long.
pub(crate) fn sort(keys: &mut [u32], scratch: &mut [u32]) {
    let Some(scratch) = scratch.get_mut(..keys.len()) else { return };
    if keys.len() <= FEW { by_rank(keys, scratch) } else { radix(keys, scratch) }
}

/// Counts for each key how many go before it: more comparisons than need be, but none of them is waited for.
fn by_rank(keys: &mut [u32], scratch: &mut [u32]) {
    // Signed, as vectors compare.
    let signed = |key: u32| (key ^ 0x8000_0000) as i32;
    for (index, &key) in keys.iter().enumerate() {
        let (before, behind) = keys.split_at_checked(index).unwrap_or_default();
        let place = before.iter().map(|&other| u32::from(signed(other) <= signed(key))).sum::<u32>()
            + behind.iter().map(|&other| u32::from(signed(other) < signed(key))).sum::<u32>();
        if let Some(slot) = scratch.get_mut(place as usize) {
            *slot = key;
        }
    }
    for (slot, &key) in keys.iter_mut().zip(scratch.iter()) {
        *slot = key;
    }
}

/// By digits, the least significant first (Knuth, volume 3, §5.2.5), from one memory into the other and back.
fn radix(keys: &mut [u32], scratch: &mut [u32]) {
    let (mut from, mut to) = (keys, scratch);
    let mut swapped = false;
    for shift in [0, 8, 16, 24] {
        let digit = |key: u32| (key >> shift) as usize % DIGITS;
        let mut places = [0_u32; DIGITS];
        for &key in from.iter() {
            places[digit(key)] += 1;
        }
        // Neighbours often share their upper digits.
        if places.iter().any(|&count| count as usize == from.len()) {
            continue;
        }
        let mut sum = 0;
        for place in &mut places {
            (*place, sum) = (sum, sum + *place);
        }
        for &key in from.iter() {
            let place = &mut places[digit(key)];
            if let Some(slot) = to.get_mut(*place as usize) {
                *slot = key;
            }
            *place += 1;
        }
        (from, to) = (to, from);
        swapped = !swapped;
    }
    if swapped {
        for (slot, &key) in to.iter_mut().zip(from.iter()) {
            *slot = key;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::testing::{Random, cases};

    #[test]
    fn keys_sort_like_their_coordinates() {
        let coordinates = [f32::MIN, -1.0, -1.0e-40, 0.0, 1.0e-45, 1.0, 1.5, f32::MAX];
        for pair in coordinates.windows(2) {
            assert!(key(pair[0]) < key(pair[1]));
        }
        assert!(coordinates.iter().all(|&x| coordinate(key(x)) == x));
        assert_eq!(key(-0.0), key(0.0));
    }

    #[test]
    fn any_number_of_keys_is_sorted() {
        let mut random = Random::new(3);
        for len in [0, 1, 2, 3, 63, 64, 65, 300, 5000].into_iter().filter(|&len| len <= cases(600_000)) {
            for most in [1, 3, 1000, u32::MAX] {
                let mut keys: Vec<u32> = (0..len).map(|_| random.below(most)).collect();
                let mut expected = keys.clone();
                expected.sort_unstable();
                sort(&mut keys, &mut std::vec![7; expected.len() + 5]);
                assert_eq!(keys, expected);
            }
        }
    }
}
