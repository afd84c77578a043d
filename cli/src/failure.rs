//! [`Failure`]: why the program stops, printed as `hitscan: WHAT: HOW TO MEND IT`.

use std::io::{self, Write};
use std::process::ExitCode;

use crate::input::InputError;
use crate::model::LoadError;
use crate::output::OutputError;

/// Any error the program ends with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// A mesh could not be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// An input could not be read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// An output could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// Two structures answer the same rays differently: what this program promises not to happen.
    #[error("{0}: the answers should be equal bit for bit, please report this with the mesh and the rays")]
    Disagreement(String),
    /// A structure that may have so many bytes needs more.
    #[error("a structure that may take {allowed} bytes needs {least}: allow more bytes, or simplify the mesh")]
    Crowded {
        /// What it may take.
        allowed: usize,
        /// What it takes at least.
        least: usize,
    },
    /// Anything else.
    #[error("{what}: {mend}")]
    Other {
        /// What is wrong, and where.
        what: String,
        /// What to do about it.
        mend: String,
    },
}

impl Failure {
    /// A failure in the words of the place where it happens.
    pub fn new(what: impl ToString, mend: impl ToString) -> Self {
        Failure::Other { what: what.to_string(), mend: mend.to_string() }
    }

    /// The same, if two structures disagree, with the mesh over which they do.
    pub fn about(self, mesh: &str) -> Self {
        match self {
            Failure::Disagreement(what) => Failure::Disagreement(format!("{mesh}: {what}")),
            other => other,
        }
    }

    /// Prints the failure and gives the code to exit with.
    pub fn report(&self) -> ExitCode {
        // Standard error may be closed; then there is nobody left to tell, and no reason to panic.
        let _ = writeln!(io::stderr(), "hitscan: {self}");
        ExitCode::from(if matches!(self, Failure::Disagreement(_)) { 1 } else { 2 })
    }
}

/// Prints what is worth knowing but no reason to stop.
pub fn warn(text: &str) {
    let _ = writeln!(io::stderr(), "hitscan: warning: {text}");
}

/// Prints a report where standard output is taken for data.
pub fn note(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_failure_is_one_line_with_what_and_how() {
        let missing = Path::new("/nowhere/at/all.obj");
        let failures = [
            Failure::from(crate::model::Model::load(missing).unwrap_err()),
            Failure::from(crate::input::read(missing).unwrap_err()),
            Failure::from(crate::output::write_atomically(missing, |_| Ok(())).unwrap_err()),
            Failure::new("--fit 64Q", "give a size such as 64K"),
        ];
        for text in failures.map(|failure| failure.to_string()) {
            assert!(!text.contains('\n') && text.contains(": "), "{text}");
        }
    }
}
