mod fit;
mod notes;
mod table;
mod vertices;

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
};

use hitscan::{
    Mesh, Primitives,
    bake::{self, Baker},
};

use self::{
    fit::Fit,
    table::table,
    vertices::{Packing, Vertices, dressed, neighbours},
};
use super::print;
use crate::{
    chip::Chip,
    failure::{self, Failure},
    output,
    scene::{Built, Choice, Geometry, Named, Preset, Source, StructureArgs, broken, normals_by_place},
    units::parse_bytes,
    world::{self, write_words},
};

/// The structure's entry in the table, and up to three words of padding.
const ENTRY: usize = 16 + 12;

/// How it is called.
const EXAMPLES: &str = "Examples: hitscan bake bunny.obj.gz -o bunny.hits --preset small --fit 3M\n          \
                        hitscan bake robot.stl -o robot.hits --target m4 --fit 64K\n          \
                        hitscan bake robot.stl -o robot.hits --preset fast --soup";

/// Turn a mesh into the asset that firmware includes
///
/// An asset holds triangles, a structure over them and materials in one block of bytes, and rays are cast at it where it
/// lies. Prints what the bytes are for and the worst case of a ray. The same bytes on every host.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES,
          after_long_help = format!("{EXAMPLES}\n\nA world is described by a text such as this:\n\n{}", world::EXAMPLE))]
