use std::{collections::BTreeMap, path::Path};

use serde::Deserialize;

use crate::{failure::Failure, input};

/// A description as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// What can be placed.
    #[serde(default)]
    pub part: BTreeMap<String, Part>,
    /// What is placed.
    #[serde(default)]
    pub place: Vec<Place>,
}

/// Something that can be placed: a mesh, or places of other parts.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// A mesh file, or `plant:SEED`.
    pub mesh: Option<String>,
    /// What it is made of otherwise.
    #[serde(default)]
    pub place: Vec<Place>,
}

/// One place of a part, or many.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// Which one.
    pub part: String,
    /// Where to.
    #[serde(default)]
    pub at: [f32; 3],
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub turn: [f32; 3],
    /// How much larger.
    #[serde(default = "one")]
    pub scale: f32,
    /// So many along each axis.
    pub grid: Option<[u32; 3]>,
    /// From one of a grid to the next.
    #[serde(default)]
    pub step: [f32; 3],
    /// So many in a box, anywhere.
    pub scatter: Option<u32>,
    /// The corners of the box.
    #[serde(default)]
    pub from: [f32; 3],
    #[serde(default)]
    pub to: [f32; 3],
    /// What chance begins with.
    #[serde(default)]
    pub seed: u64,
    /// The most degrees by which chance turns each.
    #[serde(default)]
    pub turns: [f32; 3],
    /// By which share chance makes each larger or smaller, at most.
    #[serde(default)]
    pub scales: f32,
}

fn one() -> f32 {
    1.0
}

impl File {
    /// Reads a description.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let bytes = input::read(path)?;
        let refuse = |why: &dyn std::fmt::Display| Failure::new(format!("{}: {why}", path.display()), super::HELP);
        let text = std::str::from_utf8(&bytes).map_err(|error| refuse(&error))?;
        toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            refuse(&format!("line {line}: {}", error.message().replace('\n', " ")))
        })
    }
}
