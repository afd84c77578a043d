mod table;

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
};

use hitscan::{
    LatticeMesh, Mesh, Primitives,
    accel::Structure,
    bake::{self, Baker, OnLattice},
    glam::Vec3,
};

use self::table::table;
use super::{predict, print};
use crate::{
    chip::{self, Chip},
    failure::{self, Failure},
    output,
    scene::{Built, Choice, Geometry, Named, Palette, Preset, Skin, Source, StructureArgs, broken, normals_by_place},
    units::parse_bytes,
    world::{self, write_words},
};

/// Turn a mesh into the asset that firmware includes
///
/// An asset holds triangles, a structure over them and materials in one block of bytes, and rays are cast at it where it
/// lies. Prints what the bytes are for and the worst case of a ray. The same bytes on every host.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: hitscan bake bunny.obj.gz -o bunny.hits --preset small --fit 3M\n          \
                        hitscan bake robot.stl -o robot.hits --target m4 --fit 64K\n          \
                          hitscan bake robot.stl -o robot.hits --preset fast --soup")]
pub struct Bake {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz), or the description of a world of placed meshes (.toml)
    model: PathBuf,
    /// Asset to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "scene.hits")]
    output: PathBuf,
    #[arg(short, long, value_name = "NAME", help = Choice::help("triangles") + " [default: kdtree, or auto for a --target]")]
    structure: Option<Choice>,
    /// What the structure is tuned for [default: balanced, or what is fastest on a --target]
    #[arg(short, long, value_name = "PRESET", conflicts_with = "target")]
    preset: Option<Preset>,
    /// Take the structure and preset with the fewest instructions per ray on this chip, by counts and a measured table
    #[arg(short, long, value_name = "CHIP")]
    target: Option<Chip>,
    /// Keep the triangles' numbers where a structure (bvh, dual-split) puts them into another order, for 4 to 8 bytes each
    #[arg(long)]
    keep_numbers: bool,
    /// Put the vertices on a lattice of 16 bits per coordinate: 6 bytes each instead of 12
    #[arg(long)]
    lattice: bool,
    /// Store the vertices' normals, in 2 bytes each: triangles are shaded as if they were curved, but for sharp edges
    #[arg(long, conflicts_with = "lattice")]
    normals: bool,
    /// Store the corners of each triangle beside each other, for the fewest instructions per ray: in 36 bytes a triangle
    #[arg(long, conflicts_with_all = ["target", "keep_numbers", "lattice", "normals", "textures", "fit"])]
    soup: bool,
    /// Store the materials' textures, of at most N pixels along a side (256 if not given), in at most 2 bytes a pixel and 4
    /// a vertex; where a texture has seams, vertices are there several times
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "256",
          value_parser = clap::value_parser!(u16).range(1..))]
    textures: Option<u16>,
    /// The most bytes that the asset may have, such as 64K; the structure is made to fit
    #[arg(long, value_name = "BYTES", value_parser = parse_bytes)]
    fit: Option<usize>,
}

impl Bake {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        output::check(&self.output)?;
        if self.model.extension().is_some_and(|extension| extension == "toml") {
            return self.world();
        }
        let source = Source::load_with(&self.model, self.textures)?;
        let Source::Model(geometry) = &source else {
            let what = format!("{}: is an asset already", self.model.display());
            return Err(Failure::new(what, "name the mesh it was made from"));
        };
        let model = source.view(&self.model)?.mesh;
        if self.soup {
            return self.soup(&model, geometry);
        }
        let normals = self.normals.then(|| normals_by_place(&model));
        let snapped = self.lattice.then(|| bake::lattice(&model));
        let snapped = snapped.as_ref();
        let shapes = Triangles::of(&model, snapped)?;
        let unmoved: Vec<u32> = (0..model.len()).collect();
        let extras = Extras { normals: normals.as_deref(), skin: geometry.skin.as_deref() };
        let numbers = self.keep_numbers.then_some(&unmoved);
        let bare = bake(&shapes, extras, &geometry.palette, None, numbers).len() * 4;
        let most = self.fit.map(|most| room(most, bare)).transpose()?;
        let (built, order) = match self.target {
            Some(chip) => shapes.choose(chip, self.structure.unwrap_or_default(), most),
            None => {
                let structure = self.structure.unwrap_or(Choice::Named(Named::assumed()));
                shapes.build(structure, self.preset.unwrap_or_default(), most)
            }
        }?;
        let corners = bake::reorder(&model, &order);
        let model = Mesh::new(model.vertices(), &corners[..]).map_err(broken)?;
        let shapes = Triangles::of(&model, snapped)?;
        let structure = built.structure(&model)?;
        let keeps = self.keep_numbers && order != unmoved;
        let palette = if keeps { geometry.palette.clone() } else { geometry.palette.reordered(&order) };
        let words = bake(&shapes, extras, &palette, Some(structure), keeps.then_some(&order));
        if let Some(most) = self.fit.filter(|most| words.len() * 4 > *most) {
            let what = format!("--fit {most}: with this structure ({}) it takes {} bytes", built.name, words.len() * 4);
            return Err(Failure::new(what, "allow more bytes, or choose another structure, such as kdtree"));
        }
        write_words(&self.output, &words)?;
        let mut table = table(&words, &built, &structure, geometry.len(), &self.output)?;
        if let Some(snapped) = snapped {
            let _ = writeln!(table, "vertices moved by at most {} to the lattice", snapped.displacement);
        }
        if let Some(chip) = self.target {
            let asset = words.len() * 4;
            match &shapes {
                Triangles::Plain(mesh) => predict(&mut table, chip, &built, mesh, asset),
                Triangles::OnLattice(mesh) => predict(&mut table, chip, &built, mesh, asset),
            }?;
        }
        self.report(&table)
    }
}

