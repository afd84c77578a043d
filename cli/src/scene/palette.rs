use std::collections::HashMap;

use hitscan::render::{Material, Materials, Numbers};

use crate::model;

/// Materials and the number of one for each primitive.
#[derive(Clone, Debug, Default)]
pub struct Palette {
    /// The materials.
    pub materials: Vec<Material>,
    /// One for each primitive, or none if all are of the first.
    numbers: Vec<u16>,
    /// The numbers of the materials that were pushed, by their bits.
    known: HashMap<[u32; 8], u16>,
}

impl Palette {
    /// The materials of a mesh file; none if the file says nothing of any.
    pub fn of_model(materials: &[model::Material], numbers: Vec<u16>) -> Self {
        if matches!(materials, [only] if *only == model::Material::neutral(only.name.clone())) {
            return Self::default();
        }
        let convert = |material: &model::Material| Material {
            diffuse: material.diffuse.into(),
            specular: material.specular.into(),
            shininess: material.shininess,
            reflectivity: material.reflectivity.clamp(0.0, 1.0),
        };
        Self { materials: materials.iter().map(convert).collect(), numbers, known: HashMap::new() }
    }

    /// Gives a material to the next `primitives` ones; all before must have got theirs in this way.
    pub fn push(&mut self, material: Material, primitives: usize) {
        let Material { diffuse, specular, shininess, reflectivity } = material;
        let ([a, b, c], [d, e, f]) = (diffuse.to_array(), specular.to_array());
        let bits = [a, b, c, d, e, f, shininess, reflectivity].map(f32::to_bits);
        let number = *self.known.entry(bits).or_insert_with(|| {
            self.materials.push(material);
            // Beyond 65,536 materials the last serves: no file can name more.
            u16::try_from(self.materials.len() - 1).unwrap_or(u16::MAX)
        });
        self.numbers.resize(self.numbers.len() + primitives, number);
    }

    /// The same for primitives in another order.
    pub fn reordered(&self, order: &[u32]) -> Self {
        let numbers = order.iter().filter_map(|&number| self.numbers.get(number as usize).copied()).collect();
        Self { numbers, ..self.clone() }
    }

    /// The numbers, as the library and the assets take them.
    pub fn as_numbers(&self) -> Numbers<'_> {
        if self.numbers.is_empty() { Numbers::First } else { Numbers::Wide(&self.numbers) }
    }

    /// The materials by primitive.
    pub fn as_materials(&self) -> Materials<'_> {
        Materials::new(&self.materials, self.as_numbers())
    }
}

#[cfg(test)]
mod tests {
    use hitscan::glam::Vec3;

    use super::*;

    #[test]
    fn equal_materials_are_kept_once() {
        let (red, blue) = (Material::matte(Vec3::X), Material::matte(Vec3::Z));
        let mut palette = Palette::default();
        for material in [red, blue, red] {
            palette.push(material, 2);
        }
        assert_eq!(palette.materials, [red, blue]);
        let materials = palette.as_materials();
        assert_eq!([0, 1, 2, 3, 4, 5].map(|index| materials.of(index)), [red, red, blue, blue, red, red]);
    }

    #[test]
    fn a_file_without_materials_has_none() {
        let neutral = model::Material::neutral("walls");
        assert!(Palette::of_model(std::slice::from_ref(&neutral), Vec::new()).materials.is_empty());
        assert_eq!(Palette::of_model(&[neutral.clone(), neutral], vec![0, 1]).materials.len(), 2);
    }
}
