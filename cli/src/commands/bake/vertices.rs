use hitscan::{
    Bvh, LatticeMesh, Mesh,
    accel::{Plan, Structure},
    bake::{self, Baker, InMeshlets, OnLattice},
    bvh,
    glam::Vec3,
    primitives::Indices,
};

use crate::{
    chip::{self, Chip},
    failure::Failure,
    scene::{Built, Choice, Palette, Preset, Skin, broken},
};

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
    pub fn ordered(&self, meshlets: &InMeshlets) -> Self {
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
        indices: Indices<'_>,
        palette: &Palette,
        structure: Option<Structure<'_>>,
        numbers: Option<&Vec<u32>>,
    ) -> Result<Vec<u32>, Failure> {
        let mut baker = match self.triangles(indices)? {
            Triangles::Plain(mesh) => Baker::new().mesh(&mesh),
            Triangles::OnLattice(mesh) => Baker::new().lattice_mesh(&mesh),
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

    /// The same, with corners in meshlets.
    pub fn bake_meshlets(
        &self,
        indices: Indices<'_>,
        palette: &Palette,
        structure: Option<Structure<'_>>,
        numbers: Option<&Vec<u32>>,
    ) -> Result<Vec<u32>, Failure> {
        let meshlets = bake::meshlets(indices);
        self.ordered(&meshlets).bake(meshlets.indices(), palette, structure, numbers)
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
}

impl Triangles<'_> {
    /// A structure over them, and the order of its leaves.
    pub fn build(&self, choice: Choice, preset: Preset, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        match self {
            Self::Plain(mesh) => Built::within(mesh, choice, preset, most)?.ordered(mesh),
            Self::OnLattice(mesh) => Built::within(mesh, choice, preset, most)?.ordered(mesh),
        }
    }

    /// The structure over them that is fastest on a chip, and the order of its leaves.
    pub fn choose(&self, chip: Chip, choice: Choice, most: Option<usize>) -> Result<(Built, Vec<u32>), Failure> {
        match self {
            Self::Plain(mesh) => chip::choose(mesh, chip, choice, most)?.ordered(mesh),
            Self::OnLattice(mesh) => chip::choose(mesh, chip, choice, most)?.ordered(mesh),
        }
    }
}
