mod world;

use std::{path::PathBuf, process::ExitCode};

use hitscan::{
    LatticeMesh, Mesh, Primitives,
    accel::Structure,
    asset::Asset,
    bake,
    geometry::Aabb,
    primitives::{Indices, QuadMesh},
};

use super::{line, predict, print};
use crate::{
    chip::Chip,
    failure::Failure,
    progress::Progress,
    scene::{Anatomy, Built, Choice, Instancing, Shape, Source, StructureArgs, View, broken},
    units::{count, things},
};

/// Describe a mesh, an asset or a world
///
/// Prints counts, bounds, whether it is closed, triangles without area and duplicates, the depth and expected cost of the
/// structure, which is built first for a mesh, triangles and bytes with and without instancing (glTF can place a mesh
/// several times), and the bytes of an asset's sections; for a world of placed meshes what it places, part by part.
#[derive(Debug, clap::Args)]
#[command(mut_arg("structure", |structure| structure.help(Choice::help("primitives") + " [default: the asset's own, or auto]")))]
#[command(after_help = "Examples: hitscan info bunny.obj.gz\n          hitscan info robot.hits --target m0")]
pub struct Info {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz), baked asset or world (.toml)
    #[arg(value_name = "MODEL|ASSET|WORLD")]
    model: PathBuf,
    #[command(flatten)]
    structure: StructureArgs,
    /// Predict flash, stack and instructions per ray on this chip, by counts and a measured table
    #[arg(short, long, value_name = "CHIP")]
    target: Option<Chip>,
}

impl Info {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        let source = Source::load(&self.model)?;
        if let Some(asset) = source.world() {
            return self.run_world(&source, &asset);
        }
        let view = source.view(&self.model)?;
        let built = view.build(self.structure.structure, self.structure.preset)?;
        let progress = Progress::spinner("looking at the triangles …");
        let anatomy = Anatomy::of(&view.mesh);
        progress.finish();

        let mut text = format!("{}\n", self.model.display());
        describe_mesh(&mut text, &view, &anatomy);
        describe_lattice(&mut text, &source, &view);
        describe_structure(&mut text, &built, &view)?;
        self.describe_instancing(&mut text, &source, &built, &view)?;
        let mut asset = None;
        if let Source::Asset { words, .. } = &source {
            describe_sections(&mut text, &Asset::from_words(words).map_err(broken)?);
            asset = Some(words.len() * 4);
        }
        if let Some(chip) = self.target {
            let asset = asset.unwrap_or_else(|| bytes_of(&view.mesh) + built.bytes());
            match on_lattice(&source) {
                _ if view.in_pairs && self.structure.structure.is_none() => {
                    let pairs = QuadMesh::new(view.mesh).map_err(broken)?;
                    predict(&mut text, chip, &built, &pairs, asset)?;
                }
                Some(mesh) => predict(&mut text, chip, &built, &mesh, asset)?,
                None if view.soup.is_some() && self.structure.structure.is_none() => {
                    line(
                        &mut text,
                        "unknown",
                        format!("what a soup takes on {}: name a --structure for its triangles", chip.phrase()),
                    );
                }
                None => predict(&mut text, chip, &built, &view.mesh, asset)?,
            }
        }
        print(&text)?;
        Ok(ExitCode::SUCCESS)
    }
}

impl Info {
    /// Describes a world of placed scenes.
    fn run_world(&self, source: &Source, asset: &Asset<'_>) -> Result<ExitCode, Failure> {
        if self.target.is_some() {
            let what = format!("{}: is a world of placed scenes, --target is for meshes", self.model.display());
            return Err(Failure::new(what, "name one of the meshes that are placed"));
        }
        let mut text = format!("{}\n", self.model.display());
        world::describe(&mut text, &self.model, source, asset, &self.structure)?;
        print(&text)?;
        Ok(ExitCode::SUCCESS)
    }

    /// What there is once and how often it is placed, and the bytes of both ways to keep it.
    fn describe_instancing(
        &self,
        text: &mut String,
        source: &Source,
        built: &Built,
        view: &View<'_>,
    ) -> Result<(), Failure> {
        let placed = view.mesh.len();
        let instancing = match source {
            Source::Model(geometry) => {
                Instancing::of(geometry, self.structure.structure.unwrap_or_default(), self.structure.preset)?
            }
            Source::Asset { .. } => None,
        };
        let flat = bytes_of(&view.mesh) + built.bytes();
        let (unique, bytes) = match instancing {
            None => (format!("{}, each placed once", count(placed)), flat),
            Some(Instancing { parts, placements, unique, bytes }) => (
                format!(
                    "{} in {}, placed {}",
                    count(unique),
                    things(parts, "part", "parts"),
                    things(placements, "time", "times")
                ),
                bytes,
            ),
        };
        line(text, "unique triangles", unique);
        line(text, "placed triangles", count(placed));
        line(text, "bytes as placed", format!("{} of geometry and structure", count(flat)));
        line(text, "bytes as instances", count(bytes));
        Ok(())
    }
}

