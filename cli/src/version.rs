use std::{path::Path, sync::OnceLock};

use hitscan::glam::Vec3;
use sha2::{Digest, Sha256};

use crate::{
    failure::Failure,
    scene::{Geometry, Palette, Source},
    shot::{Settings, rows},
};

/// What tells programs apart that may not share a picture: the version, and a hash of a small picture drawn right here,
/// which another processor or compiler would have to draw to the bit.
#[must_use]
pub fn version() -> String {
    static VERSION: OnceLock<String> = OnceLock::new();
    let version = || {
        // Where nothing can be drawn, that is what tells this version from others.
        let picture = probe().unwrap_or_else(|failure| hex(failure.to_string().as_bytes()));
        format!("{}-{}", env!("CARGO_PKG_VERSION"), &picture[..8])
    };
    VERSION.get_or_init(version).clone()
}

/// The hash of the picture: a glazed tetrahedron on its plate, with shadows, highlights and mirror images.
fn probe() -> Result<String, Failure> {
    let corners =
        [Vec3::new(0.1, 0.0, 0.2), Vec3::new(1.3, 0.1, 0.0), Vec3::new(0.3, 1.1, 0.4), Vec3::new(0.2, 0.3, 1.2)];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let source = Source::Model(Geometry::new(corners.to_vec(), faces, Palette::default()));
    let settings = ["--size", "48x32", "--samples", "1", "--structure", "kdtree"].map(str::to_owned);
    let settings = Settings::parse(&settings)?;
    let pixels = settings.shoot(&source, Path::new("probe"), |shot| shot.rows(rows(32, 0, 1)))?;
    Ok(hex(pixels.as_flattened()))
}

/// The SHA-256 of some bytes in hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_version_has_a_picture() {
        let version = version();
        let (number, picture) = version.rsplit_once('-').unwrap();
        assert_eq!(number, env!("CARGO_PKG_VERSION"));
        assert!(picture.len() == 8 && picture.chars().all(|c| c.is_ascii_hexdigit()));
        assert!(probe().unwrap().starts_with(picture));
    }
}
