use hitscan::{List, Primitives, Scene, accel::Structure, asset::Kind, bake, error::BuildError};

use super::{Choice, Named, Preset, Queries};
use crate::{failure::Failure, progress::Progress, trial, units};

/// Evaluates an expression with the structure itself in place of the enum over all, so that no walk asks at every step
/// which one it is.
macro_rules! unwrapped {
    ($structure:expr, $name:ident => $body:expr) => {
        match $structure {
            hitscan::accel::Structure::List($name) => $body,
            hitscan::accel::Structure::Grid($name) => $body,
            hitscan::accel::Structure::Octree($name) => $body,
            hitscan::accel::Structure::KdTree($name) => $body,
            hitscan::accel::Structure::CompactKdTree($name) => $body,
            hitscan::accel::Structure::Bvh($name) => $body,
            hitscan::accel::Structure::DualSplit($name) => $body,
            $name => $body,
        }
    };
}

pub(crate) use unwrapped;

/// A structure and what it took to get it.
#[derive(Debug)]
pub struct Built {
    /// What it is; nothing is a list.
    kind: Option<Kind>,
    /// Its words; a list has none.
    words: Vec<u32>,
    /// How it came about, for people.
    pub name: String,
    /// Why it was chosen, if nobody asked for it.
    pub why: Option<String>,
    /// What building or checking it took.
    pub seconds: f64,
    /// Whether it was read and checked instead of built.
    opened: bool,
}

impl Built {
    /// Builds what was asked for over `primitives`.
    pub fn new<P: Primitives + Sync>(primitives: &P, choice: Choice, preset: Preset) -> Result<Self, Failure> {
        Self::within(primitives, choice, preset, None)
    }

    /// As [`new`](Self::new), in at most so many bytes.
    pub fn within<P: Primitives + Sync>(
        primitives: &P,
        choice: Choice,
        preset: Preset,
        most: Option<usize>,
    ) -> Result<Self, Failure> {
        match choice {
            Choice::Auto => trial::choose(primitives, preset, most),
            Choice::Named(named) => Self::named(primitives, named, preset, most),
        }
    }

    /// Builds a structure of the table.
    pub fn named<P: Primitives>(
        primitives: &P,
        named: &Named,
        preset: Preset,
        most: Option<usize>,
    ) -> Result<Self, Failure> {
        let name = named.title(preset);
        let Some(plan) = named.plan(preset, most) else {
            let what = format!("{} is for render, cast and compare", named.name);
            return Err(Failure::new(what, "choose another structure"));
        };
        let progress = Progress::spinner(&format!("building the {name} …"));
        let words = bake::build(primitives, &plan).map_err(refuse)?;
        let seconds = progress.finish();
        Ok(Self { kind: plan.kind(), words, name, why: None, seconds, opened: false })
    }

    /// The structure of an asset, which took so many seconds to check.
    pub fn of_asset(structure: &Structure<'_>, seconds: f64) -> Self {
        let name = structure.kind().map_or("list".to_owned(), |kind| format!("{kind} of the asset"));
        let words = structure.as_words().to_vec();
        Self { kind: structure.kind(), words, name, why: None, seconds, opened: true }
    }

    /// The same, with the reason why it was chosen.
    pub fn because(self, why: String) -> Self {
        Self { why: Some(why), ..self }
    }

    /// The same over `primitives` in the order of its leaves, and that order; as it is, if its leaves need a list.
    pub fn ordered<P: Primitives>(self, primitives: &P) -> Result<(Self, Vec<u32>), Failure> {
        Ok(match bake::ordered(&self.structure(primitives)?) {
            Some((words, order)) => (Self { words, ..self }, order),
            None => (self, (0..primitives.len()).collect()),
        })
    }

    /// How long it took to get it.
    pub fn time(&self) -> String {
        let verb = if self.opened { "checked" } else { "built" };
        format!("{verb} in {}", units::seconds(self.seconds))
    }

    /// The structure itself, over `primitives`.
    pub fn structure<P: Primitives>(&self, primitives: &P) -> Result<Structure<'_>, Failure> {
        match self.kind {
            Some(kind) => Structure::open(kind, &self.words).map_err(broken),
            None => Ok(List::new(primitives).map_err(refuse)?.into()),
        }
    }

    /// Bytes of the structure itself.
    pub fn bytes(&self) -> usize {
        self.words.len() * 4
    }

    /// Bytes of the structure once it is baked: over primitives in the order of its leaves, where that spares a list.
    pub fn baked_bytes<P: Primitives>(&self, primitives: &P) -> Result<usize, Failure> {
        Ok(bake::ordered(&self.structure(primitives)?).map_or(self.bytes(), |(words, _)| words.len() * 4))
    }

    /// The structure over `primitives`, ready for rays.
    pub fn scene<'a, P: Primitives + Sync + 'a>(&'a self, primitives: &'a P) -> Result<Box<dyn Queries + 'a>, Failure> {
        unwrapped!(self.structure(primitives)?, structure => {
            Ok(Box::new(Scene::new(structure, primitives).map_err(broken)?))
        })
    }

    /// Name, bytes and build time in one line.
    pub fn describe(&self, primitives: usize) -> String {
        let per_primitive = self.bytes() as f64 / primitives.max(1) as f64;
        let (bytes, time) = (units::count(self.bytes()), self.time());
        format!("{}, {bytes} bytes ({per_primitive:.1} per primitive), {time}", self.name)
    }
}

/// Why a structure cannot be built, and what to do about it.
pub fn refuse(error: BuildError) -> Failure {
    let mend = match error {
        BuildError::Full(_) => "free some memory, or choose `--preset small`",
        BuildError::Bounds { .. } => "remove that primitive or move the mesh nearer to the origin",
        BuildError::TooMany { .. } => "split the mesh",
        BuildError::Budget { at_least, allowed } => return Failure::Crowded { allowed, least: at_least },
    };
    Failure::new(format!("the structure cannot be built: {error}"), mend)
}

/// What was built or checked does not hold together.
pub fn broken(error: impl std::fmt::Display) -> Failure {
    Failure::new(error, "bake the asset again")
}
