//! Up to eight triangles with up to eight different corners.
//!
//! Neighbours share corners, so that a block has hardly more of them than triangles. Each is read once, and made ready for the
//! ray once; permutations hand them out to the lanes of the triangles. The words: for each of a triangle's three corners its places,
//! three bits a lane, above the first a bit for each lane that is a triangle; the corners' coordinates along x, y and z; the triangles'
//! numbers. How many corners there are says whoever names the block, so that all rows can be read at once.

use fearless_simd::{Bytes, Simd, SimdBase, f32x8, u32x8};
use glam::Vec3;

use super::{node::WIDTH, permute::permute, slabs::row};
use crate::geometry::{Possible, Ray, ShearLanes, Triangle, Wedge, range};

/// Words before the corners.
const HEAD: usize = 3;

/// Words that a walk may look at, wherever a block ends.
pub(super) const BLOCK_WORDS: usize = HEAD + 3 * WIDTH + WIDTH;

/// Where the head's words carry something else than places.
const ABOVE: u32 = 24;

/// The words of a block of so many corners and triangles, an even number.
pub(super) const fn words(corners: usize, triangles: usize) -> usize {
    (HEAD + 3 * corners + triangles).next_multiple_of(2)
}

/// A block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block<'t> {
    /// Its words, and what lies behind it.
    words: &'t [u32; BLOCK_WORDS],
    corners: usize,
}

impl<'t> Block<'t> {
    /// A block of so many corners.
    #[inline(always)]
    pub(super) const fn new(words: &'t [u32; BLOCK_WORDS], corners: usize) -> Self {
        Self { words, corners }
    }

    /// A bit for each lane that is a triangle.
    #[inline(always)]
    pub(super) const fn lanes(self) -> u32 {
        self.words[0] >> ABOVE
    }

    /// Something of each line of the cache.
    #[inline(always)]
    pub(super) const fn touch(self) -> u32 {
        self.words[0] ^ self.words[16] ^ self.words[32]
    }

    /// The number of a triangle.
    #[inline(always)]
    pub(super) fn number(self, lane: usize) -> u32 {
        self.words.get(HEAD + 3 * self.corners + lane).copied().unwrap_or(u32::MAX)
    }

    /// A corner of a triangle.
    #[inline(always)]
    pub(super) fn corner(self, lane: usize, which: usize) -> [f32; 3] {
        let place = (self.words.get(which).copied().unwrap_or(0) >> (3 * lane) & 7) as usize;
        let along = |axis: usize| self.words.get(HEAD + axis * self.corners + place).copied().unwrap_or(0);
        [f32::from_bits(along(0)), f32::from_bits(along(1)), f32::from_bits(along(2))]
    }

    /// A triangle.
    #[inline(always)]
    pub(super) fn triangle(self, lane: usize) -> Triangle {
        Triangle::new(self.corner(lane, 0).into(), self.corner(lane, 1).into(), self.corner(lane, 2).into())
    }

    /// Which of the triangles may be hit. In lanes that are none there is nothing sensible.
    // Written out: what arrays' `map` makes is not inlined into kernels, and has not their instructions.
    #[inline(always)]
    pub(super) fn test<S: Simd>(self, simd: S, shear: &ShearLanes<S>) -> Possible<f32x8<S>> {
        let [x, y, z] = shear.axes;
        let points = shear.shear([self.row(simd, x), self.row(simd, y), self.row(simd, z)]);
        shear.test([self.pick(simd, 0, points), self.pick(simd, 1, points), self.pick(simd, 2, points)])
    }

    /// Which of the triangles rays of a group may hit.
    #[inline(always)]
    pub(super) fn may_hit<S: Simd>(self, simd: S, wedge: &Wedge<S>) -> u32 {
        let [x, y, z] = wedge.axes;
        let points = [self.row(simd, x), self.row(simd, y), self.row(simd, z)];
        let corners = [self.pick(simd, 0, points), self.pick(simd, 1, points), self.pick(simd, 2, points)];
        wedge.may_hit(simd, corners) & self.lanes()
    }

    /// The least and the greatest parameter at which the ray may hit a triangle if it does, by doubles; none if they do not tell.
    #[inline(always)]
    pub(super) fn range<S: Simd>(self, simd: S, lane: usize, ray: &Ray) -> Option<[f32; 2]> {
        let place = |which: usize| self.words[which] >> (3 * (lane % WIDTH)) & 7;
        let (a, b, c) = (place(0), place(1), place(2));
        let places = u32x8::load_array(simd, [b, c, a, b, c, a, b, c]);
        let along = |axis: usize| permute(simd, self.row(simd, axis).bitcast(), places).bitcast();
        range(simd, [along(0), along(1), along(2)], self.corner(lane, 0), ray)
    }

    /// All corners' coordinates along an axis.
    #[inline(always)]
    fn row<S: Simd>(self, simd: S, axis: usize) -> f32x8<S> {
        let words = self.words.get(HEAD + axis * self.corners..).and_then(|words| words.first_chunk());
        row(simd, words.unwrap_or(&[0; WIDTH]))
    }

    /// Of each triangle one corner.
    #[inline(always)]
    fn pick<S: Simd>(self, simd: S, corner: usize, [x, y, z]: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
        let shifts = u32x8::load_array(simd, [0, 3, 6, 9, 12, 15, 18, 21]);
        let places = simd.shrv_u32x8(u32x8::splat(simd, self.words[corner]), shifts);
        let x = permute(simd, x.bitcast(), places).bitcast();
        let y = permute(simd, y.bitcast(), places).bitcast();
        let z = permute(simd, z.bitcast(), places).bitcast();
        [x, y, z]
    }
}

/// What a lane of a block is: a triangle and which of the block's corners it has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lane {
    pub(super) number: u32,
    pub(super) corners: [u8; 3],
}

/// Writes a block, for which `to` has just the room.
pub(super) fn write(to: &mut [u32], corners: &[Vec3], lanes: &[Lane]) {
    let mut head = [0; HEAD];
    for (lane, of) in lanes.iter().enumerate() {
        for (places, corner) in head.iter_mut().zip(of.corners) {
            *places |= u32::from(corner) << (3 * lane);
        }
    }
    head[0] |= (0xff >> (WIDTH - lanes.len())) << ABOVE;
    let rows = (0..3).flat_map(|axis| corners.iter().map(move |corner| corner[axis].to_bits()));
    let words = head.into_iter().chain(rows).chain(lanes.iter().map(|lane| lane.number));
    for (place, word) in to.iter_mut().zip(words) {
        *place = word;
    }
}
