use std::{fs::File, io::Read, path::Path};

use hitscan::{
    Error, LatticeMesh, Mesh,
    accel::Structure,
    asset::{Asset, AssetError, Kind},
    bake::Baker,
    glam::Vec3,
    primitives::{Indices, Normals, Primitives, Renumbering, Reordered, Soup, TexCoords},
    render::{Materials, Textures},
};

use super::{Built, Choice, Palette, Preset, Skin, StructureArgs, broken};
use crate::{
    failure::{Failure, warn},
    input,
    model::{Fault, LoadError, Model, Placement},
    progress::Progress,
    version::hex,
    world,
};

/// The first bytes of an asset.
const MAGIC: &[u8; 4] = b"HITS";

/// What a path names.
#[derive(Debug)]
pub enum Source {
    /// A mesh file.
    Model(Geometry),
    /// An asset.
    Asset {
        /// Its words.
        words: Vec<u32>,
        /// Its triangles, if they are stored otherwise than as a mesh.
        unpacked: Option<Box<Geometry>>,
    },
}

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
    fn unpacked(asset: &Asset<'_>) -> Result<Option<Self>, Error> {
        let has = |kind| asset.sections().any(|section| section.kind == kind);
        let (vertices, triangles): (Vec<Vec3>, Vec<[u32; 3]>) = if has(Kind::LatticeVertices) {
            let mesh: LatticeMesh<'_> = asset.read()?;
            let corners = (0..mesh.len()).filter_map(|triangle| mesh.indices().get(triangle));
            (mesh.positions().collect(), corners.collect())
        } else if has(Kind::Soup) {
            let soup: Soup<'_> = asset.read()?;
            let mut corners = vec![[[0.0; 3]; 3]; soup.numbers() as usize];
            soup.facets().iter().for_each(|facet| corners[facet.number as usize] = facet.corners);
            let vertices = corners.into_iter().flatten().map(Vec3::from_array);
            (vertices.collect(), (0..soup.numbers()).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect())
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

/// What there is to see of a source.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The triangles.
    pub mesh: Mesh<'a>,
    /// The same as an asset has them, if that is in the order of its leaves: its structure is over these.
    pub soup: Option<Soup<'a>>,
    /// Their materials, if it names any.
    pub materials: Option<Materials<'a>>,
    /// The pictures on those of an asset, and where in these the vertices lie, if there are any.
    pub textures: Option<(Textures<'a>, TexCoords<'a>)>,
    /// The normals of an asset's vertices, if it has any.
    pub normals: Option<Normals<'a>>,
    /// The structure of an asset, if it has one.
    pub structure: Option<Structure<'a>>,
    /// The numbers that the triangles of an asset had in its model, if it keeps them.
    pub renumbering: Option<Renumbering<'a>>,
    /// Whether y is up by definition.
    pub y_up: bool,
    /// What it took to check the asset.
    seconds: f64,
}

impl Source {
    /// Reads a mesh file, an asset or the description of a world, told apart by the first bytes and the extension; the
    /// pictures that a mesh file names are not read.
    ///
    /// # Errors
    ///
    /// What is wrong with the file.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        Self::load_with(path, None)
    }

    /// The same, with pictures of at most so many pixels along a side if they are wanted.
    ///
    /// # Errors
    ///
    /// What is wrong with the file.
    pub fn load_with(path: &Path, textures: Option<u16>) -> Result<Self, Failure> {
        let progress = Progress::spinner(&format!("reading {} …", path.display()));
        let mut start = [0; 4];
        let marked = File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == *MAGIC;
        let source = if marked || path.extension().is_some_and(|extension| extension == "hits") {
            Self::load_asset(path)?
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            Self::Asset { words: world::load(path, &StructureArgs::default(), textures)?, unpacked: None }
        } else {
            Self::Model(Geometry::load(path, textures).map_err(|failure| mention_assets(failure, path))?)
        };
        progress.finish();
        Ok(source)
    }

    fn load_asset(path: &Path) -> Result<Self, Failure> {
        let bytes = input::read(path)?;
        let (words, rest) = bytes.as_chunks();
        let words: Vec<u32> = words.iter().copied().map(u32::from_le_bytes).collect();
        if !rest.is_empty() {
            let what = format!("{}: {} bytes are not a whole number of words", path.display(), bytes.len());
            return Err(Failure::new(what, "fetch or bake the asset again"));
        }
        // Whatever else the asset is for, its header, table and checksum must be right.
        let asset = Asset::from_words(&words).map_err(|error| damaged(path, error))?;
        let unpacked = Geometry::unpacked(&asset).map_err(|error| damaged(path, error))?;
        Ok(Self::Asset { words, unpacked: unpacked.map(Box::new) })
    }

    /// The asset, if it is one of scenes that are placed.
    pub fn world(&self) -> Option<Asset<'_>> {
        let Self::Asset { words, .. } = self else { return None };
        let asset = Asset::from_words(words).ok()?;
        asset.sections().any(|section| section.kind == Kind::Instances).then_some(asset)
    }

    /// The SHA-256 of what there is to see.
    pub fn hash(&self) -> Result<String, Failure> {
        let hash = |words: &[u32]| {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            hex(&bytes)
        };
        match self {
            Self::Model(geometry) => {
                let mut baker = Baker::new().mesh(&geometry.mesh()?);
                if !geometry.palette.materials.is_empty() {
                    baker = baker.materials(&geometry.palette.materials, geometry.palette.as_numbers());
                }
                if let Some(skin) = &geometry.skin {
                    baker = skin.bake(baker);
                }
                Ok(hash(&baker.finish()))
            }
            Self::Asset { words, .. } => Ok(hash(words)),
        }
    }

    /// What there is to see, checked in full; `path` is for the error.
    pub fn view(&self, path: &Path) -> Result<View<'_>, Failure> {
        match self {
            Self::Model(geometry) => {
                let name = |failure: Failure| match failure {
                    Failure::Other { what, mend } => Failure::new(format!("{}: {what}", path.display()), mend),
                    other => other,
                };
                let palette = &geometry.palette;
                let materials = (!palette.materials.is_empty()).then(|| palette.as_materials());
                let mesh = geometry.mesh().map_err(name)?;
                let (y_up, seconds) = (geometry.y_up, 0.0);
                let (soup, textures, normals, structure, renumbering) = (None, None, None, None, None);
                Ok(View { mesh, soup, materials, textures, normals, structure, renumbering, y_up, seconds })
            }
            Self::Asset { .. } if self.world().is_some() => {
                let what = format!("{}: is a world of placed scenes", path.display());
                Err(Failure::new(what, "name one of the meshes that are placed"))
            }
            Self::Asset { words, unpacked } => {
                let progress = Progress::spinner("checking the asset …");
                let damaged = |error| damaged(path, error);
                let asset = Asset::from_words(words).map_err(|error| damaged(error.into()))?;
                let has = |kind| asset.sections().any(|section| section.kind == kind);
                let mesh = match unpacked {
                    Some(geometry) => geometry.mesh()?,
                    None => asset.read().map_err(damaged)?,
                };
                let soup = has(Kind::Soup).then(|| asset.read().map_err(damaged)).transpose()?;
                let materials = has(Kind::Materials).then(|| asset.read().map_err(damaged)).transpose()?;
                let textures = pictures(&asset).map_err(damaged)?;
                let normals = has(Kind::Normals).then(|| asset.read().map_err(damaged)).transpose()?;
                // An asset without one is a list.
                let structure = match asset.read() {
                    Ok(structure) => Some(structure),
                    Err(Error::Asset(AssetError::NoStructure)) => None,
                    Err(error) => return Err(damaged(error)),
                };
                let renumbering = has(Kind::Numbers).then(|| asset.read().map_err(damaged)).transpose()?;
                let (y_up, seconds) = (false, progress.finish());
                Ok(View { mesh, soup, materials, textures, normals, structure, renumbering, y_up, seconds })
            }
        }
    }
}

