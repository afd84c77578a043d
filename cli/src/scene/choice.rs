use std::str::FromStr;

use hitscan::accel::{
    Plan,
    bvh::{self, Method},
    dualsplit, grid,
    kdtree::{self, Split},
    octree,
};

use super::Preset;

/// A structure that can be asked for by name.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// Its name on the command line.
    pub name: &'static str,
    /// How it is built in words; not at all if it is [`Wide`](super::Wide).
    plan: Option<fn(Preset) -> Plan>,
    /// What visiting a node of it takes, in tests of a triangle: measured, rounded, the same on every machine, so that
    /// what is recommended does not depend on the weather.
    pub node_cost: f64,
    /// Whether `auto` may choose it; the others are there to be compared with.
    pub is_candidate: bool,
}

/// The options that a preset has for a structure.
macro_rules! tuned {
    ($preset:expr, $options:ty) => {
        match $preset {
            Preset::Small => <$options>::small(),
            Preset::Balanced => <$options>::balanced(),
            Preset::Fast => <$options>::fast(),
        }
    };
}

/// A kD-tree that is divided in this way.
fn kd(preset: Preset, split: Split) -> Plan {
    Plan::KdTree(kdtree::Options { split, ..tuned!(preset, kdtree::Options) })
}

/// A hierarchy that is built in this way.
fn bvh(preset: Preset, method: Method) -> Plan {
    Plan::Bvh(bvh::Options { method, ..tuned!(preset, bvh::Options) })
}

impl Named {
    /// All of them, the list first: answers and speeds are compared with its own.
    pub const ALL: &[Self] = &[
        Self { is_candidate: false, ..Self::new("list", 0.0, |_| Plan::List) },
        Self::new("grid", 2.8, |preset| Plan::Grid(tuned!(preset, grid::Options))),
        Self::new("octree", 1.6, |preset| Plan::Octree(tuned!(preset, octree::Options))),
        Self { is_candidate: false, ..Self::new("kdtree-midpoint", 0.65, |preset| kd(preset, Split::Midpoint)) },
        Self { is_candidate: false, ..Self::new("kdtree-median", 0.65, |preset| kd(preset, Split::Median)) },
        Self::new("kdtree", 0.65, |preset| kd(preset, Split::Sah)),
        Self::new("kdtree-compact", 0.75, |preset| Plan::CompactKdTree(tuned!(preset, kdtree::Options))),
        Self::new("bvh", 1.25, |preset| bvh(preset, Method::Sah)),
        Self { is_candidate: false, ..Self::new("bvh-ploc", 1.25, |preset| bvh(preset, Method::Ploc)) },
        Self::new("dual-split", 0.85, |preset| Plan::DualSplit(tuned!(preset, dualsplit::Options))),
        Self::WIDE,
    ];

    /// The one for hosts alone.
    const WIDE: Self = Self { name: "wide", plan: None, node_cost: 0.0, is_candidate: false };

    /// One that `auto` may choose.
    const fn new(name: &'static str, node_cost: f64, plan: fn(Preset) -> Plan) -> Self {
        Self { name, plan: Some(plan), node_cost, is_candidate: true }
    }

    /// What `auto` takes where trials would last too long.
    const ASSUMED: &str = "kdtree";

    /// The one of this name.
    pub fn find(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|named| named.name == name)
    }

    /// The list.
    pub fn list() -> &'static Self {
        &Self::ALL[0]
    }

    /// What is taken where nothing is tried.
    pub fn assumed() -> &'static Self {
        Self::find(Self::ASSUMED).unwrap_or(Self::list())
    }

    /// Whether it is the one for hosts alone, which is not built by a plan.
    pub fn is_wide(&self) -> bool {
        self.plan.is_none()
    }

    /// How it is built for a preset, within so many bytes if it can be made to fit.
    pub fn plan(&self, preset: Preset, most: Option<usize>) -> Option<Plan> {
        Some(match (self.plan?(preset), most) {
            (Plan::Grid(options), Some(bytes)) => Plan::Grid(options.fit(bytes)),
            (Plan::Octree(options), Some(bytes)) => Plan::Octree(options.fit(bytes)),
            (Plan::KdTree(options), Some(bytes)) => Plan::KdTree(options.fit(bytes)),
            (Plan::CompactKdTree(options), Some(bytes)) => Plan::CompactKdTree(options.fit(bytes)),
            (Plan::Bvh(options), Some(bytes)) => Plan::Bvh(options.fit(bytes)),
            (plan, _) => plan,
        })
    }

    /// Its name and, if that makes a difference, the preset's.
    pub fn title(&self, preset: Preset) -> String {
        if self.plan.is_some_and(|plan| plan(Preset::Small) == plan(Preset::Fast)) {
            return self.name.to_owned();
        }
        format!("{} {}", self.name, preset.name())
    }
}

impl PartialEq for Named {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Named {}

/// What is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// What suits the primitives.
    #[default]
    Auto,
    /// This one.
    Named(&'static Named),
}

impl Choice {
    /// The names that can be given, of all or of those alone that are built in words.
    fn names(all: bool) -> String {
        let named = Named::ALL.iter().filter(|named| all || !named.is_wide());
        let names: Vec<&str> = named.map(|named| named.name).collect();
        format!("auto, {}", names.join(", "))
    }

    /// What the help says of an option for a structure over `what`.
    pub fn help(what: &str) -> String {
        format!("Structure over the {what}: {}", Self::names(false))
    }
}

impl FromStr for Choice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match Named::find(text) {
            Some(named) => Ok(Self::Named(named)),
            None if text == "auto" => Ok(Self::Auto),
            None => Err(format!("unknown structure, choose one of {}", Self::names(true))),
        }
    }
}

/// The options that choose a structure.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct StructureArgs {
    #[arg(short, long, value_name = "NAME", help = Choice::help("primitives")
          + "; or wide, which renders, casts at and compares meshes, the fastest of all [default: the asset's own, or auto]")]
    pub structure: Option<Choice>,
    /// What the structure is tuned for
    #[arg(short, long, value_name = "PRESET", default_value = "balanced")]
    pub preset: Preset,
}

impl StructureArgs {
    /// As they are given on the command line.
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = vec!["--preset".to_owned(), self.preset.name().to_owned()];
        if let Some(choice) = self.structure {
            let name = match choice {
                Choice::Auto => "auto",
                Choice::Named(named) => named.name,
            };
            arguments.extend(["--structure".to_owned(), name.to_owned()]);
        }
        arguments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_or_refused() {
        for named in Named::ALL {
            assert_eq!(named.name.parse(), Ok(Choice::Named(named)));
        }
        assert_eq!("auto".parse(), Ok(Choice::Auto));
        let error = "tree".parse::<Choice>().unwrap_err();
        assert!(error.starts_with("unknown structure, choose one of auto, list, "), "{error}");
    }

    #[test]
    fn names_are_unique_and_the_list_is_first() {
        for (place, named) in Named::ALL.iter().enumerate() {
            assert_eq!(Named::ALL.iter().position(|other| other == named), Some(place));
        }
        assert_eq!(Named::list().plan(Preset::Fast, None), Some(Plan::List));
        assert!(Named::ALL.iter().all(|named| named.is_wide() == (named.name == "wide")));
        assert!(Named::assumed().is_candidate);
        assert_eq!(Named::list().title(Preset::Fast), "list");
        assert_eq!(Named::assumed().title(Preset::Fast), "kdtree fast");
    }
}
