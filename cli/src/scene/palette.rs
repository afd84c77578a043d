use hitscan::render::{Material, Materials, Numbers};

use crate::model;

/// Materials and the number of one for each primitive.
#[derive(Clone, Debug, Default)]
pub struct Palette {
    /// The materials.
    pub materials: Vec<Material>,
    /// One for each primitive, or none if all are of the first.
    pub numbers: Vec<u16>,
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
        Self { materials: materials.iter().map(convert).collect(), numbers }
    }

    /// Adds a material and gives it to the next `primitives` ones; `self` must hold a number for each one before.
    pub fn push(&mut self, material: Material, primitives: usize) {
        let number = self.materials.iter().position(|known| *known == material).unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        });
        // Beyond 65,536 materials the last serves: no file can name more.
        let number = u16::try_from(number).unwrap_or(u16::MAX);
        self.numbers.resize(self.numbers.len() + primitives, number);
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
