//! [`Model`]: the triangles of a mesh file, in the file's order, with its materials.
//!
//! `load` promises: nothing is removed, reordered or moved, so triangle *n* of the model is triangle
//! *n* of the file; every vertex is finite; every index is in range; there is a triangle at least.

mod error;
mod gltf;
mod guard;
mod image;
mod mapping;
mod material;
mod mtl;
mod obj;
mod ply;
mod stl;

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

pub use error::{Fault, LoadError};
pub use guard::caught;
pub use image::{Contents, Image};
pub use mapping::Mapping;
pub use material::Material;

/// The file name endings [`Model::load`] knows, for its errors and the help text.
pub const EXTENSIONS: &str = ".obj, .stl, .ply, .gltf or .glb, each also with .gz";

/// An indexed triangle mesh with materials.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Positions.
    pub vertices: Vec<[f32; 3]>,
    /// Three indices into `vertices` each, polygons cut into fans.
    pub triangles: Vec<[u32; 3]>,
    /// One at least.
    pub materials: Vec<Material>,
    /// An index into `materials` per triangle, or empty when there is one material.
    pub material_ids: Vec<u16>,
    /// Where in the pictures of materials the triangles lie.
    pub mapping: Mapping,
    /// The pictures that lie in the model's own files, by their numbers there, or what is wrong with them.
    pub pictures: BTreeMap<usize, Result<Vec<u8>, String>>,
    /// Which part of the file each run of triangles is, and where; none if the format places nothing.
    pub placements: Vec<Placement>,
    /// What was wrong in the file without spoiling its geometry, one line each.
    pub warnings: Vec<String>,
}

/// A part of a file where it is placed: the same part may be there several times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The part's number in the file.
    pub part: usize,
    /// Its vertices in the model.
    pub vertices: Range<usize>,
    /// Its triangles in the model.
    pub triangles: Range<usize>,
}

impl Model {
    /// Loads a mesh file, its format told by its extension.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        read(path).map_err(|error| LoadError { path: path.to_owned(), ..error })
    }

    fn push_vertex(&mut self, at: [f32; 3]) -> Result<(), Fault> {
        let vertex = self.vertices.len();
        if !at.iter().all(|x| x.is_finite()) {
            return Err(Fault::NonFinite { vertex, at });
        }
        if vertex == u32::MAX as usize {
            return Err(Fault::TooMany("vertices"));
        }
        self.vertices.push(at);
        Ok(())
    }

    /// Cuts a polygon into the fan around its first corner; points and lines leave no triangle.
    fn push_polygon(&mut self, corners: &[u32], material: u16) {
        self.triangles.extend(fan(corners));
        self.material_ids.resize(self.triangles.len(), material);
    }

    fn push_material(&mut self, material: Material) -> Result<u16, Fault> {
        let id = u16::try_from(self.materials.len()).map_err(|_| Fault::TooManyMaterials)?;
        self.materials.push(material);
        Ok(id)
    }

    fn finish(mut self) -> Result<Self, Fault> {
        match self.triangles.len() {
            0 => return Err(Fault::NoTriangles),
            // The last u32 means "no triangle" in the hit files.
            n if n > u32::MAX as usize => return Err(Fault::TooMany("triangles")),
            _ => {}
        }
        if self.materials.is_empty() {
            self.materials.push(Material::neutral(""));
        }
        if self.materials.len() == 1 {
            self.material_ids = Vec::new();
        }
        Ok(self)
    }
}

/// The triangles around the first corner of a polygon.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let edges = corners.get(1..).unwrap_or_default().windows(2);
    edges.map(|edge| [corners[0], edge[0], edge[1]])
}

