use glam::Vec3;

use super::unit;
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
    math,
};

/// The normals of a mesh's vertices, each as a point of an octahedron in 2 bytes.
///
/// Praun and Hoppe, *Spherical parametrization and remeshing*, 2003. A normal is at most one degree off, which is less than
/// what colours of 16 bits show; `bake::Baker::normals` stores them.
#[derive(Clone, Copy, Debug)]
pub struct Normals<'a> {
    /// Two per word, the lower half first.
    words: &'a [u32],
    count: u32,
}

/// Steps from the middle of the octahedron's square to its edge.
const STEPS: f32 = 127.0;

/// Both coordinates of no normal: one step beyond the corner.
const NONE: u16 = u16::from_le_bytes([0x80; 2]);

impl Normals<'_> {
    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> u32 {
        self.count
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// That of a vertex, of length 1; zero of one that has none.
    #[must_use]
    pub fn get(&self, vertex: u32) -> Vec3 {
        let word = if vertex < self.count { self.words.get((vertex / 2) as usize) } else { None };
        word.map_or(Vec3::ZERO, |word| unpacked((word >> (vertex % 2 * 16)) as u16))
    }

    /// A normal in 16 bits; zero, or what is no number, is no normal.
    #[must_use]
    pub fn packed(normal: Vec3) -> u16 {
        // By the largest first, so that the sum does not overflow.
        let normal = normal / normal.abs().max_element();
        let normal = normal / (normal.x.abs() + normal.y.abs() + normal.z.abs());
        if !normal.is_finite() {
            return NONE;
        }
        let (x, y) = if normal.z < 0.0 { folded(normal.x, normal.y) } else { (normal.x, normal.y) };
        u16::from_le_bytes([x, y].map(|side| (math::floor(side * STEPS + 0.5) as i8).to_le_bytes()[0]))
    }
}

/// The lower half of the octahedron around the upper one.
fn folded(x: f32, y: f32) -> (f32, f32) {
    ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y))
}

fn unpacked(bits: u16) -> Vec3 {
    if bits == NONE {
        return Vec3::ZERO;
    }
    let [x, y] = bits.to_le_bytes().map(|side| f32::from(i8::from_le_bytes([side])) / STEPS);
    let z = 1.0 - x.abs() - y.abs();
    let (x, y) = if z < 0.0 { folded(x, y) } else { (x, y) };
    unit(Vec3::new(x, y, z))
}

/// The section of normals.
impl<'a> Stored<'a> for Normals<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Normals)?;
        let error = AssetError::Shape { kind: Kind::Normals, words: words.len() };
        let (&count, words) = words.split_first().ok_or(error)?;
        if count.div_ceil(2) as usize != words.len() {
            return Err(error.into());
        }
        Ok(Self { words, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, cases, every};

    #[test]
    fn a_normal_is_at_most_a_degree_off() {
        let mut random = Random::new(3);
        let mut worst = 1.0_f32;
        for round in 0..cases(200_000) {
            let mut normal = Vec3::from_array([0; 3].map(|_| random.unit() - 0.5));
            if round % 4 == 0 {
                // Near an edge of the octahedron.
                normal.z *= 1.0e-3;
            }
            let Some(normal) = normal.try_normalize() else { continue };
            worst = worst.min(unpacked(Normals::packed(normal)).dot(normal));
        }
        let degrees = worst.acos().to_degrees();
        assert!(degrees < 1.0, "{degrees}");
    }

    #[test]
    fn axes_are_exact_and_any_bits_a_direction() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for normal in [axis, -axis] {
                assert_eq!(unpacked(Normals::packed(normal * 5.0)), normal);
            }
        }
        for length in [f32::MAX, 1.0e-38] {
            let normal = unpacked(Normals::packed(Vec3::new(length, length, 0.0)));
            assert!((normal - Vec3::new(0.5, 0.5, 0.0).normalize()).length() < 0.02, "{normal}");
        }
        for none in [Vec3::ZERO, Vec3::NAN, Vec3::new(f32::INFINITY, 0.0, 1.0)] {
            assert_eq!(unpacked(Normals::packed(none)), Vec3::ZERO);
        }
        for bits in (0..=u16::MAX).step_by(every(1)).filter(|&bits| bits != NONE) {
            assert!((unpacked(bits).length() - 1.0).abs() < 1.0e-6, "{bits:#x}");
        }
    }
}
