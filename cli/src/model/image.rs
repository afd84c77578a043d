//! [`Image`]: the picture that a material names, not yet read.

use std::path::PathBuf;
use std::{fmt, io};

use super::error::excerpt;
use super::read_file;

/// A picture on a material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Where its file's bytes are.
    pub contents: Contents,
    /// Whether its pixels are to be seen as squares.
    pub nearest: bool,
    /// Whether its edge goes on beside it, and not the picture again.
    pub clamp: bool,
}

/// Where a file's bytes are.
#[derive(Clone, PartialEq, Eq)]
pub enum Contents {
    /// In a file of their own.
    File(PathBuf),
    /// Within the model's files, or why they are not.
    Here(Result<Vec<u8>, String>),
}

impl Image {
    /// The bytes of the picture's file.
    ///
    /// # Errors
    ///
    /// What the system says of the file, or what is wrong with the model's.
    pub fn read(&self) -> io::Result<Vec<u8>> {
        match &self.contents {
            Contents::File(path) => read_file(path),
            Contents::Here(bytes) => bytes.clone().map_err(io::Error::other),
        }
    }
}

/// What it is called, on one line.
impl fmt::Display for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.contents {
            Contents::File(path) => write!(f, "`{}`", excerpt(&path.display().to_string())),
            Contents::Here(_) => f.write_str("in the model"),
        }
    }
}

impl fmt::Debug for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.fmt(f),
            Self::Here(bytes) => write!(f, "{:?}", bytes.as_ref().map(Vec::len)),
        }
    }
}