/// What vertices and triangles take.
fn bytes_of(mesh: &Mesh<'_>) -> usize {
    let corners = match mesh.indices() {
        Indices::Narrow(list) => size_of_val(list),
        Indices::Wide(list) => size_of_val(list),
        Indices::Meshlets(meshlets) => size_of_val(meshlets.corners()) + size_of_val(meshlets.first()),
        Indices::Quads(quads) => size_of_val(quads.corners()) + size_of_val(quads.first()),
    };
    size_of_val(mesh.vertices()) + corners
}

fn describe_mesh(text: &mut String, view: &View<'_>, anatomy: &Anatomy) {
    let Anatomy { triangles, vertices, places, boundary_edges, non_manifold_edges, degenerate, duplicate } = *anatomy;
    let bounds = Aabb::around((0..view.mesh.len()).flat_map(|index| {
        let triangle = view.mesh.triangle(index);
        [triangle.a, triangle.b, triangle.c]
    }));
    line(text, "triangles", count(triangles));
    line(text, "vertices", format!("{} ({} different places in use)", count(vertices), count(places)));
    line(text, "bounds", format!("{} to {}", bounds.min, bounds.max));
    line(text, "size", bounds.size());
    line(text, "closed", if anatomy.is_closed() { "yes" } else { "no" });
    line(text, "boundary edges", count(boundary_edges));
    line(text, "non-manifold edges", count(non_manifold_edges));
    line(text, "without area", count(degenerate));
    line(text, "duplicates", count(duplicate));
}

/// The triangles of an asset whose vertices stand on a lattice.
fn on_lattice(source: &Source) -> Option<LatticeMesh<'_>> {
    match source {
        Source::Asset { words, .. } => Asset::from_words(words).ok()?.read().ok(),
        Source::Model(_) => None,
    }
}

/// The distance between planes of the asset's lattice, or what one would do to the mesh.
fn describe_lattice(text: &mut String, source: &Source, view: &View<'_>) {
    if let Some(mesh) = on_lattice(source) {
        let step = mesh.frame().size() / LatticeMesh::LAST as f32;
        line(text, "lattice", format!("planes {step} apart, vertices within {} of the model's", step.length() / 2.0));
    } else if let Source::Model(_) = source {
        let displacement = bake::lattice(&view.mesh).displacement;
        line(text, "on a lattice", format!("vertices would move by up to {displacement}"));
    }
}

fn describe_structure(text: &mut String, built: &Built, view: &View<'_>) -> Result<(), Failure> {
    let primitives = view.mesh.len();
    line(text, "structure", built.describe(primitives as usize));
    if let Some(why) = &built.why {
        line(text, "chosen because", why);
    }
    describe_shape(text, &built.structure(&view.mesh)?, primitives as usize);
    Ok(())
}

/// What a structure over so many things is made of.
fn describe_shape(text: &mut String, structure: &Structure<'_>, things: usize) {
    if structure.kind().is_none() {
        line(text, "expected per ray", format!("{} tests", count(things)));
        return;
    }
    let Shape { nodes, references, depth, expected_nodes, expected_tests } = Shape::of(structure);
    line(text, "nodes", count(nodes));
    line(text, "references", count(references));
    line(text, "depth", depth);
    let expected = format!("{expected_nodes:.1} nodes, {expected_tests:.1} tests, if nothing is hit");
    line(text, "expected per ray", expected);
}

fn describe_sections(text: &mut String, asset: &Asset<'_>) {
    let words = asset.as_words();
    let mut rest = words.len();
    for section in asset.sections() {
        rest -= section.words.len();
        let bytes = format!("{} bytes, version {}", count(section.words.len() * 4), section.version);
        line(text, &section.kind.to_string(), bytes);
    }
    line(text, "header and padding", format!("{} bytes", count(rest * 4)));
    line(text, "total", format!("{} bytes", count(words.len() * 4)));
}
