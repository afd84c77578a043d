use std::{fs::File, io::Read, path::Path};

use hitscan::{
    Accelerator, Error, Mesh,
    accel::Structure,
    asset::{Asset, AssetError, Kind},
    bake::Baker,
    primitives::{Indices, Normals, Primitives, QuadMesh, Renumbering, Reordered, Soup, TexCoords},
    render::{Materials, Textures},
};

use super::{Built, Choice, Geometry, Preset, StructureArgs, broken};
use crate::{
    failure::Failure,
    input,
    model::{Fault, LoadError},
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

/// What there is to see of a source.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The triangles.
    pub mesh: Mesh<'a>,
    /// The same as an asset has them, if that is in the order of its leaves: its structure is over these.
    pub soup: Option<Soup<'a>>,
    /// Whether the structure of an asset refers to pairs of them.
    pub in_pairs: bool,
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
        // Another byte order is another fault.
        let swapped = [MAGIC[3], MAGIC[2], MAGIC[1], MAGIC[0]];
        let bytes = input::read(path)?;
        if !bytes.starts_with(MAGIC) && !bytes.starts_with(&swapped) {
            let what = format!("{}: is no asset, but may be answers of `hitscan cast`", path.display());
            return Err(Failure::new(what, "name what `hitscan bake` wrote"));
        }
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
                let in_pairs = false;
                Ok(View { mesh, soup, in_pairs, materials, textures, normals, structure, renumbering, y_up, seconds })
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
                    // What is unpacked are corners; that these are of pairs, only the asset's own say.
                    Some(geometry) if has(Kind::Quads) => {
                        let indices: Indices<'_> = asset.read().map_err(damaged)?;
                        Mesh::new(&geometry.vertices, indices).map_err(|error| damaged(error.into()))?
                    }
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
                let pairs = QuadMesh::new(mesh).ok();
                let in_pairs = pairs
                    .zip(structure)
                    .is_some_and(|(pairs, structure): (_, Structure<'_>)| structure.primitives() == pairs.len());
                let (y_up, seconds) = (false, progress.finish());
                Ok(View { mesh, soup, in_pairs, materials, textures, normals, structure, renumbering, y_up, seconds })
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
