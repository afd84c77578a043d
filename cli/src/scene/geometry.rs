use std::path::Path;

use hitscan::{
    Error, LatticeMesh, Mesh, Primitives,
    asset::{Asset, Kind},
    glam::Vec3,
    primitives::{Indices, Soup},
};

use super::{Palette, Skin};
use crate::{
    failure::{Failure, warn},
    model::{LoadError, Model, Placement},
};

/// Triangles and their materials.
#[derive(Debug, Default)]
pub struct Geometry {
    /// Positions.
    pub vertices: Vec<Vec3>,
    /// Corners, if the numbers of some need 32 bits.
    pub wide: Vec<[u32; 3]>,
    /// Corners, if 16 bits are enough.
    pub narrow: Vec<[u16; 3]>,
    /// Materials.
    pub palette: Palette,
    /// Pictures on them, if they are wanted and there are any.
    pub skin: Option<Box<Skin>>,
    /// Which part of the file each run of triangles is; none if the format places nothing.
    pub placements: Vec<Placement>,
    /// Whether y is up by the definition of the file's format.
    pub y_up: bool,
}

impl Geometry {
    /// These triangles, their corners in 16 bits if they fit.
    pub fn new(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>, palette: Palette) -> Self {
        let (mut wide, mut narrow) = (triangles, Vec::new());
        if vertices.len() <= 1 << 16 {
            narrow = wide.iter().map(|corners| corners.map(|vertex| vertex as u16)).collect();
            wide = Vec::new();
        }
        Self { vertices, wide, narrow, palette, skin: None, placements: Vec::new(), y_up: false }
    }

    /// The model of a file, with pictures of at most so many pixels along a side if they are wanted; what is odd about it
    /// is said on standard error.
    pub fn load(path: &Path, textures: Option<u16>) -> Result<Self, Failure> {
        let mut model = Model::load(path)?;
        let skin = textures.map_or(Ok(None), |most| Skin::of_model(&mut model, most));
        let skin = skin.map_err(|fault| LoadError { path: path.to_owned(), line: None, fault })?;
        model.warnings.iter().for_each(|warning| warn(&format!("{}: {warning}", path.display())));
        let vertices = model.vertices.into_iter().map(Vec3::from_array).collect();
        let palette = Palette::of_model(&model.materials, model.material_ids);
        let name = path.to_string_lossy().to_ascii_lowercase();
        let y_up = [".gltf", ".glb", ".gltf.gz", ".glb.gz"].iter().any(|ending| name.ends_with(ending));
        Ok(Self {
            y_up,
            skin: skin.map(Box::new),
            placements: model.placements,
            ..Self::new(vertices, model.triangles, palette)
        })
    }

    /// The triangles of an asset that has them otherwise than as a mesh: on a lattice, or as a soup.
    pub fn unpacked(asset: &Asset<'_>) -> Result<Option<Self>, Error> {
        let has = |kind| asset.sections().any(|section| section.kind == kind);
        let (vertices, triangles): (Vec<Vec3>, Vec<[u32; 3]>) = if has(Kind::LatticeVertices) {
            let mesh: LatticeMesh<'_> = asset.read()?;
            let corners = (0..mesh.len()).filter_map(|triangle| mesh.indices().get(triangle));
            (mesh.positions().collect(), corners.collect())
        } else if has(Kind::Soup) {
            let soup: Soup<'_> = asset.read()?;
            (soup.triangles().as_flattened().to_vec(), (0..soup.len()).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect())
        } else {
            return Ok(None);
        };
        Ok(Some(Self::new(vertices, triangles, Palette::default())))
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.wide.len() + self.narrow.len()
    }

    /// The bytes of vertices and corners.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.vertices) + size_of_val(&*self.wide) + size_of_val(&*self.narrow)
    }

    /// The corners of the triangles.
    pub fn indices(&self) -> Indices<'_> {
        if self.wide.is_empty() { Indices::Narrow(&self.narrow) } else { Indices::Wide(&self.wide) }
    }

    /// The triangles, checked.
    pub fn mesh(&self) -> Result<Mesh<'_>, Failure> {
        let mend = "scale the mesh or move it nearer to the origin";
        Mesh::new(&self.vertices, self.indices()).map_err(|error| Failure::new(error, mend))
    }
}
