use std::{path::Path, sync::OnceLock};

use hitscan::glam::Vec3;
use sha2::{Digest, Sha256};

use crate::{
    scene::{Geometry, Palette, Source},
    shot::{Settings, rows},
};

/// What tells programs apart that may not share a picture: the version, and a hash of a small picture drawn right here,
/// which another processor or compiler would have to draw to the bit.
#[must_use]
pub fn version() -> String {
    static VERSION: OnceLock<String> = OnceLock::new();
    VERSION.get_or_init(|| format!("{}-{}", env!("CARGO_PKG_VERSION"), &probe()[..8])).clone()
}

/// The hash of the picture: a glazed tetrahedron on its plate, with shadows, highlights and mirror images.
fn probe() -> String {
    let corners =
        [Vec3::new(0.1, 0.0, 0.2), Vec3::new(1.3, 0.1, 0.0), Vec3::new(0.3, 1.1, 0.4), Vec3::new(0.2, 0.3, 1.2)];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let source = Source::Model(Geometry::new(corners.to_vec(), faces, Palette::default()));
    let settings = ["--size", "48x32", "--samples", "1", "--structure", "kdtree"].map(str::to_owned);
    let pixels = Settings::parse(&settings)
        .and_then(|settings| settings.shoot(&source, Path::new("probe"), |shot| shot.rows(rows(32, 0, 1))));
    // Where it cannot be drawn, that is what tells this version from others.
    pixels.map_or_else(|failure| hex(failure.to_string().as_bytes()), |pixels| hex(pixels.as_flattened()))
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
        // Not the hash of a failure.
        assert_eq!(probe().len(), 64);
        let nothing = hex(b"");
        assert!(nothing.starts_with("e3b0c442") && picture != &nothing[..8]);
    }
}
