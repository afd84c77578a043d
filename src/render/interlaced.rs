use super::{Tile, Tiles};

/// The pixels of a picture, rough at first: of each 8 x 8 the first, then one more, then twice as many with each of the seven
/// passes, always spread evenly.
///
/// Bayer, *An optimum method for two-level rendition of continuous-tone pictures*, 1973: a pass holds the thresholds of his
/// matrix of 8 x 8 from one power of two to the next. Within a pass pixels come tile by tile, so that neighbours can share
/// where their rays begin. An iterator of blocks, whose upper left pixel is the one to be computed, each to be drawn over
/// what is there.
///
/// ```
/// use hitscan::render::Interlaced;
/// let blocks: Vec<_> = Interlaced::new(16, 8).collect();
/// assert_eq!(blocks.len(), 16 * 8);
/// // After the first pass all of the picture is there, in blocks of 8 x 8.
/// assert!(blocks[..2].iter().all(|block| block.area() == 64));
/// assert_eq!((blocks[2].x, blocks[2].y, blocks[2].area()), (4, 4, 16));
/// ```
#[derive(Clone, Debug)]
pub struct Interlaced {
    width: u32,
    height: u32,
    pass: u32,
    /// The tiles that are left of this pass.
    tiles: Tiles,
    /// The tile at hand.
    tile: Tile,
    /// The next pixel in it, from its corner.
    next: (u32, u32),
}

/// Pixels along a side of a first block.
const COARSEST: u32 = 8;

/// Pixels of a row of a tile, in a pass.
const SAMPLES: u32 = 8;

/// One with a pixel of each 8 x 8, and two for each halving of the distance.
const PASSES: u32 = 7;

/// How far apart pixels were before this pair of passes, 8, 4 or 2, and half as much: powers of two.
const fn strides(pass: u32) -> (u32, u32) {
    match pass {
        0 => (COARSEST, COARSEST),
        pass => {
            let stride = COARSEST >> ((pass - 1) / 2);
            (stride, stride / 2)
        }
    }
}

/// Whether a pass is of pixels in the middle of four that were there.
const fn is_diagonal(pass: u32) -> bool {
    pass % 2 == 1
}

impl Interlaced {
    /// Those of a picture of this size.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self::from_pass(width, height, 0)
    }

    /// Those of a pass and of what follows.
    fn from_pass(width: u32, height: u32, pass: u32) -> Self {
        let (stride, half) = strides(pass);
        // As many samples in a tile on the diagonals as at first, half as many beside them.
        let side = SAMPLES * if is_diagonal(pass) { stride } else { half };
        let nowhere = Tile { x: 0, y: 0, width: 0, height: 0 };
        Self { width, height, pass, tiles: Tiles::new(width, height, side, side), tile: nowhere, next: (0, 0) }
    }

    /// The tile of the block that came last.
    #[must_use]
    pub const fn tile(&self) -> Tile {
        self.tile
    }

    /// The pass of the block that came last, from 0 to 6; 7 at the end.
    #[must_use]
    pub const fn pass(&self) -> u32 {
        self.pass
    }

    /// The next block of the tile.
    fn next_in_tile(&mut self) -> Option<Tile> {
        let (stride, half) = strides(self.pass);
        let Tile { x, y, width, height } = self.tile;
        loop {
            let (dx, dy) = self.next;
            if dy >= height {
                return None;
            }
            if dx >= width {
                let dy = dy + if is_diagonal(self.pass) { stride } else { half };
                self.next = (self.first(dy), dy);
                continue;
            }
            self.next = (dx + stride, dy);
            return Some(Tile { x: x + dx, y: y + dy, width: half.min(width - dx), height: half.min(height - dy) });
        }
    }

    /// Where a row of the pass begins.
    const fn first(&self, dy: u32) -> u32 {
        let (_, half) = strides(self.pass);
        let is_between = is_diagonal(self.pass) || (self.pass > 0 && dy & half == 0);
        if is_between { half } else { 0 }
    }
}

impl Iterator for Interlaced {
    type Item = Tile;

    fn next(&mut self) -> Option<Tile> {
        while self.pass < PASSES {
            if let Some(block) = self.next_in_tile() {
                return Some(block);
            }
            if let Some(tile) = self.tiles.next() {
                self.tile = tile;
                let dy = if is_diagonal(self.pass) { strides(self.pass).1 } else { 0 };
                self.next = (self.first(dy), dy);
            } else {
                *self = Self::from_pass(self.width, self.height, self.pass + 1);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use std::{vec, vec::Vec};

    use super::*;

    /// The threshold of a pixel in Bayer's matrix of 8 x 8, by its definition: bits of x ^ y and y, reversed.
    fn threshold(x: u32, y: u32) -> u32 {
        (0..3).fold(0, |sum, bit| sum << 2 | ((x ^ y) >> bit & 1) << 1 | y >> bit & 1)
    }

    #[test]
    fn passes_are_those_of_the_matrix() {
        let mut pixels = Interlaced::new(64, 64);
        let mut counts = [0; PASSES as usize];
        while let Some(block) = pixels.next() {
            let threshold = threshold(block.x % 8, block.y % 8);
            let pass = if threshold == 0 { 0 } else { threshold.ilog2() + 1 };
            assert_eq!(pixels.pass(), pass, "{block:?}");
            counts[pass as usize] += 1;
        }
        assert_eq!(counts, [64, 64, 128, 256, 512, 1024, 2048]);
        assert_eq!((pixels.next(), pixels.pass()), (None, PASSES));
    }

    #[test]
    fn each_pixel_comes_once_and_every_block_covers_what_is_its() {
        for (width, height) in [(1, 1), (7, 33), (8, 8), (65, 40), (0, 5), (5, 0), (33, 1), (130, 70)] {
            let mut seen = vec![0_u8; (width * height) as usize];
            let mut shown = vec![(u32::MAX, u32::MAX); seen.len()];
            let mut pixels = Interlaced::new(width, height);
            let mut pass = 0;
            while let Some(block) = pixels.next() {
                assert!(block.x < width && block.y < height && block.area() > 0);
                let tile = pixels.tile();
                assert!(block.x >= tile.x && block.x + block.width <= tile.x + tile.width);
                assert!(block.y >= tile.y && block.y + block.height <= tile.y + tile.height);
                if pixels.pass() > pass {
                    pass = pixels.pass();
                    // All is covered from the first pass on, and by something no farther away than its blocks are large.
                    let far = COARSEST >> ((pass - 1) / 2);
                    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
                    let near = |((x, y), (a, b)): ((u32, u32), &(u32, u32))| x - a < far && y - b < far;
                    assert!(all.zip(&shown).all(near), "{width} x {height}, pass {pass}");
                }
                seen[(block.y * width + block.x) as usize] += 1;
                block.pixels().for_each(|(x, y)| shown[(y * width + x) as usize] = (block.x, block.y));
            }
            assert!(seen.iter().all(|&times| times == 1), "{width} x {height}");
            let own: Vec<_> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).collect();
            assert_eq!(shown, own);
        }
    }

    #[test]
    fn pictures_of_any_size_are_begun() {
        for size in [(u32::MAX, u32::MAX), (u32::MAX, 1), (1, u32::MAX)] {
            assert_eq!(Interlaced::new(size.0, size.1).take(100_000).count(), 100_000);
        }
    }
}
