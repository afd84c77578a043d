//! Knots under structures of every kind, for `bench` and `calibrate`.

use std::{error::Error, fs, path::Path};

use hitscan::{
    Grid, Mesh, Primitives, Scene,
    accel::{List, Plan, Structure},
    bake::{self, Baker},
    bvh, dualsplit, grid, kdtree, octree,
};

use crate::{answer::Answer, camera, camera_answer, knot};

/// What `bench` compares.
fn plans() -> Vec<(&'static str, Plan)> {
    vec![
        ("grid small", Plan::Grid(grid::Options::small())),
        ("grid balanced", Plan::Grid(grid::Options::balanced())),
        ("grid fast", Plan::Grid(grid::Options::fast())),
        ("octree balanced", Plan::Octree(octree::Options::balanced())),
        ("kdtree small", Plan::KdTree(kdtree::Options::small())),
        ("kdtree balanced", Plan::KdTree(kdtree::Options::balanced())),
        ("kdtree fast", Plan::KdTree(kdtree::Options::fast())),
        ("kdtree-compact small", Plan::CompactKdTree(kdtree::Options::small())),
        ("kdtree-compact balanced", Plan::CompactKdTree(kdtree::Options::balanced())),
        ("bvh balanced", Plan::Bvh(bvh::Options::balanced())),
        ("dual-split small", Plan::DualSplit(dualsplit::Options::small())),
        ("dual-split balanced", Plan::DualSplit(dualsplit::Options::balanced())),
        ("dual-split fast", Plan::DualSplit(dualsplit::Options::fast())),
    ]
}

/// An asset, and the bytes of the structure in it.
type Asset = (Vec<u32>, usize);

/// The asset of the finest grid with which it takes at most so many bytes.
fn finest_grid(most: usize, asset: impl Fn(&Plan) -> Result<Asset, Box<dyn Error>>) -> Result<Asset, Box<dyn Error>> {
    let densities = (4..80).rev().map(|step| step as f32 / 20.0);
    for density in densities {
        let (words, structure) = asset(&Plan::Grid(grid::Options { density, ..grid::Options::balanced() }))?;
        if words.len() * 4 <= most {
            return Ok((words, structure));
        }
    }
    Err("no grid fits".into())
}

/// The asset of triangles under a grid.
fn under_grid<P: Primitives>(primitives: &P, baker: Baker, plan: &Plan) -> Result<Asset, Box<dyn Error>> {
    let words = bake::build(primitives, plan)?;
    Ok((baker.structure(Grid::open(&words)?).finish(), words.len() * 4))
}

/// The line of a contestant, whose asset goes to a file.
fn contestant(
    out: &Path,
    (size, name): (&str, &str),
    (triangles, bytes): (usize, usize),
    asset: Vec<u32>,
    answer: Answer,
) -> Result<String, Box<dyn Error>> {
    let file = out.join(format!("{size} {name}.hits"));
    fs::write(&file, asset.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;
    Ok(format!(
        "    Contestant {{ name: {name:?}, triangles: {triangles}, bytes: {bytes}, baked: Baked {{ bytes: \
         hitscan::include_asset!({file:?}), answer: {answer:?} }} }},\n"
    ))
}

/// The knots under every plan, in the order of the leaves where there are no references.
pub fn contest(out: &Path, small: bool) -> Result<String, Box<dyn Error>> {
    let mut code = "/// What `bench` compares.\npub static CONTEST: &[Contestant] = &[\n".to_string();
    // All of it takes 3 MB of flash; a micro:bit has room for these three over the smaller knot.
    let few = ["grid small", "kdtree small", "dual-split balanced"];
    let knots = [("1k", (100, 5)), ("5k", (250, 10))];
    for (size, (along, around)) in knots.into_iter().take(if small { 1 } else { 2 }) {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        for (name, plan) in plans().into_iter().filter(|(name, _)| !small || few.contains(name)) {
            let kind = plan.kind().ok_or("every plan has a kind")?;
            let mut words = bake::build(&mesh, &plan)?;
            let mut corners = bake::reorder(&mesh, &(0..mesh.indices().len() as u32).collect::<Vec<_>>());
            if let Some((ordered, order)) = bake::ordered(&Structure::open(kind, &words)?) {
                corners = bake::reorder(&mesh, &order);
                words = ordered;
            }
            let mesh = Mesh::new(&vertices, corners.as_slice())?;
            let structure = Structure::open(kind, &words)?;
            let asset = Baker::new().mesh(&mesh).structure(structure).finish();
            // By the list: the structures are what is compared.
            let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
            code += &contestant(out, (size, name), (corners.len(), words.len() * 4), asset, answer)?;
        }
    }
    code += "];\n\n/// The finest grids within bytes a triangle: over a mesh, and over meshlets on a lattice.\n";
    code += "pub static GRIDS: &[Contestant] = &[\n";
    for (size, (along, around)) in knots.into_iter().take(if small { 0 } else { 2 }) {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        let all = triangles.len();
        let (asset, bytes) = finest_grid(24 * all, |plan| under_grid(&mesh, Baker::new().mesh(&mesh), plan))?;
        let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
        code += &contestant(out, (size, "grid within-24"), (all, bytes), asset, answer)?;
        let meshlets = bake::meshlets(&mesh);
        let vertices = meshlets.vertices(&vertices);
        let snapped = bake::lattice(&Mesh::new(&vertices, meshlets.indices())?);
        let mesh = snapped.mesh(meshlets.indices())?;
        let baker = Baker::new().lattice_mesh(&mesh);
        let (asset, bytes) = finest_grid(14 * all, |plan| under_grid(&mesh, baker.clone(), plan))?;
        let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
        code += &contestant(out, (size, "grid-lattice within-14"), (all, bytes), asset, answer)?;
    }
    code += "];\n\n/// Triangles with their corners, where there is room.\npub static SOUPS: &[Contestant] = &[\n";
    for (size, (along, around)) in knots.into_iter().take(if small { 0 } else { 2 }) {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
        for (name, plan) in [
            ("kdtree-soup fast", Plan::KdTree(kdtree::Options::fast())),
            ("grid-soup fast", Plan::Grid(grid::Options::fast())),
        ] {
            let words = bake::build(&mesh, &plan)?;
            let structure = Structure::open(plan.kind().ok_or("every plan has a kind")?, &words)?;
            let asset = Baker::new().soup(&mesh).structure(structure).finish();
            code += &contestant(out, (size, name), (triangles.len(), words.len() * 4), asset, answer)?;
        }
    }
    code += "];\n\n/// What rays along axes meet, by how many triangles there are and of `camera::level` and `camera::parallel`.\n";
    code += "pub static ALONG: &[(usize, [Answer; 2])] = &[\n";
    for (_, (along, around)) in knots.into_iter().take(if small { 0 } else { 2 }) {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        let list = Scene::new(List::new(&mesh)?, &mesh)?;
        let answers = [camera::level, camera::parallel].map(|row| {
            let mut answer = Answer::NONE;
            (0..camera::HEIGHT).flat_map(row).for_each(|ray| answer.add(list.closest_hit(&ray)));
            answer
        });
        code += &format!("    ({}, {answers:?}),\n", triangles.len());
    }
    Ok(code + "];\n")
}
