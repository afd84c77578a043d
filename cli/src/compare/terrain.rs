use hitscan::glam::Vec3;

use crate::scene::{Geometry, Palette};

/// Hills over a square: `count` triangles of nearly one size, the same bits every time.
pub fn terrain(count: u32) -> Geometry {
    let side = (f64::from(count) / 2.0).sqrt().ceil().max(1.0) as u32;
    let place = |i: u32| i as f32 / side as f32;
    let corners = (0..=side).flat_map(|j| (0..=side).map(move |i| (place(i), place(j))));
    let vertices = corners.map(|(x, z)| Vec3::new(x, height(x, z), z)).collect();
    let squares = (0..side).flat_map(|j| (0..side).map(move |i| j * (side + 1) + i));
    let halves = |a: u32| {
        let (b, c, d) = (a + 1, a + side + 1, a + side + 2);
        [[a, c, b], [b, c, d]]
    };
    Geometry::new(vertices, squares.flat_map(halves).take(count as usize).collect(), Palette::default())
}

/// Hills on hills, four sizes of them.
fn height(x: f32, z: f32) -> f32 {
    let octave = |k: f32, high: f32| high * (wave(x * k) * wave(z * k * 1.3 + 0.2) + wave((x - z) * k * 0.7));
    octave(1.1, 0.06) + octave(3.0, 0.02) + octave(8.4, 0.006) + octave(24.0, 0.002)
}

/// A wave of period 1 between -1 and 1 from two parabolas: sines are not the same on every machine.
fn wave(at: f32) -> f32 {
    let at = at - at.floor();
    let half = if at < 0.5 { at } else { at - 0.5 };
    let arch = 16.0 * half * (0.5 - half);
    if at < 0.5 { arch } else { -arch }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_triangles_can_be_had() {
        for count in [1, 2, 7, 1000] {
            let geometry = terrain(count);
            assert_eq!(geometry.len(), count as usize);
            assert!(geometry.mesh().is_ok());
        }
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0, -0.25].map(wave), [0.0, 1.0, 0.0, -1.0, 0.0, -1.0]);
    }
}
