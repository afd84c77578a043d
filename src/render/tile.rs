/// A rectangle of pixels, of a picture whose upper left pixel is (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tile {
    /// The leftmost column.
    pub x: u32,
    /// The uppermost row.
    pub y: u32,
    /// How many columns.
    pub width: u32,
    /// How many rows.
    pub height: u32,
}

impl Tile {
    /// How many pixels it has.
    #[must_use]
    pub const fn area(&self) -> usize {
        (self.width as usize).saturating_mul(self.height as usize)
    }

    /// It in tiles of at most this size.
    pub fn parts(self, width: u32, height: u32) -> impl Iterator<Item = Self> {
        let Self { x, y, .. } = self;
        Tiles::new(self.width, self.height, width, height).map(move |part| Self {
            x: x.saturating_add(part.x),
            y: y.saturating_add(part.y),
            ..part
        })
    }

    /// The coordinates of its pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        let columns = self.x..self.x.saturating_add(self.width);
        (self.y..self.y.saturating_add(self.height)).flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }
}

/// The tiles of a picture, row by row; those at the right and lower edges may be smaller.
///
/// ```
/// use hitscan::render::Tiles;
/// let tiles = Tiles::new(5, 3, 4, 2);
/// assert_eq!(tiles.map(|tile| tile.area()).collect::<Vec<_>>(), [8, 2, 4, 1]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Tiles {
    width: u32,
    height: u32,
    tile_width: u32,
    tile_height: u32,
    x: u32,
    y: u32,
}

impl Tiles {
    /// A picture of `width` x `height` in tiles of at most `tile_width` x `tile_height`, which are at least 1.
    #[must_use]
    pub fn new(width: u32, height: u32, tile_width: u32, tile_height: u32) -> Self {
        Self { width, height, tile_width: tile_width.max(1), tile_height: tile_height.max(1), x: 0, y: 0 }
    }
}

impl Iterator for Tiles {
    type Item = Tile;

    fn next(&mut self) -> Option<Tile> {
        if self.x >= self.width {
            self.x = 0;
            self.y = self.y.saturating_add(self.tile_height);
        }
        if self.y >= self.height || self.width == 0 {
            return None;
        }
        let (x, y) = (self.x, self.y);
        self.x = x.saturating_add(self.tile_width);
        Some(Tile { x, y, width: self.tile_width.min(self.width - x), height: self.tile_height.min(self.height - y) })
    }
}
