use std::fmt;

/// Why there is no Embree, or no scene.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// There is no such library, or it lacks a function.
    Library(libloading::Error),
    /// It is neither Embree 3 nor Embree 4.
    Version(isize),
    /// Embree made no device, or says that something failed; its own number for it.
    Embree(i32),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(error) => write!(f, "{error}"),
            Self::Version(major) => write!(f, "Embree 3 and 4 are known, this is {major}"),
            Self::Embree(code) => write!(f, "Embree failed with error {code}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<libloading::Error> for Error {
    fn from(error: libloading::Error) -> Self {
        Self::Library(error)
    }
}