/// The pictures of an asset and where its vertices lie in them, if it has both.
pub(super) fn pictures<'a>(asset: &Asset<'a>) -> Result<Option<(Textures<'a>, TexCoords<'a>)>, Error> {
    let has = |kind| asset.sections().any(|section| section.kind == kind);
    if has(Kind::Textures) && has(Kind::TexCoords) { Ok(Some((asset.read()?, asset.read()?))) } else { Ok(None) }
}

impl<'a> View<'a> {
    /// `shapes`, which stand in the mesh's order, with the numbers that they had in the model; none if it is the same.
    pub fn renumbered<P: Primitives>(&self, shapes: P) -> Result<Option<Reordered<'a, P>>, Failure> {
        self.renumbering.map(|numbers| Reordered::new(shapes, numbers).map_err(broken)).transpose()
    }

    /// The structure that was asked for: the asset's own unless another was named.
    pub fn build(&self, choice: Option<Choice>, preset: Preset) -> Result<Built, Failure> {
        match (choice, &self.structure) {
            (None, Some(structure)) => Ok(Built::of_asset(structure, self.seconds)),
            _ => Built::new(&self.mesh, choice.unwrap_or_default(), preset),
        }
    }
}

pub(super) fn damaged(path: &Path, error: impl std::fmt::Display) -> Failure {
    Failure::new(format!("{}: {error}", path.display()), "fetch or bake the asset again")
}

/// A file of unknown kind may have been meant as an asset.
fn mention_assets(failure: Failure, path: &Path) -> Failure {
    match failure {
        Failure::Load(LoadError { fault: Fault::UnknownExtension, .. }) => {
            let mend = format!("use a file ending in {}, or one made by `hitscan bake`", crate::model::EXTENSIONS);
            Failure::new(format!("{}: neither a mesh nor an asset", path.display()), mend)
        }
        other => other,
    }
}
