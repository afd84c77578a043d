//! [`read`]: a whole file or standard input, with errors that say how to mend them.

use std::fmt;
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Why an input was refused, printed as `PATH: WHAT: HOW TO MEND IT`.
#[derive(Debug)]
pub struct InputError {
    /// The file; `-` for standard input.
    pub path: PathBuf,
    /// What is wrong.
    pub fault: InputFault,
}

/// What can be wrong with an input of fixed-size records.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InputFault {
    /// The file system refused the file.
    #[error("{}", explain(.0))]
    Io(#[from] io::Error),
    /// The size is no multiple of a record's.
    #[error(
        "{size} bytes are not a whole number of {what}s of {record} bytes, {} are left over: check \
         the file and the options that set its format",
        size % record
    )]
    Ragged {
        /// Bytes in the input.
        size: usize,
        /// Bytes of one record.
        record: usize,
        /// What a record is called.
        what: &'static str,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.fault)
    }
}

impl std::error::Error for InputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.fault)
    }
}

/// Reads all of a file, or of standard input for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>, InputError> {
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    bytes.map_err(|error| InputError { path: path.to_owned(), fault: error.into() })
}

/// Reads an input of records of `record` bytes, each called a `what`.
pub(crate) fn read_records(path: &Path, record: usize, what: &'static str) -> Result<Vec<u8>, InputError> {
    let bytes = read(path)?;
    match bytes.len() {
        size if size % record != 0 => {
            let fault = InputFault::Ragged { size, record, what };
            Err(InputError { path: path.to_owned(), fault })
        }
        _ => Ok(bytes),
    }
}

/// What a refusal to read means and what to do about it.
pub fn explain(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file: check the path".to_owned(),
        ErrorKind::IsADirectory => "is a directory: name a file in it".to_owned(),
        ErrorKind::NotADirectory => "a file stands where the path has a directory: check the path".to_owned(),
        ErrorKind::PermissionDenied => "may not be read: check its permissions".to_owned(),
        _ => format!("cannot be read ({error}): check the disk and try again"),
    }
}
