//! PLY, text and binary of both byte orders: positions and faces; other elements and properties are
//! passed over.

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Header, Property, PropertyAccess, PropertyAccessResult};

use super::{Fault, LoadError, Model};

/// Reads the file's `bytes`.
pub(super) fn read(bytes: &[u8]) -> Result<Model, LoadError> {
    if !bytes.starts_with(b"ply") {
        return Err(Fault::NotA("a PLY").into());
    }
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader)?;
    let mut vertices: Vec<Vertex> = Vec::new();
    let mut faces: Vec<Face> = Vec::new();
    for element in header.elements.values() {
        check(element, bytes.len())?;
        match element.name.as_str() {
            "vertex" => vertices = elements(&mut reader, element, &header)?,
            "face" => faces = elements(&mut reader, element, &header)?,
            _ => drop(elements::<Skipped>(&mut reader, element, &header)?),
        }
    }

    let mut model = Model::default();
    for Vertex(at) in vertices {
        model.push_vertex(at)?;
    }
    let (count, mut corners) = (model.vertices.len(), Vec::new());
    for Face(indices) in faces {
        corners.clear();
        for index in indices {
            let corner = u32::try_from(index).ok().filter(|index| (*index as usize) < count);
            corners.push(corner.ok_or(Fault::IndexOutOfRange {
                triangle: model.triangles.len(),
                index,
                vertices: count,
                first: 0,
            })?);
        }
        model.push_polygon(&corners, 0);
    }
    Ok(model)
}

/// Refuses what the reader would fill with zeros, and counts that it would allocate for in vain.
fn check(element: &ElementDef, size: usize) -> Result<(), Fault> {
    let has = |property: &str| element.properties.contains_key(property);
    match element.name.as_str() {
        "vertex" if !["x", "y", "z"].into_iter().all(has) => {
            return Err(Fault::Malformed("the vertices lack x, y or z".to_owned()));
        }
        "face" if !FACE_LISTS.into_iter().any(has) => {
            return Err(Fault::Malformed("the faces lack a list `vertex_indices`".to_owned()));
        }
        _ => {}
    }
    // An element takes a byte at least.
    if element.count > size {
        let missing = format!("{} of `{}` announced, {size} bytes", element.count, element.name);
        return Err(Fault::Truncated { missing });
    }
    Ok(())
}

fn elements<E: PropertyAccess>(
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<Vec<E>, ParseError> {
    Parser::new().read_payload_for_element(reader, element, header)
}

/// Of the reader's many lines, the first says what is wrong and the second shows it.
impl From<ParseError> for LoadError {
    fn from(error: ParseError) -> Self {
        let text = error.to_string();
        let message = match error.line() {
            Some(line) => text.trim_start_matches(&format!("Line {line}: ")),
            None => &text,
        };
        let plain = |line: &str| {
            let line = line.trim().trim_start_matches("String: ");
            line.trim_matches(['.', '\'']).to_owned()
        };
        let message = message.lines().take(2).map(plain).collect::<Vec<_>>();
        let message = message.join(": ");
        LoadError { line: error.line(), ..Fault::Malformed(message).into() }
    }
}

/// The names in use for a face's list of corners.
const FACE_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// A position.
#[derive(Default)]
struct Vertex([f32; 3]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        match value.to_f32_lossy() {
            Some(x) => self.0[axis] = x,
            None => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

/// A polygon's corners, signed as in the file so that errors can show them.
#[derive(Default)]
struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !FACE_LISTS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match value {
            Property::ListChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListInt(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUInt(list) => list.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element of no interest.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Skipped
    }
}

#[cfg(test)]
mod tests {
    use super::super::{load_bytes, survives_damage};

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\n\
        property float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 255\n1 0 0 255\n1 1 0 255\n0 0.1 0 255\n4 0 1 2 3\n3 2 2 2\n";

    fn header(encoding: &str) -> Vec<u8> {
        format!(
            "ply\nformat {encoding} 1.0\nelement face 2\nproperty list uchar uint vertex_index\n\
             property float quality\nelement vertex 4\nproperty double z\nproperty float y\n\
             property short x\nelement edge 1\nproperty int a\nend_header\n"
        )
        .into_bytes()
    }

    /// The same mesh with the faces first, odd types and elements to skip.
    fn binary(big: bool) -> Vec<u8> {
        let mut bytes = header(if big { "binary_big_endian" } else { "binary_little_endian" });
        let mut push = |little: &[u8]| {
            let mut word = little.to_vec();
            if big {
                word.reverse();
            }
            bytes.extend(word);
        };
        for face in [[0, 1, 2, 3].as_slice(), &[2, 2, 2]] {
            push(&[face.len() as u8]);
            face.iter().for_each(|index: &u32| push(&index.to_le_bytes()));
            push(&0.5_f32.to_le_bytes());
        }
        for (x, y) in [(0_i16, 0_f32), (1, 0.0), (1, 1.0), (0, 0.1)] {
            push(&0_f64.to_le_bytes());
            push(&y.to_le_bytes());
            push(&x.to_le_bytes());
        }
        push(&7_i32.to_le_bytes());
        bytes
    }

    #[test]
    fn all_encodings_give_the_same_triangles() {
        for bytes in [TEXT.as_bytes(), &binary(false), &binary(true)] {
            let model = load_bytes("a.ply", bytes).unwrap();
            let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.1, 0.0]];
            assert_eq!(model.vertices, square);
            assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [2, 2, 2]]);
        }
    }

    #[test]
    fn errors_name_the_place() {
        let complaint = |from: &str, to: &str| {
            let text = load_bytes("a.ply", TEXT.replace(from, to).as_bytes()).unwrap_err().to_string();
            text.split_once("a.ply").unwrap().1.to_owned()
        };
        let index = complaint("3 2 2 2", "3 2 -2 2");
        assert!(index.starts_with(": triangle 2 names vertex -2, but the file has 4"), "{index}");
        let count = complaint("vertex 4", "vertex 4000000000000");
        assert!(count.contains("4000000000000 of `vertex` announced"), "{count}");
        let value = complaint("1 1 0 255", "1 1 zero 255");
        assert!(value.starts_with(":14: ") && value.contains("line: 1 1 zero 255: "), "{value}");
        assert!(complaint("float x", "float u").contains("lack x, y or z"));
        assert!(complaint("vertex_indices", "corners").contains("lack a list"));
        assert!(complaint("4 0 1 2 3\n3 2 2 2\n", "1 0\n2 0 1\n").contains("no triangles"));
    }

    #[test]
    fn damage_is_refused_not_panicked_at() {
        survives_damage("a.ply", TEXT.as_bytes());
        survives_damage("a.ply", &binary(false));
        survives_damage("a.ply", &binary(true));
    }
}