impl Bake {
    /// Bakes triangles that each have corners of their own.
    fn soup(&self, mesh: &Mesh<'_>, geometry: &Geometry) -> Result<ExitCode, Failure> {
        let structure = self.structure.unwrap_or(Choice::Named(Named::assumed()));
        let built = Built::new(mesh, structure, self.preset.unwrap_or_default())?;
        let structure = built.structure(mesh)?;
        let words = dressed(Baker::new().soup(mesh).structure(structure), &geometry.palette).finish();
        write_words(&self.output, &words)?;
        self.report(&table(&words, &built, &structure, geometry.len(), &self.output)?)
    }

    /// Prints it, but not where the asset is.
    fn report(&self, text: &str) -> Result<ExitCode, Failure> {
        if self.output == Path::new("-") {
            failure::note(text);
        } else {
            print(text)?;
        }
        Ok(ExitCode::SUCCESS)
    }

    /// Bakes what a file describes, a structure over each part and one over all places.
    fn world(&self) -> Result<ExitCode, Failure> {
        let unfit = [
            ("--target", self.target.is_some()),
            ("--keep-numbers", self.keep_numbers),
            ("--lattice", self.lattice),
            ("--normals", self.normals),
            ("--soup", self.soup),
            ("--fit", self.fit.is_some()),
        ];
        if let Some((option, _)) = unfit.into_iter().find(|(_, given)| *given) {
            return Err(Failure::new(format!("{option}: is for meshes"), "leave it out for a world"));
        }
        let structure = StructureArgs { structure: self.structure, preset: self.preset.unwrap_or_default() };
        let words = world::load(&self.model, &structure, self.textures)?;
        write_words(&self.output, &words)?;
        let source = Source::Asset { words, unpacked: None };
        let table = source.with_subject(&self.output, &StructureArgs::default(), false, |subject| {
            Ok(format!("{}: {}\n{}\n", self.output.display(), subject.size(), subject.structure()))
        })?;
        self.report(&table)
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

/// The triangles as they are to be stored.
enum Triangles<'a> {
    Plain(Mesh<'a>),
    OnLattice(LatticeMesh<'a>),
}

impl<'a> Triangles<'a> {
    /// Those of `mesh`, between the vertices on a lattice if there are any.
    fn of(mesh: &Mesh<'a>, snapped: Option<&'a OnLattice>) -> Result<Self, Failure> {
        match snapped {
            None => Ok(Self::Plain(*mesh)),
            Some(snapped) => Ok(Self::OnLattice(snapped.mesh(mesh).map_err(broken)?)),
        }
    }

    /// A structure over them, and the order of its leaves.
    fn build(&self, choice: Choice, preset: Preset, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        match self {
            Self::Plain(mesh) => Built::within(mesh, choice, preset, most)?.ordered(mesh),
            Self::OnLattice(mesh) => Built::within(mesh, choice, preset, most)?.ordered(mesh),
        }
    }

    /// The structure over them that is fastest on a chip, and the order of its leaves.
    fn choose(&self, chip: Chip, choice: Choice, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        match self {
            Self::Plain(mesh) => chip::choose(mesh, chip, choice, most)?.ordered(mesh),
            Self::OnLattice(mesh) => chip::choose(mesh, chip, choice, most)?.ordered(mesh),
        }
    }
}

/// What there is of vertices and materials beyond the usual.
#[derive(Clone, Copy)]
struct Extras<'a> {
    normals: Option<&'a [Vec3]>,
    skin: Option<&'a Skin>,
}

fn bake(
    shapes: &Triangles<'_>,
    Extras { normals, skin }: Extras<'_>,
    palette: &Palette,
    structure: Option<Structure<'_>>,
    numbers: Option<&Vec<u32>>,
) -> Vec<u32> {
    let mut baker = match shapes {
        Triangles::Plain(mesh) => Baker::new().mesh(mesh),
        Triangles::OnLattice(mesh) => Baker::new().lattice_mesh(mesh),
    };
    if let Some(normals) = normals {
        baker = baker.normals(normals);
    }
    if let Some(structure) = structure {
        baker = baker.structure(structure);
    }
    if let Some(numbers) = numbers {
        baker = baker.numbers(numbers);
    }
    let baker = dressed(baker, palette);
    match skin {
        Some(skin) => skin.bake(baker).finish(),
        None => baker.finish(),
    }
}

/// With the materials of a model, if it names any.
fn dressed(baker: Baker, palette: &Palette) -> Baker {
    if palette.materials.is_empty() { baker } else { baker.materials(&palette.materials, palette.as_numbers()) }
}
