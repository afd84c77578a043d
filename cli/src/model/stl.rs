//! STL, binary and text, vertices welded where all bits agree (so 0.0 and -0.0 stay apart).
//!
//! Read here and not by a library, because the one at hand takes binary files whose header begins
//! with `solid` for text and stops after the first solid of several.

use std::collections::HashMap;

use super::{Fault, LoadError, Model};
use crate::units::things;

/// Bytes before a binary file's triangles: 80 of header and a u32 count.
const HEAD: usize = 84;
/// Bytes of a binary triangle: normal, three vertices, two bytes of attributes.
const RECORD: usize = 50;

/// Reads the file's `bytes`.
pub(super) fn read(bytes: &[u8]) -> Result<Model, LoadError> {
    let count = bytes.get(HEAD - 4..HEAD).map_or(0, |n| le_u32(n) as usize);
    let size = HEAD.saturating_add(count.saturating_mul(RECORD));
    // Only the size tells the two apart: many binary headers begin with `solid` too.
    if bytes.len() == size {
        binary(&bytes[HEAD..])
    } else if is_text(bytes) {
        text(&String::from_utf8_lossy(bytes))
    } else if bytes.len() < HEAD || bytes.is_ascii() {
        Err(Fault::NotA("an STL").into())
    } else if bytes.len() < size {
        let (records, has) = (bytes.len().saturating_sub(HEAD) / RECORD, bytes.len());
        let announced = things(count, "triangle", "triangles");
        let missing = format!("{announced} announced, {records} in its {has} bytes");
        Err(Fault::Truncated { missing }.into())
    } else {
        let mut model = binary(&bytes[HEAD..size])?;
        model.warnings.push(format!("{} bytes after the last triangle", bytes.len() - size));
        Ok(model)
    }
}

fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start().get(..5).unwrap_or_default();
    start.eq_ignore_ascii_case(b"solid") && !bytes.contains(&0)
}

fn binary(records: &[u8]) -> Result<Model, LoadError> {
    let mut welder = Welder::default();
    for record in records.chunks_exact(RECORD) {
        for corner in record[12..48].chunks_exact(12) {
            welder.push([0, 4, 8].map(|at| f32::from_bits(le_u32(&corner[at..]))))?;
        }
        welder.close();
    }
    Ok(welder.model)
}

fn text(text: &str) -> Result<Model, LoadError> {
    let mut welder = Welder::default();
    let mut last = String::new();
    for (number, line) in (1..).zip(text.lines()) {
        let mut words = line.split_ascii_whitespace();
        let Some(keyword) = words.next() else {
            continue;
        };
        let at_line = |fault| LoadError::at_line(number, fault);
        let syntax = |expected| {
            let found = line.to_owned();
            at_line(Fault::Syntax { found, expected })
        };
        last = keyword.to_ascii_lowercase();
        match last.as_str() {
            "vertex" => {
                let mut next = || words.next()?.parse().ok();
                let mut at = || Some([next()?, next()?, next()?]);
                let at = at().ok_or_else(|| syntax("three numbers"))?;
                welder.push(at).map_err(at_line)?;
            }
            "endloop" if welder.corners.len() == 3 => welder.close(),
            "endloop" => return Err(syntax("three vertices before it")),
            _ if !welder.corners.is_empty() => return Err(syntax("an endloop before it")),
            "solid" | "facet" | "outer" | "endfacet" | "endsolid" => {}
            _ => return Err(syntax("one of STL's keywords first")),
        }
    }
    if last != "endsolid" {
        return Err(Fault::Truncated { missing: "no endsolid".to_owned() }.into());
    }
    Ok(welder.model)
}

/// Gives equal corners one vertex.
#[derive(Default)]
struct Welder {
    model: Model,
    seen: HashMap<[u32; 3], u32>,
    corners: Vec<u32>,
}

impl Welder {
    fn push(&mut self, at: [f32; 3]) -> Result<(), Fault> {
        let bits = at.map(f32::to_bits);
        let corner = match self.seen.get(&bits) {
            Some(vertex) => *vertex,
            None => {
                let vertex = self.model.vertices.len() as u32;
                self.model.push_vertex(at)?;
                self.seen.insert(bits, vertex);
                vertex
            }
        };
        self.corners.push(corner);
        Ok(())
    }

    fn close(&mut self) {
        self.model.push_polygon(&self.corners, 0);
        self.corners.clear();
    }
}

fn le_u32(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

#[cfg(test)]
mod tests {
    use super::super::{load_bytes, survives_damage};

    const TEXT: &str = "solid two words\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
        vertex -0 1e0 0\nendloop\nendfacet\nendsolid\nsolid\n FACET NORMAL 0 0 1\n outer loop\n\
        vertex 1 0 0\nvertex 0 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid two\n";

    fn binary_file(header: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const PAIR: [[[f32; 3]; 3]; 2] =
        [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.0, 1.0, 0.0]]];

    #[test]
    fn both_kinds_are_welded_by_bits() {
        for bytes in [TEXT.as_bytes(), &binary_file(b"solid but binary", &PAIR)] {
            let model = load_bytes("a.stl", bytes).unwrap();
            assert_eq!(model.triangles, [[0, 1, 2], [1, 0, 3]]);
            assert_eq!(model.vertices.len(), 4);
            assert_eq!((model.materials.len(), model.material_ids.len()), (1, 0));
        }
    }

    #[test]
    fn errors_name_the_place() {
        let complaint = |bytes: &[u8]| load_bytes("a.stl", bytes).unwrap_err().to_string();
        let cut = complaint(&binary_file(b"", &PAIR)[..150]);
        assert!(cut.contains("2 triangles announced, 1 in its 150 bytes"), "{cut}");
        let bad = complaint(TEXT.replace("vertex 1 0 0", "vertex 1 0 o").as_bytes());
        assert!(bad.contains("a.stl:5: `vertex 1 0 o` needs three numbers"), "{bad}");
        let four = complaint(TEXT.replace("vertex 1 0 0", "vertex 1 0 0\nvertex 1 0 0").as_bytes());
        assert!(four.contains("a.stl:8: `endloop` needs three vertices"), "{four}");
        let open = complaint(TEXT.replacen("endloop", "", 1).as_bytes());
        assert!(open.contains("a.stl:8: `endfacet` needs an endloop"), "{open}");
        let nan = complaint(&binary_file(b"", &[[[f32::NAN; 3]; 3]]));
        assert!(nan.contains("vertex 0 (counted from 0) is not finite"), "{nan}");
        assert!(complaint(&binary_file(b"", &[])).contains("no triangles"));
    }

    #[test]
    fn bytes_after_the_end_are_a_warning() {
        let mut bytes = binary_file(b"", &PAIR);
        bytes.extend(b"!!");
        assert_eq!(load_bytes("a.stl", &bytes).unwrap().warnings, ["2 bytes after the last triangle"]);
    }

    #[test]
    fn damage_is_refused_not_panicked_at() {
        survives_damage("a.stl", TEXT.as_bytes());
        survives_damage("a.stl", &binary_file(b"", &PAIR));
    }
}
