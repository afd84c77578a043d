use std::{fmt::Write as _, path::Path};

use hitscan::{
    accel::Structure,
    asset::{Asset, Kind},
};

use crate::{
    failure::Failure,
    scene::{Built, Shape},
    units::{count, things},
};

/// The bytes by what they are for, and the worst case of a ray.
pub fn table(
    words: &[u32],
    built: &Built,
    structure: &Structure<'_>,
    triangles: usize,
    output: &Path,
) -> Result<String, Failure> {
    let (mut geometry, mut tree, mut materials, mut textures) = (0, 0, 0, 0);
    let asset = Asset::from_words(words).map_err(|error| Failure::new(error, "report this as a bug"))?;
    for section in asset.sections() {
        let bytes = section.words.len() * 4;
        match section.kind {
            Kind::Vertices
            | Kind::LatticeVertices
            | Kind::Meshlets
            | Kind::Quads
            | Kind::NarrowIndices
            | Kind::WideIndices
            | Kind::Normals
            | Kind::Soup => geometry += bytes,
            Kind::Materials | Kind::MaterialNumbers => materials += bytes,
            Kind::Textures | Kind::TexCoords => textures += bytes,
            _ => tree += bytes,
        }
    }
    let total = words.len() * 4;
    let rows = [
        ("geometry", geometry),
        ("structure", tree),
        ("materials", materials),
        ("textures", textures),
        ("header and padding", total - geometry - tree - materials - textures),
        ("total", total),
    ];
    let mut text = format!(
        "{}: {}\n{:<20}{:>14}{:>14}\n",
        output.display(),
        things(triangles, "triangle", "triangles"),
        "",
        "bytes",
        "per triangle"
    );
    for (what, bytes) in rows.into_iter().filter(|(what, bytes)| *bytes > 0 || *what != "textures") {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{what:<20}{:>14}{:>14.2}", count(bytes), bytes as f64 / triangles as f64);
    }
    let _ = writeln!(text, "structure: {}, {}", built.name, built.time());
    if let Some(why) = &built.why {
        let _ = writeln!(text, "chosen because: {why}");
    }
    let _ = if structure.kind().is_some() {
        let Shape { depth, nodes, .. } = Shape::of(structure);
        writeln!(text, "worst case of a ray: depth {depth}, {}", things(nodes, "node", "nodes"))
    } else {
        writeln!(text, "worst case of a ray: {} tested", things(triangles, "triangle", "triangles"))
    };
    Ok(text)
}
