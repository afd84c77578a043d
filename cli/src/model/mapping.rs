//! [`Mapping`]: where in the pictures of materials triangles lie.

use super::{Fault, Model, fan};

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

/// Makes sure that all triangles whose materials have pictures have coordinates: the others get their material
/// without it, and that is said. Without pictures nothing is kept.
pub(super) fn settle(model: &mut Model) -> Result<(), Fault> {
    if model.materials.iter().all(|material| material.image.is_none()) {
        model.mapping = Mapping::default();
        return Ok(());
    }
    model.material_ids.resize(model.triangles.len(), 0);
    model.mapping.corners.resize(model.triangles.len(), [Mapping::NONE; 3]);
    // The material without its picture, for each that needs one.
    let mut plain = vec![None; model.materials.len()];
    let mut bare = 0;
    for triangle in 0..model.triangles.len() {
        let id = usize::from(model.material_ids[triangle]);
        let material = &model.materials[id];
        if material.image.is_none() || model.mapping.of(triangle).is_some() {
            continue;
        }
        bare += 1;
        let without = super::Material { image: None, ..material.clone() };
        model.material_ids[triangle] = match plain[id] {
            Some(known) => known,
            None => *plain[id].insert(model.push_material(without)?),
        };
    }
    if bare > 0 {
        let of = model.triangles.len();
        model.warnings.push(format!("{bare} of {of} triangles lack texture coordinates: drawn without their textures"));
    }
    Ok(())
}
