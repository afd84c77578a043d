use hitscan::{
    Bvh, LatticeMesh, Mesh,
    accel::{Plan, Structure},
    bake::{self, Baker, InMeshlets, OnLattice},
    bvh,
    glam::Vec3,
    primitives::{Indices, QuadMesh},
};

use super::super::predict;
use crate::{
    chip::{self, Chip},
    failure::Failure,
    scene::{Built, Choice, Palette, Preset, Skin, broken},
};

/// How the corners of triangles are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    /// As numbers of vertices.
    Plain,
    /// In bytes, three a triangle.
    Meshlets,
    /// In bytes, four a pair of triangles.
    Quads,
}

/// What is stored of vertices.
pub struct Vertices {
    /// Positions.
    pub positions: Vec<Vec3>,
    /// The same on a lattice, if that is what is stored.
    pub snapped: Option<OnLattice>,
    /// Normals.
    pub normals: Option<Vec<Vec3>>,
    /// Pictures.
    pub skin: Option<Skin>,
}

impl Vertices {
    /// The triangles between them.
    pub fn triangles<'a>(&'a self, indices: Indices<'a>) -> Result<Triangles<'a>, Failure> {
        match &self.snapped {
            None => Ok(Triangles::Plain(Mesh::new(&self.positions, indices).map_err(broken)?)),
            Some(snapped) => Ok(Triangles::OnLattice(snapped.mesh(indices).map_err(broken)?)),
        }
    }

    /// In the order that meshlets take.
    pub fn ordered<const CORNERS: usize>(&self, meshlets: &InMeshlets<CORNERS>) -> Self {
        let on_lattice = |snapped: &OnLattice| OnLattice { vertices: meshlets.vertices(&snapped.vertices), ..*snapped };
        Self {
            positions: meshlets.vertices(&self.positions),
            snapped: self.snapped.as_ref().map(on_lattice),
            normals: self.normals.as_ref().map(|normals| meshlets.vertices(normals)),
            skin: self.skin.as_ref().map(|skin| skin.ordered(meshlets)),
        }
    }

    /// An asset of them and the triangles between them.
    pub fn bake(
        &self,
        packing: Packing,
        indices: Indices<'_>,
        palette: &Palette,
        structure: Option<Structure<'_>>,
        numbers: Option<&Vec<u32>>,
    ) -> Result<Vec<u32>, Failure> {
        match packing {
            Packing::Plain => self.bake_as_given(indices, palette, structure, numbers),
            Packing::Meshlets => {
                let meshlets = bake::meshlets(indices);
                self.ordered(&meshlets).bake_as_given(meshlets.indices(), palette, structure, numbers)
            }
            Packing::Quads => {
                let quads = bake::quads(indices).map_err(broken)?;
                self.ordered(&quads).bake_as_given(quads.indices(), palette, structure, numbers)
            }
        }
    }

    fn bake_as_given(
        &self,
        indices: Indices<'_>,
        palette: &Palette,
        structure: Option<Structure<'_>>,
        numbers: Option<&Vec<u32>>,
    ) -> Result<Vec<u32>, Failure> {
        let mut baker = match &self.snapped {
            None => Baker::new().mesh(&Mesh::new(&self.positions, indices).map_err(broken)?),
            Some(snapped) => Baker::new().lattice_mesh(&snapped.mesh(indices).map_err(broken)?),
        };
        if let Some(normals) = &self.normals {
            baker = baker.normals(normals);
        }
        if let Some(structure) = structure {
            baker = baker.structure(structure);
        }
        if let Some(numbers) = numbers {
            baker = baker.numbers(numbers);
        }
        let baker = dressed(baker, palette);
        Ok(match &self.skin {
            Some(skin) => skin.bake(baker).finish(),
            None => baker.finish(),
        })
    }
}

/// An order of triangles in which neighbours follow one another: that of a hierarchy's leaves.
pub fn neighbours(mesh: &Mesh<'_>) -> Result<Vec<u32>, Failure> {
    let plan = Plan::Bvh(bvh::Options::fast());
    let words = bake::build(mesh, &plan).map_err(broken)?;
    let hierarchy = Bvh::open(&words).map_err(broken)?;
    Ok(hierarchy.order().collect())
}

/// With the materials of a model, if it names any.
pub fn dressed(baker: Baker, palette: &Palette) -> Baker {
    if palette.materials.is_empty() { baker } else { baker.materials(&palette.materials, palette.as_numbers()) }
}

/// The triangles as they are to be stored.
pub enum Triangles<'a> {
    /// Between positions.
    Plain(Mesh<'a>),
    /// Between places on a lattice.
    OnLattice(LatticeMesh<'a>),
    /// In pairs.
    Pairs(QuadMesh<Mesh<'a>>),
    /// Both.
    PairsOnLattice(QuadMesh<LatticeMesh<'a>>),
}

/// What is done with the triangles, of whichever kind.
macro_rules! any {
    ($triangles:expr, $mesh:ident => $result:expr) => {
        match $triangles {
            Triangles::Plain($mesh) => $result,
            Triangles::OnLattice($mesh) => $result,
            Triangles::Pairs($mesh) => $result,
            Triangles::PairsOnLattice($mesh) => $result,
        }
    };
}

impl Triangles<'_> {
    /// The same two at a time, as they stand.
    pub fn in_pairs(self) -> Result<Self, Failure> {
        Ok(match self {
            Self::Plain(mesh) => Self::Pairs(QuadMesh::new(mesh).map_err(broken)?),
            Self::OnLattice(mesh) => Self::PairsOnLattice(QuadMesh::new(mesh).map_err(broken)?),
            pairs => pairs,
        })
    }

    /// A structure over them, and the order of its leaves.
    pub fn build(&self, choice: Choice, preset: Preset, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        any!(self, mesh => Built::within(mesh, choice, preset, most)?.ordered(mesh)).map(|built| self.spread(built))
    }

    /// The structure over them that is fastest on a chip, and the order of its leaves.
    pub fn choose(&self, chip: Chip, choice: Choice, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        any!(self, mesh => chip::choose(mesh, chip, choice, most)?.ordered(mesh)).map(|built| self.spread(built))
    }

    /// An order of triangles, not of pairs.
    fn spread(&self, (built, order): (Built, Vec<u32>)) -> (Built, Vec<u32>) {
        match self {
            Self::Plain(_) | Self::OnLattice(_) => (built, order),
            _ => (built, order.into_iter().flat_map(|quad| [2 * quad, 2 * quad + 1]).collect()),
        }
    }

    /// Adds what an asset of so many bytes, with a structure over them, will cost on a chip.
    pub fn predict(&self, text: &mut String, chip: Chip, built: &Built, asset: usize) -> Result<(), Failure> {
        any!(self, mesh => predict(text, chip, built, mesh, asset))
    }
}
