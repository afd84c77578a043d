use hitscan::render::{Tile, Tiles};

/// Pixels along a side of a tile, and of the coarsest block.
const TILE: u32 = 32;
const COARSEST: u32 = 8;

/// A pixel to be drawn, and how far its colour goes until finer ones come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The column.
    pub x: u32,
    /// The row.
    pub y: u32,
    /// Pixels along a side.
    pub size: u32,
}

/// The pixels of a picture in an order in which it is coarse first: every 8th pixel of every 8th row, then every 4th, 2nd
/// and each, in every pass tile by tile. No pixel comes twice.
#[derive(Clone, Debug)]
pub struct Order {
    width: u32,
    height: u32,
    /// What is left of the pass.
    tiles: Tiles,
    tile: Tile,
    size: u32,
    /// Blocks of the tile that were passed.
    passed: u32,
}

impl Order {
    /// That of a picture of this size.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self { size: COARSEST, ..Self::again(width, height) }
    }

    /// Each pixel once more, tile by tile.
    #[must_use]
    pub fn again(width: u32, height: u32) -> Self {
        let mut tiles = Tiles::new(width, height, TILE, TILE);
        let tile = tiles.next().unwrap_or(Tile { x: 0, y: 0, width: 0, height: 0 });
        Self { width, height, tiles, tile, size: 0, passed: 0 }
    }

    /// The tile of the next block.
    #[must_use]
    pub const fn tile(&self) -> Tile {
        self.tile
    }

    /// The size of the next block; 0 if every pixel was drawn and this is once more.
    #[must_use]
    pub const fn size(&self) -> u32 {
        self.size
    }

    /// Goes on to the next tile, or the next pass; whether there is one.
    fn advance(&mut self) -> bool {
        self.passed = 0;
        if let Some(tile) = self.tiles.next() {
            self.tile = tile;
            return true;
        }
        let finer = self.size / 2;
        if finer > 0 {
            *self = Self { size: finer, ..Self::again(self.width, self.height) };
        }
        finer > 0
    }

    /// The next block of this tile.
    fn next_in_tile(&mut self) -> Option<Block> {
        let size = self.size.max(1);
        let columns = self.tile.width.div_ceil(size).max(1);
        loop {
            let (column, row) = (self.passed % columns, self.passed / columns);
            if row * size >= self.tile.height {
                return None;
            }
            self.passed += 1;
            // Coarser passes drew the even ones.
            let drawn = (1..COARSEST).contains(&self.size) && column % 2 == 0 && row % 2 == 0;
            if !drawn {
                return Some(Block { x: self.tile.x + column * size, y: self.tile.y + row * size, size });
            }
        }
    }

    /// Offers blocks to `draw`, up to the end of a tile or so many; how many, 0 at the end of the picture.
    pub fn step(&mut self, blocks: u32, mut draw: impl FnMut(Block)) -> u32 {
        let mut drawn = 0;
        while drawn < blocks {
            match self.next_in_tile() {
                Some(block) => {
                    draw(block);
                    drawn += 1;
                }
                // What is left of a tile may be nothing: then the next is begun.
                None if drawn > 0 || !self.advance() => break,
                None => {}
            }
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_comes_once_and_the_coarse_ones_first() {
        for (width, height) in [(1, 1), (7, 33), (8, 8), (65, 40), (0, 5), (5, 0), (33, 1)] {
            let mut seen = vec![0_u8; (width * height) as usize];
            let mut order = Order::new(width, height);
            let mut last = COARSEST;
            let draw = |block: Block, seen: &mut Vec<u8>| {
                assert!(block.x < width && block.y < height);
                seen[(block.y * width + block.x) as usize] += 1;
            };
            while order.step(13, |block| {
                assert!(block.size <= last);
                last = block.size;
                draw(block, &mut seen);
            }) > 0
            {}
            assert!(seen.iter().all(|&times| times == 1), "{width} x {height}");
            let mut again = Order::again(width, height);
            while again.step(u32::MAX, |block| draw(block, &mut seen)) > 0 {}
            assert!(seen.iter().all(|&times| times == 2), "{width} x {height}");
        }
    }
}
