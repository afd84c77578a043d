use std::{ops::Range, vec, vec::Vec};

use rayon::prelude::*;

use crate::{geometry::Triangle, wide::node::WIDTH};

/// Corners of as many triangles as a block has room for.
const WINDOW: usize = 3 * WIDTH;

/// Triangles that are looked at together.
const CHUNK: usize = 512;

/// Which corners of triangles that stand close to each other are the same, by their bits.
#[derive(Debug)]
pub(super) struct Repeats {
    /// For each corner, how many corners back the same one stands; more than a window has if there is none.
    backs: Vec<u8>,
}

impl Repeats {
    /// Of triangles in a row.
    pub(super) fn of(triangles: &[Triangle]) -> Self {
        let mut backs = vec![0; 3 * triangles.len() + WINDOW];
        backs.par_chunks_mut(3 * CHUNK).enumerate().for_each(|(chunk, backs)| {
            let first = chunk * CHUNK;
            let end = triangles.len().min(first + CHUNK);
            // A window ahead of the first; what no corner is where there are none.
            let ahead = first.min(WIDTH);
            let mut rows = [[u32::MAX; WINDOW + 3 * CHUNK]; 3];
            let corners = triangles.get(first - ahead..end).unwrap_or(&[]).iter().flat_map(|of| [of.a, of.b, of.c]);
            let [x, y, z] = &mut rows;
            for (corner, ((x, y), z)) in corners.zip(x.iter_mut().zip(y).zip(z).skip(WINDOW - 3 * ahead)) {
                [*x, *y, *z] = corner.to_array().map(f32::to_bits);
            }
            let windows = rows.each_ref().map(|row| row.array_windows::<{ WINDOW + 1 }>());
            let [x, y, z] = windows;
            for (((back, x), y), z) in backs.iter_mut().zip(x).zip(y).zip(z) {
                let mut same = 0_u32;
                for place in 0..WINDOW {
                    let is_same = (x[place] == x[WINDOW]) & (y[place] == y[WINDOW]) & (z[place] == z[WINDOW]);
                    same |= if is_same { 1 << place } else { 0 };
                }
                *back = (same.leading_zeros() as usize + WINDOW - 31) as u8;
            }
        });
        Self { backs }
    }

    /// How many different corners a few triangles have.
    pub(super) fn count(&self, triangles: Range<usize>) -> usize {
        let (first, corners) = (3 * triangles.start, 3 * triangles.len());
        let mut count = 0;
        for (place, &back) in self.backs[first..first + WINDOW].iter().enumerate() {
            count += u8::from((back > place as u8) & (place < corners));
        }
        usize::from(count)
    }

    /// For each corner of a few triangles, which of their different corners it is.
    pub(super) fn places(&self, triangles: Range<usize>) -> heapless::Vec<u8, WINDOW> {
        let mut places = heapless::Vec::<u8, WINDOW>::new();
        let mut count = 0;
        for (corner, &back) in self.backs[3 * triangles.start..3 * triangles.end].iter().enumerate() {
            let earlier = corner.checked_sub(usize::from(back)).and_then(|corner| places.get(corner).copied());
            let place = earlier.unwrap_or(count);
            count += u8::from(earlier.is_none());
            let _ = places.push(place);
        }
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;
    use glam::Vec3;

    #[test]
    fn corners_are_the_same_by_their_bits() {
        let mut random = Random::new(1);
        // Few coordinates, both zeros among them.
        let mut coordinate = || [0.0, -0.0, 1.0e-44, 1.0][(random.unit() * 4.0) as usize];
        let mut corner = || Vec3::new(coordinate(), coordinate(), 2.0);
        let triangles: Vec<Triangle> = (0..3 * CHUNK).map(|_| Triangle::new(corner(), corner(), corner())).collect();
        let repeats = Repeats::of(&triangles);
        for first in 0..triangles.len() {
            for end in first + 1..=triangles.len().min(first + WIDTH) {
                let corners = triangles[first..end].iter().flat_map(|of| [of.a, of.b, of.c]);
                let mut different: Vec<[u32; 3]> = vec![];
                let places = corners.map(|corner| {
                    let bits = corner.to_array().map(f32::to_bits);
                    different.iter().position(|&other| other == bits).unwrap_or_else(|| {
                        different.push(bits);
                        different.len() - 1
                    }) as u8
                });
                let places: Vec<u8> = places.collect();
                assert_eq!(repeats.places(first..end)[..], places, "{first} {end}");
                assert_eq!(repeats.count(first..end), different.len(), "{first} {end}");
            }
        }
    }
}
