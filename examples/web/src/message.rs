use hitscan::{glam::Vec3, render::Material};

use crate::{Model, normals::normals};

/// A model as words, as the page's readers of files make it: a header, then four lists, one after the other.
///
/// | words | what |
/// |---|---|
/// | 4 | how many vertices, triangles, materials; which axis is up, 1 or 2 |
/// | 3 each | vertices, as `f32` |
/// | 3 each | triangles, as numbers of vertices |
/// | 8 each | materials: diffuse, specular, shininess, reflectivity, as `f32` |
/// | 1 each | the material of each triangle, if there are materials |
#[derive(Clone, Copy, Debug)]
pub struct Message;

impl Message {
    /// The model.
    ///
    /// # Errors
    ///
    /// A sentence for people, if the lists do not end where the words do or the mesh is none.
    pub fn read(words: &[u32]) -> Result<Model, String> {
        let model = Self::split(words).ok_or("The lists of the mesh do not fit together.")?;
        if model.triangles.is_empty() {
            return Err("The file holds no triangles.".to_owned());
        }
        hitscan::Mesh::new(&model.vertices, model.triangles.as_slice()).map_err(|error| error.to_string())?;
        let normals = normals(&model.vertices, &model.triangles);
        Ok(Model { normals, ..model }.on_the_ground())
    }

    fn split(words: &[u32]) -> Option<Model> {
        let (&[vertices, triangles, materials, up], rest) = words.split_first_chunk()?;
        let mut rest = rest;
        let mut list = |count: u32, each: usize| {
            let (list, after) = rest.split_at_checked((count as usize).checked_mul(each)?)?;
            rest = after;
            Some(list)
        };
        let [vertices, corners] = [list(vertices, 3)?, list(triangles, 3)?];
        let palette: Vec<Material> = bytemuck::pod_collect_to_vec(list(materials, 8)?);
        let numbers = list(if materials > 0 { triangles } else { 0 }, 1)?;
        if !rest.is_empty() {
            return None;
        }
        let vertices: Vec<Vec3> = bytemuck::pod_collect_to_vec(vertices);
        let triangles: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(corners);
        let mut model = Model { vertices, triangles, up, ..Model::default() };
        if palette.is_empty() {
            model.palette = vec![Model::GLAZED];
            model.numbers = vec![0; model.triangles.len()];
        } else {
            model.palette = palette;
            model.numbers = numbers.iter().map(|&number| u16::try_from(number).unwrap_or(u16::MAX)).collect();
        }
        Some(model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of one material.
    fn triangle() -> Vec<u32> {
        let floats = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_bits);
        [&[3, 1, 1, 2][..], &floats, &[0, 1, 2], &[0; 8], &[0]].concat()
    }

    #[test]
    fn whole_messages_are_taken_and_others_refused() {
        let whole = triangle();
        let model = Message::read(&whole).unwrap();
        assert_eq!((model.triangles.len(), model.axes()[0]), (3, Vec3::Z));
        assert!((0..whole.len()).all(|end| Message::read(&whole[..end]).is_err()));
        assert!(Message::read(&[&whole[..], &[0]].concat()).is_err());
    }

    #[test]
    fn any_word_in_any_place_is_taken_or_refused() {
        for place in 0..triangle().len() {
            for word in [0, 1, 2, 7, u32::MAX, f32::NAN.to_bits(), f32::MAX.to_bits()] {
                let mut damaged = triangle();
                damaged[place] = word;
                let world = Message::read(&damaged).and_then(|model| crate::World::new(model, 3, 1));
                assert!(world.is_ok() || world.is_err_and(|sentence| !sentence.is_empty()));
            }
        }
    }
}
