//! [`RayRecord`]: a ray as ray files hold it.
//!
//! Little-endian f32: origin and direction (24 bytes), or with an interval t_min and t_max after
//! them (32 bytes).

use std::path::Path;

use hitscan::Ray;

use crate::input::{self, InputError};
#[cfg(test)]
use crate::output::{OutputError, write_atomically};

/// A ray and where on it hits count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayRecord {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes; its length is the unit of t.
    pub direction: [f32; 3],
    /// Nearest t that counts, 0 where the file has no interval.
    pub t_min: f32,
    /// Farthest t that counts, infinity where the file has no interval.
    pub t_max: f32,
}

impl RayRecord {
    /// A ray without an end.
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        RayRecord { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }
}

impl From<&RayRecord> for Ray {
    fn from(ray: &RayRecord) -> Self {
        Ray::new(ray.origin.into(), ray.direction.into()).starting_at(ray.t_min).up_to(ray.t_max)
    }
}

/// Reads a ray file, with `interval` one whose rays carry t_min and t_max; `-` is standard input.
pub fn read_rays(path: &Path, interval: bool) -> Result<Vec<RayRecord>, InputError> {
    let bytes = input::read_records(path, size(interval), "ray")?;
    Ok(decode(&bytes, interval))
}

/// The rays that stand in some bytes; what is left over at the end is none.
pub fn decode(bytes: &[u8], interval: bool) -> Vec<RayRecord> {
    let record = size(interval);
    let rays = bytes.chunks_exact(record).map(|bytes| {
        let mut floats = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let mut next = || floats.next().unwrap_or_default();
        let ray = RayRecord::new([next(), next(), next()], [next(), next(), next()]);
        if interval { RayRecord { t_min: next(), t_max: next(), ..ray } } else { ray }
    });
    rays.collect()
}

#[cfg(test)]
/// Writes a ray file, with `interval` t_min and t_max too; `-` is standard output.
pub fn write_rays(path: &Path, rays: &[RayRecord], interval: bool) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        rays.iter().try_for_each(|ray| {
            let ([a, b, c], [d, e, f]) = (ray.origin, ray.direction);
            let bytes = [a, b, c, d, e, f, ray.t_min, ray.t_max].map(f32::to_le_bytes);
            file.write_all(&bytes.as_flattened()[..size(interval)])
        })
    })
}

/// Bytes of one ray in a file.
pub fn size(interval: bool) -> usize {
    if interval { 32 } else { 24 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rays");
        let plain = RayRecord::new([1.0, 2.0, 3.0], [-0.0, 5.0, 6.0]);
        let short = RayRecord { t_min: 0.5, t_max: 7.0, ..plain };
        write_rays(&path, &[plain, short], true).unwrap();
        assert_eq!(read_rays(&path, true).unwrap(), [plain, short]);
        write_rays(&path, &[plain, short], false).unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().len(), 48);
        assert_eq!(read_rays(&path, false).unwrap(), [plain, plain]);
    }

    #[test]
    fn a_ragged_file_is_measured() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rays");
        std::fs::write(&path, [0; 50]).unwrap();
        let complaint = |interval| read_rays(&path, interval).unwrap_err().to_string();
        assert!(complaint(false).contains("50 bytes are not a whole number of rays of 24 bytes, 2 are left"));
        assert!(complaint(true).contains("rays of 32 bytes, 18 are left over: check"));
    }
}
