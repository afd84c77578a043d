//! Wavefront OBJ: `v`, `vt`, `f`, `usemtl` and `mtllib`; all other statements are passed over.
//!
//! Read here and not by a library, because the ones at hand drop unused vertices, divide by a
//! fourth coordinate and report no line.

use std::collections::HashMap;
use std::path::Path;
use std::str::SplitAsciiWhitespace;

use super::error::excerpt;
use super::{Fault, LoadError, Mapping, Material, Model, mtl, read_companion};
use crate::input;

/// What some editors put before the first statement.
pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// Reads the file's `bytes`; its material libraries lie in `folder`.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, LoadError> {
    // Comments and names may be in any encoding; statements are ASCII.
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches(BYTE_ORDER_MARK);
    // Faces may name vertices that follow them, so count first.
    let keywords = || text.lines().map(|line| line.split_ascii_whitespace().next());
    let vertices = keywords().filter(|word| *word == Some("v")).count();
    if vertices == 0 && !keywords().any(|word| word == Some("f")) {
        return Err(Fault::NotA("an OBJ").into());
    }

    let mut model = Model { vertices: Vec::with_capacity(vertices), ..Model::default() };
    let mut library = HashMap::new();
    let mut ids = HashMap::new();
    let mut current = None;
    let (mut corners, mut places) = (Vec::new(), Vec::new());
    for (number, line) in (1..).zip(text.lines()) {
        let mut words = line.split_ascii_whitespace();
        let keyword = words.next();
        let statement = || match keyword {
            Some("v") => model.push_vertex(
                position(words).ok_or_else(|| Fault::Syntax { found: line.to_owned(), expected: "three numbers" })?,
            ),
            Some("vt") => {
                model.mapping.coordinates.push(coordinates(words));
                Ok(())
            }
            Some("f") => {
                corners.clear();
                places.clear();
                for word in words.take_while(|word| !word.starts_with('#')) {
                    corners.push(corner(word, &model, vertices)?);
                    places.push(place(word, &model.mapping));
                }
                let material = match current {
                    Some(id) => id,
                    None => *current.insert(material_id("", &mut ids, &mut model)?),
                };
                model.mapping.push_polygon(model.triangles.len(), &places);
                model.push_polygon(&corners, material);
                Ok(())
            }
            Some("usemtl") => {
                current = Some(material_id(argument(line), &mut ids, &mut model)?);
                Ok(())
            }
            Some("mtllib") => {
                library.extend(materials(argument(line), folder, &mut model.warnings));
                Ok(())
            }
            _ => Ok(()),
        };
        statement().map_err(|fault| LoadError::at_line(number, fault))?;
    }
    for material in &mut model.materials {
        if let Some(known) = library.remove(&material.name) {
            *material = known;
        } else if !material.name.is_empty() {
            let name = excerpt(&material.name);
            let warning = format!("material `{name}` is in no library: drawn grey");
            model.warnings.push(warning);
        }
    }
    Ok(model)
}

/// `x y z`; a weight or a colour after them is passed over.
fn position(mut words: SplitAsciiWhitespace<'_>) -> Option<[f32; 3]> {
    // `str::parse` rounds to the nearest f32, so `%.9g` text reads back to the bits it came from.
    let mut next = || words.next()?.parse().ok();
    Some([next()?, next()?, next()?])
}

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative indices count back from the newest vertex.
fn corner(word: &str, model: &Model, vertices: usize) -> Result<u32, Fault> {
    let text = word.split('/').next().unwrap_or_default();
    let index: i64 =
        text.parse().map_err(|_| Fault::Syntax { found: word.to_owned(), expected: "a vertex number first" })?;
    let before = if index < 0 { model.vertices.len() as i64 } else { -1 };
    let place = index.saturating_add(before);
    if (0..vertices as i64).contains(&place) {
        Ok(place as u32)
    } else {
        Err(Fault::IndexOutOfRange { triangle: model.triangles.len(), index, vertices, first: 1 })
    }
}

/// `u v`, from the lower left corner of a picture: turned over, as pictures begin at the upper one.
fn coordinates(mut words: SplitAsciiWhitespace<'_>) -> [f32; 2] {
    let mut next = |otherwise| words.next().map_or(otherwise, |word| word.parse().unwrap_or(f32::NAN));
    [next(f32::NAN), 1.0 - next(0.0)]
}

/// The number of the texture coordinates of a corner, if it names any. They need not be there yet;
/// what never comes is no reason to refuse a mesh.
fn place(word: &str, mapping: &Mapping) -> u32 {
    let index = word.split('/').nth(1).and_then(|text| text.parse::<i64>().ok()).unwrap_or(0);
    let before = if index < 0 { mapping.coordinates.len() as i64 } else { -1 };
    u32::try_from(index.saturating_add(before)).unwrap_or(Mapping::NONE)
}

