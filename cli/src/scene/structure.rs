use std::str::FromStr;

use hitscan::{
    Error, KdTree, List, Primitives, Scene,
    accel::{Plan, kdtree},
    bake,
    error::BuildError,
};

use super::Queries;
use crate::{failure::Failure, progress::Progress, units};

/// Up to this many primitives, testing all of them beats any structure.
const HANDFUL: u32 = 8;

/// The structures that can be asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Structure {
    /// What suits the number of primitives.
    #[default]
    Auto,
    /// None: every ray tests every primitive.
    List,
    /// The kD-tree.
    KdTree,
}

impl Structure {
    /// Those that this version builds.
    const BUILT: [(&str, Self); 3] = [("auto", Self::Auto), ("list", Self::List), ("kdtree", Self::KdTree)];

    /// Names that belong to structures of other versions.
    const RESERVED: [&str; 5] = ["grid", "octree", "bvh", "dual-split", "wide"];

    /// What to build over so many primitives.
    pub fn resolve(self, primitives: u32) -> Self {
        match self {
            Self::Auto if primitives <= HANDFUL => Self::List,
            Self::Auto => Self::KdTree,
            known => known,
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::BUILT.into_iter().find(|(_, structure)| *structure == self).map_or("", |(name, _)| name)
    }
}

impl FromStr for Structure {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some((_, structure)) = Self::BUILT.into_iter().find(|(name, _)| *name == text) {
            return Ok(structure);
        }
        let has = Self::BUILT.map(|(name, _)| name).join(", ");
        let what = if Self::RESERVED.contains(&text) { "this version does not have it" } else { "unknown structure" };
        Err(format!("{what}, choose one of {has}"))
    }
}

/// How much memory a structure may take for speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Preset {
    /// The fewest bytes.
    Small,
    /// Nearly as fast in less than half the bytes of `fast`.
    #[default]
    Balanced,
    /// The least time per ray.
    Fast,
}

impl Preset {
    /// What it means for kD-trees.
    pub const fn kd_options(self) -> kdtree::Options {
        match self {
            Self::Small => kdtree::Options::small(),
            Self::Balanced => kdtree::Options::balanced(),
            Self::Fast => kdtree::Options::fast(),
        }
    }

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "small",
            Self::Balanced => "balanced",
            Self::Fast => "fast",
        }
    }
}

/// The options that choose a structure.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct StructureArgs {
    /// Structure over the primitives: auto, list or kdtree [default: the asset's own, or auto]
    #[arg(short, long, value_name = "NAME")]
    pub structure: Option<Structure>,
    /// What the structure is tuned for
    #[arg(short, long, value_name = "PRESET", default_value = "balanced")]
    pub preset: Preset,
}

/// A structure and what it took to get it.
#[derive(Debug)]
pub struct Built {
    /// Words of the kD-tree; the list has none.
    words: Option<Vec<u32>>,
    /// How it came about, for people.
    pub name: String,
    /// What that took.
    seconds: f64,
    /// Whether it was read and checked instead of built.
    opened: bool,
}

impl Built {
    /// Builds what was asked for over `primitives`.
    pub fn new<P: Primitives>(primitives: &P, structure: Structure, preset: Preset) -> Result<Self, Failure> {
        Self::with_options(primitives, structure, preset, &preset.kd_options())
    }

    /// As [`new`](Self::new), with the knobs of `preset` changed.
    pub fn with_options<P: Primitives>(
        primitives: &P,
        structure: Structure,
        preset: Preset,
        options: &kdtree::Options,
    ) -> Result<Self, Failure> {
        let structure = structure.resolve(primitives.len());
        let progress = Progress::spinner(&format!("building the {} …", structure.name()));
        let (words, name) = match structure {
            Structure::KdTree => {
                let words = bake::build(primitives, &Plan::KdTree(*options)).map_err(refuse)?;
                (Some(words), format!("{} {}", structure.name(), preset.name()))
            }
            _ => (None, structure.name().to_owned()),
        };
        Ok(Self { words, name, seconds: progress.finish(), opened: false })
    }

    /// The kD-tree of an asset, which took so many seconds to check.
    pub fn of_asset(tree: &KdTree<'_>, seconds: f64) -> Self {
        let words = Some(tree.as_words().to_vec());
        Self { words, name: "kdtree of the asset".to_owned(), seconds, opened: true }
    }

    /// How long it took to get it.
    pub fn time(&self) -> String {
        let verb = if self.opened { "checked" } else { "built" };
        format!("{verb} in {}", units::seconds(self.seconds))
    }

    /// The kD-tree, if it is one.
    pub fn tree(&self) -> Result<Option<KdTree<'_>>, Failure> {
        let open = |words| KdTree::open(words).map_err(|error| broken(Error::from(error)));
        self.words.as_deref().map(open).transpose()
    }

    /// Bytes of the structure itself.
    pub fn bytes(&self) -> usize {
        self.words.as_ref().map_or(0, |words| words.len() * 4)
    }

    /// The structure over `primitives`, ready for rays.
    pub fn scene<'a, P: Primitives + Sync + 'a>(&'a self, primitives: &'a P) -> Result<Box<dyn Queries + 'a>, Failure> {
        Ok(match self.tree()? {
            Some(tree) => Box::new(Scene::new(tree, primitives).map_err(broken)?),
            None => {
                let list = List::new(primitives).map_err(refuse)?;
                Box::new(Scene::new(list, primitives).map_err(broken)?)
            }
        })
    }

    /// Name, bytes and build time in one line.
    pub fn describe(&self, primitives: usize) -> String {
        let per_primitive = self.bytes() as f64 / primitives.max(1) as f64;
        format!(
            "{}, {} bytes ({per_primitive:.1} per primitive), {}",
            self.name,
            units::count(self.bytes()),
            self.time()
        )
    }
}

/// Why a structure cannot be built, and what to do about it.
fn refuse(error: BuildError) -> Failure {
    let mend = match error {
        BuildError::Full(_) => "free some memory, or choose `--preset small`",
        BuildError::Bounds { .. } => "remove that primitive or move the mesh nearer to the origin",
        BuildError::TooMany { .. } => "split the mesh",
        BuildError::Budget { .. } => "allow more bytes, or simplify the mesh",
    };
    Failure::new(format!("the structure cannot be built: {error}"), mend)
}

fn broken(error: impl std::fmt::Display) -> Failure {
    Failure::new(error, "bake the asset again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_reserved_or_refused() {
        assert_eq!("kdtree".parse(), Ok(Structure::KdTree));
        for name in Structure::RESERVED {
            let error = name.parse::<Structure>().unwrap_err();
            assert_eq!(error, "this version does not have it, choose one of auto, list, kdtree");
        }
        assert!("tree".parse::<Structure>().unwrap_err().starts_with("unknown structure"));
    }

    #[test]
    fn auto_is_a_list_for_a_handful() {
        assert_eq!(Structure::Auto.resolve(HANDFUL), Structure::List);
        assert_eq!(Structure::Auto.resolve(HANDFUL + 1), Structure::KdTree);
        assert_eq!(Structure::List.resolve(1 << 20), Structure::List);
    }
}
