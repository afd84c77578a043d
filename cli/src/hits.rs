//! [`HitRecord`]: the answer to a ray as hit files hold it.
//!
//! Per ray a little-endian f32 t and a u32 primitive (8 bytes); a miss is t = infinity and
//! primitive = 0xffffffff.

use std::path::Path;

use crate::input::{self, InputError};
use crate::output::{OutputError, write_atomically};

/// A hit or a miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitRecord {
    /// Where on the ray, in lengths of its direction.
    pub t: f32,
    /// The triangle, counted from 0 in the order of the file, which is an asset's own unless that keeps its model's numbers.
    pub primitive: u32,
}

impl HitRecord {
    /// The ray hits nothing.
    pub const MISS: HitRecord = HitRecord { t: f32::INFINITY, primitive: u32::MAX };

    /// Whether the ray hits nothing.
    pub fn is_miss(self) -> bool {
        self.primitive == u32::MAX
    }

    /// As it stands in a file.
    pub fn to_bytes(self) -> [u8; 8] {
        (u64::from(self.primitive) << 32 | u64::from(self.t.to_bits())).to_le_bytes()
    }
}

/// Reads a hit file; `-` is standard input.
pub fn read_hits(path: &Path) -> Result<Vec<HitRecord>, InputError> {
    let bytes = input::read_records(path, 8, "hit")?;
    let hits = bytes.chunks_exact(8).map(|b| HitRecord {
        t: f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        primitive: u32::from_le_bytes([b[4], b[5], b[6], b[7]]),
    });
    Ok(hits.collect())
}

/// Writes a hit file; `-` is standard output.
pub fn write_hits(path: &Path, hits: &[HitRecord]) -> Result<(), OutputError> {
    write_atomically(path, |file| hits.iter().try_for_each(|hit| file.write_all(&hit.to_bytes())))
}

/// Writes the hits as lines of `columns`, what `cells` makes of each ray's answer; `-` is standard output.
pub fn write_csv(
    path: &Path,
    hits: &[HitRecord],
    columns: &str,
    cells: impl Fn(&HitRecord) -> String,
) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        writeln!(file, "ray,{columns}")?;
        hits.iter().enumerate().try_for_each(|(ray, hit)| writeln!(file, "{ray},{}", cells(hit)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HITS: [HitRecord; 2] = [HitRecord { t: 0.1, primitive: 7 }, HitRecord::MISS];

    #[test]
    fn hits_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hits");
        write_hits(&path, &HITS).unwrap();
        assert_eq!(read_hits(&path).unwrap(), HITS);
        std::fs::write(&path, [0; 9]).unwrap();
        let error = read_hits(&path).unwrap_err().to_string();
        assert!(error.contains("9 bytes are not a whole number of hits of 8 bytes, 1 are left"));
        let missing = read_hits(&folder.path().join("none")).unwrap_err().to_string();
        assert!(missing.ends_with("none: no such file: check the path"));
    }

    #[test]
    fn lines_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hits.csv");
        write_csv(&path, &HITS, "t", |hit| hit.t.to_string()).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "ray,t\n0,0.1\n1,inf\n");
    }
}