fn read(path: &Path) -> Result<Model, LoadError> {
    if fs::metadata(path)?.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let (name, zipped) = match name.strip_suffix(".gz") {
        Some(name) => (name, true),
        None => (name.as_str(), false),
    };
    let read: fn(&[u8], &Path) -> Result<Model, LoadError> = match name.rsplit_once('.') {
        Some((_, "obj")) => obj::read,
        Some((_, "stl")) => |bytes, _| stl::read(bytes),
        Some((_, "ply")) => |bytes, _| guard::guarded(|| ply::read(bytes)),
        Some((_, "gltf" | "glb")) => |bytes, folder| guard::guarded(|| gltf::read(bytes, folder)),
        _ => return Err(Fault::UnknownExtension.into()),
    };
    let mut bytes = fs::read(path)?;
    if zipped {
        let mut plain = Vec::new();
        let mut unzip = flate2::bufread::MultiGzDecoder::new(bytes.as_slice());
        unzip.read_to_end(&mut plain).map_err(Fault::Gzip)?;
        bytes = plain;
    }
    if bytes.is_empty() {
        return Err(Fault::Empty.into());
    }
    Ok(read(&bytes, path.parent().unwrap_or(Path::new("")))?.finish()?)
}

/// Reads a file that a mesh file names.
fn read_companion(folder: &Path, name: &str) -> io::Result<Vec<u8>> {
    read_file(&folder.join(name))
}

/// Reads a file, but leaves devices alone: a mesh must not make us read without end.
fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    match fs::metadata(path)?.is_file() {
        true => fs::read(path),
        false => Err(io::Error::other("not a regular file")),
    }
}

/// A file name and its bytes through [`Model::load`], for the readers' tests.
#[cfg(test)]
fn load_bytes(name: &str, bytes: &[u8]) -> Result<Model, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), bytes).unwrap();
    Model::load(&folder.path().join(name))
}

/// Every beginning of a good file, and the file with each byte damaged, must load or be refused in
/// one line.
#[cfg(test)]
fn survives_damage(name: &str, good: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let check = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        if let Err(error) = Model::load(&path) {
            let text = error.to_string();
            assert!(!text.contains('\n') && text.starts_with(path.to_str().unwrap()), "{text:?}");
        }
    };
    load_bytes(name, good).unwrap();
    (0..good.len()).for_each(|end| check(&good[..end]));
    for (place, byte) in (0..good.len()).flat_map(|place| [0, b' ', b'9', 255].map(|b| (place, b))) {
        let mut damaged = good.to_vec();
        damaged[place] = byte;
        check(&damaged);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn complaint(name: &str, bytes: &[u8]) -> String {
        let text = load_bytes(name, bytes).unwrap_err().to_string();
        text.split_once(name).unwrap().1.to_owned()
    }

    #[test]
    fn errors_say_what_where_and_how_to_mend() {
        assert_eq!(complaint("a.obj", b""), ": the file is empty: export the mesh again");
        assert!(complaint("a.xyz", b"1 2 3").contains("use a file ending in .obj, .stl, .ply"));
        assert!(complaint("noextension", b"1").contains("unknown mesh format"));
        assert!(complaint("a.obj.gz", b"v 0 0 0").contains("not a whole gzip file"));
        for name in ["a.obj", "a.stl", "a.ply", "a.gltf", "a.glb"] {
            let binary: Vec<u8> = (0..=255).rev().cycle().take(1000).collect();
            for garbage in [binary.as_slice(), b"Dear diary,\nno mesh today.\n", b"\0", b"{}"] {
                assert!(complaint(name, garbage).contains(": "), "{name}");
            }
        }
    }

    #[test]
    fn missing_files_and_directories_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = Model::load(&folder.path().join("no.obj")).unwrap_err().to_string();
        assert!(missing.ends_with("no.obj: no such file: check the path"), "{missing}");
        let directory = Model::load(folder.path()).unwrap_err().to_string();
        assert!(directory.ends_with("is a directory: name a file in it"), "{directory}");
    }

    #[test]
    fn gzip_and_upper_case_are_understood() {
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        gz.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let gz = gz.finish().unwrap();
        assert_eq!(load_bytes("A.OBJ.GZ", &gz).unwrap().triangles, [[0, 1, 2]]);
        survives_damage("a.obj.gz", &gz);
    }
}
