//! The rays of the device comparison.

use hitscan::{Ray, glam::Vec3};

/// Rays per row of the picture.
pub const WIDTH: u32 = 64;

/// Rows of the picture.
pub const HEIGHT: u32 = 48;

/// Where the camera stands.
pub const EYE: Vec3 = Vec3::new(0.6, 0.4, -3.4);

/// The rays of a row, left to right.
pub fn row(y: u32) -> impl Iterator<Item = Ray> {
    (0..WIDTH).map(move |x| {
        let right = ((x as f32 + 0.5) / WIDTH as f32 - 0.5) * 1.2 - 0.17;
        let up = (0.5 - (y as f32 + 0.5) / HEIGHT as f32) * 0.9 - 0.12;
        Ray::new(EYE, Vec3::new(right, up, 1.0).normalize())
    })
}
