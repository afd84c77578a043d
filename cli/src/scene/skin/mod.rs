mod picture;

use std::{collections::HashMap, sync::Arc};

use hitscan::{
    bake::{Baker, InMeshlets},
    glam::Vec2,
    render::{Filter, Texture, Wrap},
};

use self::picture::Picture;
use crate::model::{Contents, Fault, Mapping, Model};

/// The pictures on a mesh, as an asset stores them.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Where in its picture each vertex lies.
    coordinates: Vec<Vec2>,
    /// By the numbers of the materials.
    sheets: Vec<Option<Sheet>>,
}

/// A picture as it lies on a material.
#[derive(Clone, Debug)]
struct Sheet {
    picture: Arc<Picture>,
    filter: Filter,
    wrap: Wrap,
}

impl Skin {
    /// That of a model, whose vertices are divided where pictures have seams; none if no material has a picture that
    /// can be read. Pictures have at most so many pixels along a side; what is wrong with them is added to the warnings.
    ///
    /// # Errors
    ///
    /// There are too many materials to add those of triangles without coordinates.
    pub fn of_model(model: &mut Model, most: u16) -> Result<Option<Self>, Fault> {
        // Many materials may have the same one.
        let mut known: HashMap<&Contents, Option<Arc<Picture>>> = HashMap::new();
        let mut warnings = Vec::new();
        let mut read = |contents| match model.read_picture(contents).and_then(|bytes| Picture::decode(&bytes, most)) {
            Ok(picture) => Some(Arc::new(picture)),
            Err(why) => {
                warnings.push(format!("without texture {contents}: {why}"));
                None
            }
        };
        let sheets = model.materials.iter().map(|material| {
            let image = material.image.as_ref()?;
            let picture = known.entry(&image.contents).or_insert_with_key(|contents| read(contents)).clone()?;
            let filter = if image.nearest { Filter::Nearest } else { Filter::Bilinear };
            let wrap = if image.clamp { Wrap::Clamp } else { Wrap::Repeat };
            Some(Sheet { picture, filter, wrap })
        });
        let sheets: Vec<Option<Sheet>> = sheets.collect();
        model.warnings.append(&mut warnings);
        if sheets.iter().all(Option::is_none) {
            return Ok(None);
        }
        let is_pictured = |material: u16| sheets.get(usize::from(material)).is_some_and(Option::is_some);
        model.settle(is_pictured)?;
        let coordinates = unfold(model, is_pictured);
        Ok(Some(Self { coordinates, sheets }))
    }

    /// That of the same vertices in the order that meshlets take.
    pub fn ordered<const CORNERS: usize>(&self, meshlets: &InMeshlets<CORNERS>) -> Self {
        Self { coordinates: meshlets.vertices(&self.coordinates), sheets: self.sheets.clone() }
    }

    /// Adds its sections to those of a mesh.
    pub fn bake(&self, baker: Baker) -> Baker {
        let textures: Vec<Option<Texture<'_>>> = self
            .sheets
            .iter()
            .map(|sheet| {
                let Sheet { picture, filter, wrap } = sheet.as_ref()?;
                Some(picture.texture()?.with_filter(*filter).with_wrap(*wrap))
            })
            .collect();
        baker.tex_coords(&self.coordinates).textures(&textures)
    }
}

/// The coordinates of a model's vertices. A vertex that has several, because a picture ends there, becomes several
/// vertices; triangles stay where they are, and those without a picture as they are.
fn unfold(model: &mut Model, is_pictured: impl Fn(u16) -> bool) -> Vec<Vec2> {
    let mut coordinates = vec![None; model.vertices.len()];
    let mut copies = HashMap::new();
    for triangle in 0..model.triangles.len() {
        let places = model.mapping.of(triangle).filter(|_| is_pictured(model.material(triangle)));
        for (corner, at) in places.into_iter().flatten().enumerate() {
            let vertex = &mut model.triangles[triangle][corner];
            let first = *coordinates[*vertex as usize].get_or_insert(at);
            if first == at {
                continue;
            }
            *vertex = *copies.entry((*vertex, at.map(f32::to_bits))).or_insert_with(|| {
                model.vertices.push(model.vertices[*vertex as usize]);
                coordinates.push(Some(at));
                model.vertices.len() as u32 - 1
            });
        }
    }
    model.mapping = Mapping::default();
    // Where no picture is, those of another vertex, which do not widen the range.
    let usual = coordinates.iter().flatten().next().copied().unwrap_or_default();
    coordinates.into_iter().map(|at| Vec2::from(at.unwrap_or(usual))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Image, Material};

    /// A triangle for each of `materials`, all between the same three vertices, and mapped as `places` says.
    fn model(materials: Vec<Material>, places: &[[[f32; 2]; 3]]) -> Model {
        let corners = |n: u32| [3 * n, 3 * n + 1, 3 * n + 2];
        Model {
            vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]; materials.len()],
            material_ids: (0..materials.len() as u16).collect(),
            materials,
            mapping: Mapping { coordinates: places.concat(), corners: (0..places.len() as u32).map(corners).collect() },
            pictures: [(7, Ok(picture::tests::png(2, 2, &[255; 12])))].into(),
            ..Model::default()
        }
    }

    fn pictured(nearest: bool) -> Material {
        let image = Image { contents: Contents::Here(7), nearest, clamp: false };
        Material { image: Some(image), ..Material::neutral("") }
    }

    const UNIT: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

    #[test]
    fn a_picture_is_decoded_once() {
        let mut model = model(vec![pictured(false), pictured(false), pictured(true)], &[UNIT; 3]);
        let skin = Skin::of_model(&mut model, 256).unwrap().unwrap();
        let [Some(a), Some(b), Some(c)] = &skin.sheets[..] else { panic!("{skin:?}") };
        assert!(Arc::ptr_eq(&a.picture, &b.picture) && Arc::ptr_eq(&a.picture, &c.picture));
        assert_eq!([a, b, c].map(|sheet| sheet.filter), [Filter::Bilinear, Filter::Bilinear, Filter::Nearest]);
        assert!(model.warnings.is_empty());
    }

    #[test]
    fn triangles_without_pictures_neither_divide_vertices_nor_widen_the_range() {
        let missing = Image { contents: Contents::Here(8), nearest: false, clamp: false };
        let missing = Material { image: Some(missing), ..Material::neutral("") };
        let far = UNIT.map(|[u, v]| [u * 1000.0, v - 1000.0]);
        let mut model = model(vec![Material::neutral(""), missing, pictured(false)], &[far, far, UNIT]);
        let skin = Skin::of_model(&mut model, 256).unwrap().unwrap();
        assert_eq!((model.vertices.len(), &model.triangles), (3, &vec![[0, 1, 2]; 3]));
        assert_eq!(skin.coordinates, UNIT.map(Vec2::from));
        assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
    }

    #[test]
    fn only_triangles_that_lose_their_picture_get_another_material() {
        let mut model = model(vec![pictured(false), pictured(true), Material::neutral("")], &[UNIT]);
        model.triangles.push([0, 1, 2]);
        model.material_ids.push(1);
        assert!(Skin::of_model(&mut model, 256).unwrap().is_some());
        assert_eq!((model.materials.len(), &model.material_ids[..]), (4, &[0, 3, 2, 3][..]));
        assert!(model.materials[3].image.is_none());
        assert!(model.warnings[0].starts_with("2 of 4 triangles lack texture coordinates"), "{:?}", model.warnings);
    }
}
