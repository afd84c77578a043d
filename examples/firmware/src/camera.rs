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
        let (right, up) = place(x, y);
        Ray::new(EYE, Vec3::new(right, up, 1.0).normalize())
    })
}

/// Where a ray is in the picture.
fn place(x: u32, y: u32) -> (f32, f32) {
    let right = ((x as f32 + 0.5) / WIDTH as f32 - 0.5) * 1.2 - 0.17;
    (right, (0.5 - (y as f32 + 0.5) / HEIGHT as f32) * 0.9 - 0.12)
}

/// A row of rays.
pub type Row = [Ray; WIDTH as usize];

/// A row of a scanner that sees one level at a time and rises from row to row: about the picture of the camera.
pub fn level(y: u32) -> Row {
    let mut x = 0_u32..;
    [(); WIDTH as usize].map(|()| {
        let (right, up) = place(x.next().unwrap_or(0), y);
        Ray::new(EYE + Vec3::Y * (up * DISTANCE), Vec3::new(right, 0.0, 1.0).normalize())
    })
}

/// A row of a camera whose rays are parallel to an axis: about the picture of the camera.
pub fn parallel(y: u32) -> Row {
    let mut x = 0_u32..;
    [(); WIDTH as usize].map(|()| {
        let (right, up) = place(x.next().unwrap_or(0), y);
        Ray::new(EYE + Vec3::new(right, up, 0.0) * DISTANCE, Vec3::Z)
    })
}

/// How far the knot's middle is from the camera.
const DISTANCE: f32 = 3.4;
