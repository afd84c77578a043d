//! [`Mapping`]: where in the pictures of materials triangles lie.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::{Fault, Material, Model, fan};

/// Texture coordinates of the corners of triangles.
#[derive(Clone, Debug, Default)]
pub struct Mapping {
    /// (0, 0) is the upper left corner of a picture, (1, 1) the lower right one.
    pub coordinates: Vec<[f32; 2]>,
    /// Three numbers of `coordinates` for each triangle; `NONE` where a corner has none.
    pub corners: Vec<[u32; 3]>,
}

impl Mapping {
    /// The number of a corner that has no coordinates.
    pub const NONE: u32 = u32::MAX;

    /// Those of a polygon that is cut as [`Model::push_polygon`] does, behind so many triangles.
    pub(super) fn push_polygon(&mut self, triangles: usize, places: &[u32]) {
        if places.iter().any(|place| *place != Self::NONE) {
            self.corners.resize(triangles, [Self::NONE; 3]);
            self.corners.extend(fan(places));
        }
    }

    /// The coordinates of a triangle's corners, if all have some.
    pub fn of(&self, triangle: usize) -> Option<[[f32; 2]; 3]> {
        let at = |place: u32| self.coordinates.get(place as usize).filter(|at| at.iter().all(|x| x.is_finite()));
        let [a, b, c] = *self.corners.get(triangle)?;
        Some([*at(a)?, *at(b)?, *at(c)?])
    }
}

impl Model {
    /// Gives the triangles that lack coordinates, of the materials of which `is_pictured` is true, their material without
    /// its picture; how many there are is said in the warnings.
    pub fn settle(&mut self, is_pictured: impl Fn(u16) -> bool) -> Result<(), Fault> {
        // The material without its picture, for each that needs one.
        let mut plain = HashMap::new();
        let mut bare = 0;
        for triangle in 0..self.triangles.len() {
            let id = self.material(triangle);
            if !is_pictured(id) || self.mapping.of(triangle).is_some() {
                continue;
            }
            bare += 1;
            let without = match plain.entry(id) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    let material = Material { image: None, ..self.materials[usize::from(id)].clone() };
                    *new.insert(self.push_material(material)?)
                }
            };
            self.material_ids.resize(self.triangles.len(), 0);
            self.material_ids[triangle] = without;
        }
        if bare > 0 {
            let of = self.triangles.len();
            self.warnings.push(format!(
                "{bare} of {of} triangles lack texture coordinates, and go without their textures: unwrap them where the \
                 model was made"
            ));
        }
        Ok(())
    }

    /// The number of a triangle's material.
    pub fn material(&self, triangle: usize) -> u16 {
        self.material_ids.get(triangle).copied().unwrap_or(0)
    }
}
