//! Knots under structures of every kind, for `bench` and `calibrate`.

use std::{error::Error, fs, path::Path};

use hitscan::{
    Mesh, Primitives, Scene,
    accel::{List, Plan, Structure},
    bake::{self, Baker},
    bvh, dualsplit, grid, kdtree, octree,
    primitives::QuadMesh,
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

/// The asset of the finest grid of a preset's form with which it takes at most so many bytes.
fn finest_grid(
    preset: grid::Options,
    most: usize,
    asset: impl Fn(&Plan) -> Result<Asset, Box<dyn Error>>,
) -> Result<Asset, Box<dyn Error>> {
    let at = |step: u32| asset(&Plan::Grid(grid::Options { density: step as f32 / 50.0, ..preset }));
    let fits = |(words, _): &Asset| words.len() * 4 <= most;
    // Finer grids take more bytes.
    let (mut fitting, mut too_many) = (10, 400);
    while too_many - fitting > 1 {
        let middle = (fitting + too_many) / 2;
        if fits(&at(middle)?) { fitting = middle } else { too_many = middle }
    }
    Some(at(fitting)?).filter(fits).ok_or_else(|| "no grid fits".into())
}

/// The asset of triangles under a structure.
fn under<P: Primitives>(primitives: &P, baker: Baker, plan: &Plan) -> Result<Asset, Box<dyn Error>> {
    let words = bake::build(primitives, plan)?;
    let structure = Structure::open(plan.kind().ok_or("every plan has a kind")?, &words)?;
    Ok((baker.structure(structure).finish(), words.len() * 4))
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
    code += "];\n\n/// The finest grids within bytes a triangle: over a mesh, over its quads, and over these on a lattice.\n";
    code += "pub static GRIDS: &[Contestant] = &[\n";
    for (size, (along, around)) in knots.into_iter().take(if small { 0 } else { 2 }) {
        let (vertices, triangles) = knot::mesh(along, around);
        let mesh = Mesh::new(&vertices, triangles.as_slice())?;
        let all = triangles.len();
        let (balanced, fast) = (grid::Options::balanced(), grid::Options::fast());
        let baker = Baker::new().mesh(&mesh);
        let (asset, bytes) = finest_grid(balanced, 24 * all, |plan| under(&mesh, baker.clone(), plan))?;
        let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
        code += &contestant(out, (size, "grid within-24"), (all, bytes), asset, answer)?;
        let quads = bake::quads(bake::pairs(&mesh).corners.as_slice())?;
        let vertices = quads.vertices(&vertices);
        let mesh = Mesh::new(&vertices, quads.indices())?;
        let (pairs, baker) = (QuadMesh::new(mesh)?, Baker::new().mesh(&mesh));
        let small = under(&pairs, baker.clone(), &Plan::Grid(grid::Options::small()))?;
        let fine = finest_grid(fast, 24 * all, |plan| under(&pairs, baker.clone(), plan))?;
        let tree = |options| under(&pairs, baker.clone(), &Plan::KdTree(options));
        for (name, (asset, bytes)) in [
            ("grid-quads small", small),
            ("grid-quads within-24", fine),
            ("kdtree-quads small", tree(kdtree::Options::small())?),
            ("kdtree-quads balanced", tree(kdtree::Options::balanced())?),
        ] {
            // By the triangles: that they are tested two at a time must not show.
            let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
            code += &contestant(out, (size, name), (all, bytes), asset, answer)?;
        }
        let snapped = bake::lattice(&mesh);
        let mesh = snapped.mesh(&mesh)?;
        let (pairs, baker) = (QuadMesh::new(mesh)?, Baker::new().lattice_mesh(&mesh));
        let (asset, bytes) = finest_grid(balanced, 14 * all, |plan| under(&pairs, baker.clone(), plan))?;
        let answer = camera_answer(&Scene::new(List::new(&mesh)?, &mesh)?);
        code += &contestant(out, (size, "grid-lattice-quads within-14"), (all, bytes), asset, answer)?;
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
