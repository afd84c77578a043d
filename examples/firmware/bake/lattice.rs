//! The knots on lattices, for `lattice`.

use std::{error::Error, fmt::Write as _, fs, path::Path};

use hitscan::{
    LatticeMesh, LatticeScene, Mesh,
    accel::{List, Plan, Structure},
    bake::{self, Baker, InMeshlets, OnLattice},
    dualsplit, kdtree,
};

use crate::{answer::Answer, camera, knot};

/// What `lattice` compares.
fn plans(triangles: usize) -> [(&'static str, Plan); 6] {
    [
        // Within 24 bytes per triangle, of which its corners and vertices take 9.
        ("lattice-kdtree-compact small", Plan::CompactKdTree(kdtree::Options::small().fit(triangles * 59 / 4))),
        ("lattice-kdtree-compact balanced", Plan::CompactKdTree(kdtree::Options::balanced())),
        ("lattice-dual-split small", Plan::DualSplit(dualsplit::Options::small())),
        ("lattice-dual-split balanced", Plan::DualSplit(dualsplit::Options::balanced())),
        ("lattice-dual-split fast", Plan::DualSplit(dualsplit::Options::fast())),
        ("lattice-dual-split meshlets", Plan::DualSplit(dualsplit::Options::balanced())),
    ]
}

/// The knots under every plan, with the host's answers; only the small one for a small board.
pub fn contest(out: &Path, small: bool) -> Result<String, Box<dyn Error>> {
    let mut code = "/// What `lattice` compares.\npub static LATTICES: &[Contestant] = &[\n".to_string();
    let sizes: &[_] = if small { &[(100, 5)] } else { &[(100, 5), (250, 10)] };
    for &(along, around) in sizes {
        let (vertices, triangles) = knot::mesh(along, around);
        let snapped = bake::lattice(&Mesh::new(&vertices, triangles.as_slice())?);
        let mesh = snapped.mesh(triangles.as_slice())?;
        for (name, plan) in plans(triangles.len()) {
            let kind = plan.kind().ok_or("every plan has a kind")?;
            let mut words = bake::build(&mesh, &plan)?;
            let mut corners = bake::reorder(&mesh, &(0..triangles.len() as u32).collect::<Vec<_>>());
            if let Some((ordered, order)) = bake::ordered(&Structure::open(kind, &words)?) {
                corners = bake::reorder(&mesh, &order);
                words = ordered;
            }
            // As they are, or in meshlets.
            let packed = name.ends_with("meshlets").then(|| bake::meshlets(corners.as_slice()));
            let moved = packed.as_ref().map(|packed| packed.vertices(&snapped.vertices));
            let snapped = OnLattice { vertices: moved.unwrap_or(snapped.vertices.clone()), ..snapped };
            let mesh = snapped.mesh(packed.as_ref().map_or(corners.as_slice().into(), InMeshlets::indices))?;
            let structure = words.len() * 4;
            let asset = Baker::new().lattice_mesh(&mesh).structure(Structure::open(kind, &words)?).finish();
            let file = out.join(format!("{} {name}.hits", triangles.len()));
            let (count, bytes, answer) = (triangles.len(), structure, answer(&mesh)?);
            fs::write(&file, asset.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;
            writeln!(
                code,
                "    Contestant {{ name: {name:?}, triangles: {count}, bytes: {bytes}, baked: Baked {{ bytes: \
                 hitscan::include_asset!({file:?}), answer: {answer:?} }} }},"
            )?;
        }
    }
    Ok(code + "];\n")
}

/// What a list answers to the camera's rays.
fn answer(mesh: &LatticeMesh<'_>) -> Result<Answer, Box<dyn Error>> {
    let scene = LatticeScene::new(List::new(mesh)?, mesh)?;
    let mut answer = Answer::NONE;
    for ray in (0..camera::HEIGHT).flat_map(camera::row) {
        answer.add(scene.closest_hit(&ray));
    }
    Ok(answer)
}
