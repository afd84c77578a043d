//! [`LoadError`]: what is wrong with a mesh file, where, and how to mend it, in one line.

use std::fmt;
use std::path::PathBuf;

use crate::input;
use crate::units::things;

/// Why a mesh file was refused, printed as `PATH:LINE: WHAT: HOW TO MEND IT`.
#[derive(Debug)]
pub struct LoadError {
    /// The file that was to be loaded.
    pub path: PathBuf,
    /// The line at fault, counted from 1, where the format has lines.
    pub line: Option<usize>,
    /// What is wrong.
    pub fault: Fault,
}

/// What can be wrong with a mesh file. Triangles are counted from 0, as in the hit files.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file system refused the file.
    #[error("{}", input::explain(.0))]
    Io(#[from] std::io::Error),
    /// No byte in it.
    #[error("the file is empty: export the mesh again")]
    Empty,
    /// The extension names no format known here.
    #[error("unknown mesh format: use a file ending in {}", super::EXTENSIONS)]
    UnknownExtension,
    /// The compressed stream is broken.
    #[error("not a whole gzip file ({0}): compress or fetch it again")]
    Gzip(std::io::Error),
    /// Nothing in it looks like the format its extension promises.
    #[error("not {0} file: check its extension, or export the mesh again")]
    NotA(&'static str),
    /// A statement that does not parse.
    #[error("`{}` needs {expected}: correct it, or export the mesh again", excerpt(.found))]
    Syntax {
        /// The statement as the file has it.
        found: String,
        /// What would have parsed.
        expected: &'static str,
    },
    /// The file breaks the rules of its format, in its reader's own words.
    #[error("{}: correct the file, or export the mesh again", excerpt(.0))]
    Malformed(String),
    /// The file ends before its contents do.
    #[error("the file ends too early ({missing}): fetch or export the mesh again")]
    Truncated {
        /// What should have followed.
        missing: String,
    },
    /// A glTF buffer that lies outside the file cannot be read.
    #[error("buffer `{}` cannot be read ({reason}): put it beside the .gltf, or export as .glb", excerpt(.uri))]
    Buffer {
        /// The buffer's address as the file has it.
        uri: String,
        /// Why it cannot be read.
        reason: String,
    },
    /// A corner names a vertex that is not there.
    #[error(
        "triangle {triangle} names vertex {index}, but the file has {}, counted from {first}: correct the index, or \
         export the mesh again", things(*vertices, "vertex", "vertices")
    )]
    IndexOutOfRange {
        /// The triangle, counted from 0.
        triangle: usize,
        /// The index as the file has it.
        index: i64,
        /// How many vertices there are.
        vertices: usize,
        /// The index of the first vertex in this format.
        first: u8,
    },
    /// A coordinate is infinite, not a number, or too large for f32.
    #[error(
        "vertex {vertex} (counted from 0) is not finite as f32: {at:?}: remove or correct it in \
         the program that exported the mesh"
    )]
    NonFinite {
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its coordinates as read.
        at: [f32; 3],
    },
    /// Nothing to cast rays at.
    #[error("the file holds no triangles: export faces, not only points, lines or curves")]
    NoTriangles,
    /// More vertices or triangles than 32-bit indices reach.
    #[error("more than 4294967295 {0}: split the mesh")]
    TooMany(&'static str),
    /// More materials than 16-bit indices reach.
    #[error("more than 65536 materials: merge some of them")]
    TooManyMaterials,
    /// The format's reader panicked.
    #[error("the file is damaged in a way its reader does not understand: export the mesh again")]
    Incomprehensible,
}

impl LoadError {
    /// Puts `fault` on a line; the path follows when the error leaves [`super::Model::load`].
    pub(super) fn at_line(line: usize, fault: Fault) -> Self {
        LoadError { path: PathBuf::new(), line: Some(line), fault }
    }
}

impl<F: Into<Fault>> From<F> for LoadError {
    fn from(fault: F) -> Self {
        LoadError { path: PathBuf::new(), line: None, fault: fault.into() }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.fault)
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.fault)
    }
}

/// How many characters of foreign text an error repeats.
const EXCERPT: usize = 100;

/// The beginning of foreign text, fit for one line of a terminal: garbage must not reach it raw.
pub(super) fn excerpt(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let printable = |c: char| {
        if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }
    };
    let mut shown: String = line.chars().take(EXCERPT).map(printable).collect();
    if line.chars().nth(EXCERPT).is_some() {
        shown.push('…');
    }
    shown
}
