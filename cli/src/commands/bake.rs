use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
};

use hitscan::{
    Mesh,
    accel::kdtree,
    asset::{Asset, Kind},
    bake::Baker,
};

use super::print;
use crate::{
    failure::{self, Failure},
    output::{self, write_atomically},
    scene::{Built, Geometry, Preset, Source, Structure},
    units::{count, parse_bytes},
};

/// Turn a mesh into the asset that firmware includes
///
/// An asset holds triangles, a structure over them and materials in one block of bytes, and rays are cast at it where it
/// lies. Prints what the bytes are for and the worst case of a ray. The same bytes on every host.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitscan bake bunny.obj.gz -o bunny.hits --preset small --fit 3M")]
pub struct Bake {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz)
    model: PathBuf,
    /// Asset to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "scene.hits")]
    output: PathBuf,
    /// Structure over the triangles: auto, list or kdtree
    #[arg(short, long, value_name = "NAME", default_value = "kdtree")]
    structure: Structure,
    /// What the structure is tuned for
    #[arg(short, long, value_name = "PRESET", default_value = "balanced")]
    preset: Preset,
    /// The most bytes that the asset may have, such as 64K; the structure is made to fit
    #[arg(long, value_name = "BYTES", value_parser = parse_bytes)]
    fit: Option<usize>,
}

impl Bake {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        output::check(&self.output)?;
        let source = Source::load(&self.model)?;
        let Source::Model(geometry) = &source else {
            let what = format!("{}: is an asset already", self.model.display());
            return Err(Failure::new(what, "name the mesh it was made from"));
        };
        let mesh = source.view(&self.model)?.mesh;
        let bare = bake(&mesh, geometry, None)?.len() * 4;
        let mut options = self.preset.kd_options();
        if let Some(most) = self.fit {
            options = options.fit(room(most, bare)?);
        }
        let built = Built::with_options(&mesh, self.structure, self.preset, &options)?;
        let words = bake(&mesh, geometry, Some(&built))?;
        if let Some(most) = self.fit.filter(|most| words.len() * 4 > *most) {
            return Err(too_small(most, words.len() * 4));
        }
        write_atomically(&self.output, |file| words.iter().try_for_each(|word| file.write_all(&word.to_le_bytes())))?;
        let table = table(&words, &built, geometry.len(), &self.output)?;
        if self.output == Path::new("-") {
            failure::note(&table);
        } else {
            print(&table)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// What the structure may take where the whole may take `most` and the rest takes `bare`.
fn room(most: usize, bare: usize) -> Result<usize, Failure> {
    /// The structure's entry in the table, and up to three words of padding.
    const ENTRY: usize = 16 + 12;
    most.checked_sub(bare + ENTRY).ok_or_else(|| too_small(most, bare + ENTRY))
}

fn too_small(most: usize, least: usize) -> Failure {
    let what = format!("--fit {most}: the asset takes more than {least} bytes without a structure");
    Failure::new(what, "allow more bytes, or simplify the mesh")
}

fn bake(mesh: &Mesh<'_>, geometry: &Geometry, built: Option<&Built>) -> Result<Vec<u32>, Failure> {
    let mut baker = Baker::new().mesh(mesh);
    if let Some(tree) = built.map(Built::tree).transpose()?.flatten() {
        baker = baker.structure(tree);
    }
    if !geometry.palette.materials.is_empty() {
        baker = baker.materials(&geometry.palette.materials, geometry.palette.as_numbers());
    }
    Ok(baker.finish())
}

/// The bytes by what they are for, and the worst case of a ray.
fn table(words: &[u32], built: &Built, triangles: usize, output: &Path) -> Result<String, Failure> {
    let (mut geometry, mut structure, mut materials) = (0, 0, 0);
    let asset = Asset::from_words(words).map_err(|error| Failure::new(error, "report this as a bug"))?;
    for section in asset.sections() {
        let bytes = section.words.len() * 4;
        match section.kind {
            Kind::Vertices | Kind::NarrowIndices | Kind::WideIndices => geometry += bytes,
            Kind::Materials | Kind::MaterialNumbers => materials += bytes,
            _ => structure += bytes,
        }
    }
    let total = words.len() * 4;
    let rows = [
        ("geometry", geometry),
        ("structure", structure),
        ("materials", materials),
        ("header and padding", total - geometry - structure - materials),
        ("total", total),
    ];
    let mut text = format!(
        "{}: {} triangles\n{:<20}{:>14}{:>14}\n",
        output.display(),
        count(triangles),
        "",
        "bytes",
        "per triangle"
    );
    for (what, bytes) in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{what:<20}{:>14}{:>14.2}", count(bytes), bytes as f64 / triangles as f64);
    }
    let _ = writeln!(text, "structure: {}, {}", built.name, built.time());
    let _ = match built.tree()? {
        Some(tree) => {
            let (depth, nodes) = (tree.depth(), count(tree.node_count()));
            writeln!(text, "worst case of a ray: depth {depth} (the stack holds {}), {nodes} nodes", kdtree::MAX_DEPTH)
        }
        None => writeln!(text, "worst case of a ray: {} triangles tested", count(triangles)),
    };
    Ok(text)
}
