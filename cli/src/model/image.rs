//! [`Image`]: the picture that a material names, not yet read.

use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;

use super::error::excerpt;
use super::{Model, read_file};
use crate::input::explain;

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

/// Where a file's bytes are: what is equal is the same picture.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Contents {
    /// In a file of their own.
    File(PathBuf),
    /// In the model's own files, under this number.
    Here(usize),
}

impl Model {
    /// The bytes of a picture's file, or what is wrong with it and how to mend that.
    pub fn read_picture(&self, contents: &Contents) -> Result<Cow<'_, [u8]>, String> {
        match contents {
            Contents::File(path) => read_file(path).map(Cow::Owned).map_err(|error| explain(&error)),
            Contents::Here(number) => match self.pictures.get(number) {
                Some(Ok(bytes)) => Ok(Cow::Borrowed(bytes)),
                Some(Err(why)) => Err(why.clone()),
                None => Err("not in the model: export it again".to_owned()),
            },
        }
    }
}

/// What it is called, on one line.
impl fmt::Display for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "`{}`", excerpt(&path.display().to_string())),
            Self::Here(number) => write!(f, "{number} of the model"),
        }
    }
}
