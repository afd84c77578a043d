use std::ops::Range;

use hitscan_cli::rows;
use serde::{Deserialize, Serialize};

use crate::files::hash;

/// The most bytes of a tile's result: the server takes 1 MiB.
const MOST: u64 = 512 << 10;

/// Work to be shared: all on which its bytes depend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// The version of the program that must do it.
    pub version: String,
    /// The SHA-256 of the asset.
    pub asset: String,
    /// What to do with it.
    pub work: Work,
    /// In how many tiles.
    pub tiles: u32,
}

/// What there is to do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// A picture, of the settings of `hitscan render`; a tile is some rows of RGB pixels.
    Picture { settings: Vec<String>, width: u32, height: u32 },
    /// The hits of rays, by the settings of `hitscan cast`; a tile is some of the rays' hits.
    Hits { casting: Vec<String>, rays: String, count: u64 },
}

impl Work {
    /// Tiles that are neither so small that messages cost more than the work, nor so large that workers wait at the end.
    pub fn tiles(&self) -> u32 {
        match *self {
            Self::Picture { width, height, .. } => {
                let rows = (MOST / (3 * u64::from(width)).max(1)).clamp(1, 8);
                u64::from(height).div_ceil(rows) as u32
            }
            Self::Hits { count, .. } => count.div_ceil(MOST / 8 / 4).max(1) as u32,
        }
    }
}

impl Job {
    /// Its name: the same work has the same.
    pub fn id(&self) -> String {
        let text = serde_json::to_vec(self).unwrap_or_default();
        hash(&text)[..16].to_owned()
    }

    /// What of the whole a tile is: rows of pixels, or rays.
    pub fn share(&self, tile: u32) -> Range<u64> {
        match self.work {
            Work::Picture { height, .. } => {
                let rows = rows(height, tile, self.tiles);
                rows.start.into()..rows.end.into()
            }
            Work::Hits { count, .. } => {
                let edge = |n: u32| (u128::from(n) * u128::from(count) / u128::from(self.tiles.max(1))) as u64;
                edge(tile)..edge(tile + 1)
            }
        }
    }

    /// Bytes of the result by row or ray.
    pub fn unit(&self) -> u64 {
        match self.work {
            Work::Picture { width, .. } => u64::from(width) * 3,
            Work::Hits { .. } => 8,
        }
    }

    /// Where in the whole result a tile's bytes are.
    pub fn bytes(&self, tile: u32) -> Range<usize> {
        let share = self.share(tile);
        (share.start * self.unit()) as usize..(share.end * self.unit()) as usize
    }

    /// For people.
    pub fn describe(&self) -> String {
        match &self.work {
            Work::Picture { width, height, .. } => format!("picture of {width}x{height}"),
            Work::Hits { count, .. } => format!("hits of {count} rays"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_whole_once_and_fit_into_messages() {
        let picture = |width, height| Work::Picture { settings: Vec::new(), width, height };
        let hits = |count| Work::Hits { casting: Vec::new(), rays: String::new(), count };
        for work in [picture(1, 1), picture(1920, 1080), picture(65_535, 9), hits(0), hits(1), hits(1_000_003)] {
            let tiles = work.tiles();
            let job = Job { version: String::new(), asset: String::new(), work, tiles };
            let mut next = 0;
            for tile in 0..tiles {
                let bytes = job.bytes(tile);
                assert_eq!(bytes.start, next);
                assert!(bytes.len() as u64 <= MOST, "{job:?}");
                next = bytes.end;
            }
            let whole = match job.work {
                Work::Picture { width, height, .. } => width as usize * height as usize * 3,
                Work::Hits { count, .. } => count as usize * 8,
            };
            assert_eq!(next, whole);
        }
    }

    #[test]
    fn other_work_has_another_name() {
        let work = Work::Hits { casting: Vec::new(), rays: "r".to_owned(), count: 9 };
        let job = Job { version: "1".to_owned(), asset: "a".to_owned(), work, tiles: 3 };
        assert_eq!(job.id(), job.clone().id());
        assert_ne!(job.id(), Job { version: "2".to_owned(), ..job.clone() }.id());
        assert_ne!(job.id(), Job { asset: "b".to_owned(), ..job }.id());
    }
}
