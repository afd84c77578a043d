//! Worlds: a few meshes, placed very often, described in a short text such as `example.toml`.

mod file;
mod places;
mod plant;

use std::path::Path;

use hitscan::{
    Bvh, Instance, Instances, Mesh, Scene,
    accel::{Plan, bvh},
    bake::{self, Baker},
};

use self::file::File;
use crate::{
    failure::Failure,
    output::{OutputError, write_atomically},
    scene::{Built, Choice, Geometry, Named, Preset, StructureArgs, broken},
};

/// A description with all that one can say, for the help.
pub const EXAMPLE: &str = include_str!("example.toml");

/// Where descriptions are described.
const HELP: &str = "see `hitscan bake --help`";

/// A mesh that is placed, with its structure.
struct Part {
    geometry: Geometry,
    built: Built,
}

/// The asset of the world that a file describes, with pictures on its meshes of at most so many pixels along a side if they
/// are wanted.
pub fn load(path: &Path, options: &StructureArgs, textures: Option<u16>) -> Result<Vec<u32>, Failure> {
    let named = |what: &dyn std::fmt::Display, mend: &str| Failure::new(format!("{}: {what}", path.display()), mend);
    let structure = match options.structure {
        Some(Choice::Named(structure)) if structure == Named::list() => {
            return Err(named(&"a world needs a structure", "choose another than list"));
        }
        Some(Choice::Named(structure)) => structure,
        _ => Named::assumed(),
    };
    let file = File::read(path)?;
    let (meshes, placed) = places::expand(&file).map_err(|what| named(&what, HELP))?;
    let parts = meshes.iter().map(|mesh| part(path, mesh, structure, options.preset, textures));
    let parts: Vec<Part> = parts.collect::<Result<_, _>>()?;
    let mut placed: Vec<Instance> = placed.into_iter().map(|(part, place)| Instance::new(part, place)).collect();

    let meshes: Vec<Mesh<'_>> = parts.iter().map(|part| part.geometry.mesh()).collect::<Result<_, _>>()?;
    let mut scenes = Vec::new();
    for (part, mesh) in parts.iter().zip(&meshes) {
        scenes.push(Scene::new(part.built.structure(mesh)?, *mesh).map_err(broken)?);
    }
    let instances = Instances::place(&scenes, &mut placed)
        .map_err(|error| named(&error, "place fewer, or nearer to the origin"))?;
    // Boxes of instances overlap: a hierarchy asks each instance once, where space that is divided asks it in every part.
    let top = bake::build(&instances, &Plan::Bvh(bvh::Options::default())).map_err(broken)?;
    let mut baker = Baker::new();
    for ((part, mesh), scene) in parts.iter().zip(&meshes).zip(&scenes) {
        let mut asset = Baker::new().mesh(mesh).structure(*scene.accelerator());
        if !part.geometry.palette.materials.is_empty() {
            asset = asset.materials(&part.geometry.palette.materials, part.geometry.palette.as_numbers());
        }
        if let Some(skin) = &part.geometry.skin {
            asset = skin.bake(asset);
        }
        baker = baker.part(asset);
    }
    Ok(baker.instances(instances.placed()).structure(Bvh::open(&top).map_err(broken)?).finish())
}

/// Bakes the world that a file describes into an asset, without textures.
///
/// # Errors
///
/// What is wrong with the description, what it names, or the output.
pub fn bake(path: &Path, output: &Path) -> Result<(), Failure> {
    let words = load(path, &StructureArgs::default(), None)?;
    Ok(write_words(output, &words)?)
}

/// Writes the words of an asset.
pub fn write_words(path: &Path, words: &[u32]) -> Result<(), OutputError> {
    write_atomically(path, |file| words.iter().try_for_each(|word| file.write_all(&word.to_le_bytes())))
}

/// A mesh that stands in a file beside `path`, or a plant that grows by itself, with its structure.
fn part(path: &Path, mesh: &str, structure: &Named, preset: Preset, textures: Option<u16>) -> Result<Part, Failure> {
    let geometry = if let Some(seed) = mesh.strip_prefix("plant:").and_then(|seed| seed.parse().ok()) {
        plant::grow(seed)
    } else {
        let beside = path.parent().unwrap_or(Path::new("")).join(mesh);
        // Neither an asset nor a world, which might be this one.
        Geometry::load(&beside, textures)?
    };
    let built = Built::named(&geometry.mesh()?, structure, preset, None)?;
    Ok(Part { geometry, built })
}
