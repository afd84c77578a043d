use std::{fmt, ops::Range, str::FromStr};

/// The rows of tile `tile` of a picture of `height` rows that is divided into `of` tiles: all rows fall to one tile each.
#[must_use]
pub fn rows(height: u32, tile: u32, of: u32) -> Range<u32> {
    let edge = |n: u32| (u64::from(n) * u64::from(height) / u64::from(of.max(1))) as u32;
    edge(tile)..edge(tile.saturating_add(1)).min(height)
}

/// Some of the tiles of a picture, counted from 0: `A..B` without B, or one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiles {
    /// The first.
    pub start: u32,
    /// The one after the last.
    pub end: u32,
}

impl Tiles {
    /// Their rows of a picture of `height` rows in `of` tiles.
    #[must_use]
    pub fn rows(self, height: u32, of: u32) -> Range<u32> {
        rows(height, self.start, of).start..rows(height, self.end, of).start
    }
}

impl FromStr for Tiles {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok();
        let tiles = match text.split_once("..") {
            Some((start, end)) => number(start).zip(number(end)),
            None => number(text).and_then(|only: u32| Some((only, only.checked_add(1)?))),
        };
        let tiles = tiles.filter(|(start, end)| start < end).map(|(start, end)| Self { start, end });
        tiles.ok_or_else(|| "give A..B, the tiles from A to before B, or one tile; they count from 0".to_owned())
    }
}

impl fmt::Display for Tiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.start, self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_falls_to_one_tile() {
        for (height, of) in [(1, 1), (7, 3), (3, 7), (65_535, 1000), (10, 10), (5, u32::MAX)] {
            let mut next = 0;
            for tile in 0..of.min(2000) {
                let rows = rows(height, tile, of);
                assert_eq!(rows.start, next);
                next = rows.end;
            }
            assert!(of > 2000 || next == height);
            assert_eq!(Tiles { start: 0, end: of }.rows(height, of), 0..height);
        }
    }

    #[test]
    fn ranges_are_read_or_refused() {
        assert_eq!("3..5".parse(), Ok(Tiles { start: 3, end: 5 }));
        assert_eq!("3".parse(), Ok(Tiles { start: 3, end: 4 }));
        for bad in ["", "..", "3..", "..5", "5..5", "5..3", "-1..2", "a", "4294967295"] {
            assert!(bad.parse::<Tiles>().is_err(), "{bad}");
        }
    }
}
