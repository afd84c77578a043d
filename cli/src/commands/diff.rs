use std::{path::PathBuf, process::ExitCode};

use super::print;
use crate::{difference::diff, failure::Failure, hits::read_hits};

/// Compare two files of answers to the same rays
///
/// Counts the rays that they answer differently, bit for bit, and shows the first. Exit code 0 if there are none, 1 if there are some, 2 if a file cannot be read.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitscan diff list.answers kdtree.answers")]
pub struct Diff {
    /// Answers as `hitscan cast` writes them; - for standard input
    a: PathBuf,
    /// Answers to compare them with
    b: PathBuf,
}

impl Diff {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        let difference = diff(&read_hits(&self.a)?, &read_hits(&self.b)?);
        print(&difference.to_string())?;
        Ok(ExitCode::from(u8::from(!difference.is_none())))
    }
}
