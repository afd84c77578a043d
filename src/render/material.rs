use glam::Vec3;

use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
};

/// How a surface answers light. Phong, *Illumination for computer generated pictures*, 1975.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Material {
    /// Linear red, green, blue scattered in all directions, also of the ambient light.
    pub diffuse: Vec3,
    /// Linear red, green, blue of highlights.
    pub specular: Vec3,
    /// How small highlights are: the exponent of their cosine.
    pub shininess: f32,
    /// The share of light that comes from the mirrored direction, 0 … 1.
    pub reflectivity: f32,
}

impl Material {
    /// A material that only scatters.
    #[must_use]
    pub const fn matte(diffuse: Vec3) -> Self {
        Self { diffuse, specular: Vec3::ZERO, shininess: 1.0, reflectivity: 0.0 }
    }

    /// The same with white highlights.
    #[must_use]
    pub const fn with_highlights(self, strength: f32, shininess: f32) -> Self {
        Self { specular: Vec3::splat(strength), shininess, ..self }
    }

    /// The same with a mirror image.
    #[must_use]
    pub const fn with_reflectivity(self, reflectivity: f32) -> Self {
        Self { reflectivity, ..self }
    }
}

/// Light grey with faint highlights.
impl Default for Material {
    fn default() -> Self {
        Self::matte(Vec3::splat(0.7)).with_highlights(0.2, 30.0)
    }
}

/// Which primitive is of which material: numbers into a palette.
#[derive(Clone, Copy, Debug)]
pub struct Materials<'a> {
    palette: &'a [Material],
    numbers: Numbers<'a>,
}

/// Material numbers by primitive.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// All primitives are of the first material.
    First,
    /// One byte per primitive.
    Narrow(&'a [u8]),
    /// Two bytes per primitive.
    Wide(&'a [u16]),
}

impl<'a> Materials<'a> {
    /// The materials of a palette by primitive; [`Material::default`] where a number names none.
    ///
    /// ```
    /// use hitscan::{glam::Vec3, render::{Material, Materials, Numbers}};
    /// let palette = [Material::matte(Vec3::X), Material::matte(Vec3::Y)];
    /// let materials = Materials::new(&palette, Numbers::Narrow(&[0, 1, 1]));
    /// assert_eq!(materials.of(2), palette[1]);
    /// ```
    #[must_use]
    pub const fn new(palette: &'a [Material], numbers: Numbers<'a>) -> Self {
        Self { palette, numbers }
    }

    /// The material of a primitive.
    #[must_use]
    pub fn of(&self, primitive: u32) -> Material {
        self.number(primitive).and_then(|number| self.palette.get(number as usize)).copied().unwrap_or_default()
    }

    /// The number of the material of a primitive.
    #[must_use]
    pub fn number(&self, primitive: u32) -> Option<u32> {
        let index = primitive as usize;
        match self.numbers {
            Numbers::First => Some(0),
            Numbers::Narrow(numbers) => numbers.get(index).map(|&number| number.into()),
            Numbers::Wide(numbers) => numbers.get(index).map(|&number| number.into()),
        }
    }
}

/// Everything of [`Material::default`].
impl Default for Materials<'_> {
    fn default() -> Self {
        Self { palette: &[], numbers: Numbers::First }
    }
}

/// The sections of materials and, unless all primitives are of the first, of their numbers.
impl<'a> Stored<'a> for Materials<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Materials)?;
        let shape = |kind, words: &[u32]| AssetError::Shape { kind, words: words.len() };
        let palette = bytemuck::try_cast_slice(words).map_err(|_| shape(Kind::Materials, words))?;
        let numbers = match asset.section(Kind::MaterialNumbers) {
            Err(_) => Numbers::First,
            Ok(words) => {
                let error = shape(Kind::MaterialNumbers, words);
                let (&count, words) = words.split_first().ok_or(error)?;
                let halves: &[u16] = bytemuck::try_cast_slice(words).map_err(|_| error)?;
                if (count as usize).next_multiple_of(2) != halves.len() {
                    return Err(error.into());
                }
                Numbers::Wide(halves.get(..count as usize).ok_or(error)?)
            }
        };
        Ok(Self::new(palette, numbers))
    }
}