/// The number of the material `name`, a new and neutral one where it was not met before.
fn material_id(name: &str, ids: &mut HashMap<String, u16>, model: &mut Model) -> Result<u16, Fault> {
    if let Some(id) = ids.get(name) {
        return Ok(*id);
    }
    let id = model.push_material(Material::neutral(name))?;
    ids.insert(name.to_owned(), id);
    Ok(id)
}

/// The materials of the libraries a `mtllib` names: one with spaces in its name, or several.
fn materials(names: &str, folder: &Path, warnings: &mut Vec<String>) -> HashMap<String, Material> {
    let names = names.replace('\\', "/");
    let files = match folder.join(&names).is_file() {
        true => vec![names.as_str()],
        false => names.split_whitespace().collect(),
    };
    let mut materials = HashMap::new();
    for file in files {
        match read_companion(folder, file) {
            Ok(bytes) => {
                let beside = folder.join(file);
                let beside = beside.parent().unwrap_or(folder);
                materials.extend(mtl::read(&String::from_utf8_lossy(&bytes), beside));
            }
            Err(error) => {
                let (file, reason) = (excerpt(file), input::explain(&error));
                warnings.push(format!("material library `{file}`: {reason}"));
            }
        }
    }
    materials
}

/// The rest of a line after its keyword: one name, spaces and all.
fn argument(line: &str) -> &str {
    line.trim().split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim())
}

#[cfg(test)]
mod tests {
    use super::super::{load_bytes, survives_damage};
    use super::*;
    use std::fs;

    const SQUARE: &str = "mtllib none.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .5 .5 .5\nv 0 1 0\n";

    fn complaint(faces: &str) -> String {
        let text = load_bytes("a.obj", [SQUARE, faces].concat().as_bytes()).unwrap_err().to_string();
        text.split_once("a.obj").unwrap().1.to_owned()
    }

    #[test]
    fn order_duplicates_and_degenerates_are_kept() {
        let faces = "f 1/1/1 2//2 3/3 4\nusemtl red\nf 1 1 1\nf -1 -2 -3 # back\nf -1 -2 -3\nf 1 2\n";
        let model = load_bytes("a.obj", [SQUARE, faces].concat().as_bytes()).unwrap();
        assert_eq!(model.vertices[2], [1.0, 1.0, 0.0]);
        assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [0, 0, 0], [3, 2, 1], [3, 2, 1]]);
        assert_eq!(model.material_ids, [0, 0, 1, 1, 1]);
        assert_eq!(model.warnings.len(), 2, "{:?}", model.warnings);
    }

    #[test]
    fn materials_come_from_the_library() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("my mesh.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
        let path = folder.path().join("my mesh.obj");
        fs::write(&path, "\u{feff}usemtl red\nf 1 2 3\nmtllib my mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0").unwrap();
        let model = Model::load(&path).unwrap();
        assert_eq!(model.materials[0].diffuse, [1.0, 0.0, 0.0]);
        assert!(model.warnings.is_empty() && model.material_ids.is_empty());
    }

    #[test]
    fn nine_digits_read_back_to_the_same_bits() {
        let mut bits = 1_u32;
        for _ in 0..10_000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let x = f32::from_bits(bits);
            let text = format!("v {x:.8e} 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
            if x.is_finite() {
                let model = read(text.as_bytes(), Path::new("")).unwrap();
                assert_eq!(model.vertices[0][0].to_bits(), bits, "{text}");
            }
        }
    }

    #[test]
    fn errors_name_the_line() {
        assert!(
            complaint("f 1 2 3\nf 1 2 5\n")
                .starts_with(":7: triangle 1 names vertex 5, but the file has 4 vertices, counted from 1: ")
        );
        assert!(complaint("f 0 1 2").starts_with(":6: triangle 0 names vertex 0"));
        assert!(complaint("f -5 1 2").starts_with(":6: triangle 0 names vertex -5"));
        assert!(complaint("f -9223372036854775808 1 2").starts_with(":6: triangle 0 names"));
        assert!(complaint("f 1 2 x/1").starts_with(":6: `x/1` needs a vertex number first: "));
        assert!(complaint("v 1 2\n").starts_with(":6: `v 1 2` needs three numbers: "));
        assert!(complaint("v 1 nan 2").starts_with(":6: vertex 4 (counted from 0) is not finite"));
        assert!(complaint("v 1e39 0 2").contains("not finite as f32: [inf, 0.0, 2.0]"));
        assert!(complaint("").starts_with(": the file holds no triangles"));
    }

    #[test]
    fn damage_is_refused_not_panicked_at() {
        survives_damage("a.obj", [SQUARE, "usemtl m\nf 1/1/1 2 -1\nf 4 3 2 1"].concat().as_bytes());
    }
}