pub struct Bake {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz), or the description of a world of placed meshes (.toml)
    #[arg(value_name = "MODEL|WORLD")]
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
    /// Keep the triangles' numbers where a structure (bvh, dual-split) or --meshlets puts them into another order, for 4 to 8
    /// bytes each
    #[arg(long)]
    keep_numbers: bool,
    /// Put the vertices on a lattice of 16 bits per coordinate: 6 bytes each instead of 12; with kdtree-compact or dual-split,
    /// but not with the default structure, it can be asked in whole numbers (`LatticeScene`), for chips without FPU
    #[arg(long)]
    lattice: bool,
    /// Store corners in 3 bytes a triangle instead of 6 or 12, for 3 % more instructions per ray; neighbours are
    /// put one after the other, so that numbers change without --keep-numbers, and some vertices are there several times
    #[arg(long)]
    meshlets: bool,
    /// Put triangles that share an edge into pairs, which are stored and tested two at a time: corners take 2 bytes a triangle,
    /// structures half as many references, and grids and kD-trees fewer instructions per ray in the same bytes; numbers change
    #[arg(long, conflicts_with_all = ["keep_numbers", "meshlets"])]
    quads: bool,
    /// Store the vertices' normals, in 2 bytes each: triangles are shaded as if they were curved, but for sharp edges
    #[arg(long, conflicts_with = "lattice")]
    normals: bool,
    /// Store the corners of each triangle beside each other, for the fewest instructions per ray: in 36 bytes a triangle
    #[arg(long, conflicts_with_all = ["target", "keep_numbers", "lattice", "meshlets", "quads", "normals", "textures",
          "fit"])]
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
        output::spare("-o", &self.output, [&*self.model])?;
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
        let vertices = Vertices {
            positions: geometry.vertices.clone(),
            snapped: self.lattice.then(|| bake::lattice(&model)),
            normals: self.normals.then(|| normals_by_place(&model)),
            skin: geometry.skin.as_deref().cloned(),
        };
        let palette = &geometry.palette;
        let (packing, is_packed) = (self.packing(), self.is_packed());
        let unmoved: Vec<u32> = (0..model.len()).collect();
        let mut near = if is_packed { neighbours(&model)? } else { unmoved.clone() };
        let mut corners = bake::reorder(&model, &near);
        if self.quads {
            let pairs = bake::pairs(&Mesh::new(model.vertices(), &corners[..]).map_err(broken)?);
            near = pairs.numbers.iter().map(|&place| near[place as usize]).collect();
            corners = pairs.corners;
        }
        let model = Mesh::new(model.vertices(), &corners[..]).map_err(broken)?;
        let quads = self.quads.then(|| bake::quads(&model).map_err(broken)).transpose()?;
        let packed = quads.as_ref().map(|quads| (vertices.ordered(quads), quads));
        let shapes = match &packed {
            Some((vertices, quads)) => vertices.triangles(quads.indices())?.in_pairs()?,
            None => vertices.triangles(model.indices())?,
        };
        let numbers = self.keep_numbers.then_some(&unmoved);
        let bare = vertices.bake(packing, model.indices(), palette, None, numbers)?.len() * 4;
        // What there was too much, because vertices stand several times in the order of the leaves.
        let mut excess = 0;
        let (built, corners, words, order) = loop {
            let fit = self.fit.map(|most| Fit { most, rest: bare + excess + ENTRY, mend: self.smaller() });
            let most = fit.as_ref().map(Fit::room).transpose()?;
            let built = match self.target {
                Some(chip) => shapes.choose(chip, self.structure.unwrap_or_default(), most),
                None => {
                    let structure = self.structure.unwrap_or(Choice::Named(Named::assumed()));
                    shapes.build(structure, self.preset.unwrap_or_default(), most)
                }
            };
            let (built, order) = built.map_err(|failure| match &fit {
                Some(fit) => fit.explain(failure),
                None => failure,
            })?;
            let corners = bake::reorder(&model, &order);
            let order: Vec<u32> = order.iter().map(|&place| near[place as usize]).collect();
            let keeps = self.keep_numbers && order != unmoved;
            let palette = if keeps { palette.clone() } else { palette.reordered(&order) };
            let mesh = Mesh::new(model.vertices(), &corners[..]).map_err(broken)?;
            let numbers = keeps.then_some(&order);
            let words = vertices.bake(packing, mesh.indices(), &palette, Some(built.structure(&mesh)?), numbers)?;
            let bytes = words.len() * 4;
            match fit.filter(|fit| bytes > fit.most) {
                None => break (built, corners, words, order),
                Some(Fit { most, .. }) if is_packed && excess == 0 && bytes - most < built.bytes() => {
                    excess = bytes - most;
                }
                Some(fit) => return Err(fit.refuse(&built.name, bytes.saturating_sub(fit.rest))),
            }
        };
        let model = Mesh::new(model.vertices(), &corners[..]).map_err(broken)?;
        let structure = built.structure(&model)?;
        write_words(&self.output, &words)?;
        let mut table = table(&words, &built, &structure, geometry.len(), &self.output)?;
        if let Some(snapped) = &vertices.snapped {
            let _ = writeln!(table, "vertices moved by at most {} to the lattice", snapped.displacement);
        }
        table += &self.notes(&model, structure.kind(), order != unmoved);
        if let Some(chip) = self.target {
            let asset = words.len() * 4;
            // Pairs are predicted where they stand as they stood: under a grid or a kD-tree.
            let triangles = if self.quads { shapes } else { vertices.triangles(model.indices())? };
            triangles.predict(&mut table, chip, &built, asset)?;
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

    const fn packing(&self) -> Packing {
        match (self.meshlets, self.quads) {
            (true, _) => Packing::Meshlets,
            (_, true) => Packing::Quads,
            _ => Packing::Plain,
        }
    }

    /// Whether corners are stored in bytes.
    fn is_packed(&self) -> bool {
        self.packing() != Packing::Plain
    }

    /// What could take fewer bytes, of what was not asked for yet.
    fn smaller(&self) -> String {
        let options = [
            ("--lattice", self.lattice || self.normals),
            ("--meshlets", self.is_packed()),
            ("--quads", self.is_packed() || self.keep_numbers),
        ];
        let options: Vec<&str> = options.into_iter().filter(|(_, given)| !given).map(|(option, _)| option).collect();
        match options.is_empty() {
            true => "allow more bytes, or simplify the mesh".to_owned(),
            false => format!("allow more bytes, or give {}", options.join(" or ")),
        }
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
            ("--meshlets", self.meshlets),
            ("--quads", self.quads),
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
