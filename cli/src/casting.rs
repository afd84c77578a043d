use std::path::Path;

use clap::{Parser, ValueEnum};
use hitscan::{Hit, Ray};

use crate::{
    failure::Failure,
    hits::HitRecord,
    rays::{self, RayRecord},
    scene::{Queries, Source, StructureArgs},
};

/// What rays are asked, and how they are written: together with a scene, all that the hits depend on.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Casting {
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    /// What is asked of each ray
    #[arg(short, long, value_name = "QUERY", default_value = "closest")]
    pub(crate) query: Query,
    /// Rays are eight f32: t_min and t_max follow the direction
    #[arg(short, long)]
    pub(crate) interval: bool,
}

/// The options alone, to read them from their own text.
#[derive(Debug, Parser)]
#[command(no_binary_name = true)]
struct Alone {
    #[command(flatten)]
    casting: Casting,
}

impl Casting {
    /// What [`arguments`](Self::arguments) gave.
    ///
    /// # Errors
    ///
    /// A [`Failure`] that names what is not understood.
    pub fn parse(arguments: &[String]) -> Result<Self, Failure> {
        let parsed = Alone::try_parse_from(arguments).map(|alone| alone.casting);
        parsed.map_err(|error| Failure::new(crate::one_line(&error.to_string()), "use one version everywhere"))
    }

    /// As it is given on the command line, complete.
    #[must_use]
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = self.structure.arguments();
        if let Some(query) = self.query.to_possible_value() {
            arguments.extend(["--query".to_owned(), query.get_name().to_owned()]);
        }
        arguments.extend(self.interval.then(|| "--interval".to_owned()));
        arguments
    }

    /// Bytes of a ray.
    #[must_use]
    pub fn ray_bytes(&self) -> usize {
        rays::size(self.interval)
    }

    /// Opens a mesh or an asset, for as long as `visit` takes, which gets what turns the bytes of rays into those of hits,
    /// as `hitscan cast` reads and writes them.
    ///
    /// # Errors
    ///
    /// What is wrong with the source, or what `visit` returns.
    pub fn open<R>(
        &self,
        source: &Source,
        path: &Path,
        visit: impl FnOnce(&dyn Fn(&[u8]) -> Vec<u8>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        source.with_subject(path, &self.structure, false, |subject| {
            visit(&|bytes| {
                let rays = rays::decode(bytes, self.interval);
                self.query.ask(subject.scene, &rays).iter().flat_map(|hit| hit.to_bytes()).collect()
            })
        })
    }
}

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Query {
    /// The first hit
    Closest,
    /// Whether there is a hit: t = 0 and primitive 0 for yes
    Any,
    /// The number of hits in place of the primitive, 0 for none; t is that of the first
    Count,
}

impl Query {
    /// The answers to rays, in their order.
    pub fn ask(self, scene: &dyn Queries, rays: &[RayRecord]) -> Vec<HitRecord> {
        let rays: Vec<Ray> = rays.iter().map(Ray::from).collect();
        let closest = |hit: Option<Hit>| hit.map_or(HitRecord::MISS, |Hit { t, primitive }| HitRecord { t, primitive });
        let any = |is_hit| if is_hit { HitRecord { t: 0.0, primitive: 0 } } else { HitRecord::MISS };
        let count = |ray: &Ray| {
            let (first, primitive) = scene.count(ray);
            HitRecord { t: first.map_or(f32::INFINITY, |hit| hit.t), primitive }
        };
        match self {
            Self::Closest => scene.first_hits(&rays).into_iter().map(closest).collect(),
            Self::Any => scene.any_hits(&rays).into_iter().map(any).collect(),
            Self::Count => rays.iter().map(count).collect(),
        }
    }

    /// The columns of its answers in a table.
    pub fn columns(self) -> &'static str {
        match self {
            Self::Closest => "t,primitive",
            Self::Any => "hit",
            Self::Count => "t,hits",
        }
    }

    /// An answer in these columns, `t` as the shortest text that reads back to the same f32.
    pub fn cells(self, hit: &HitRecord) -> String {
        let t = if hit.t.is_finite() { hit.t.to_string() } else { String::new() };
        match self {
            Self::Closest if hit.is_miss() => ",".to_owned(),
            Self::Closest | Self::Count => format!("{t},{}", hit.primitive),
            Self::Any => u8::from(!hit.is_miss()).to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_show_what_was_asked() {
        let hit = HitRecord { t: 0.1, primitive: 7 };
        assert_eq!((Query::Closest.cells(&hit), Query::Closest.cells(&HitRecord::MISS)), ("0.1,7".into(), ",".into()));
        assert_eq!((Query::Any.cells(&hit), Query::Any.cells(&HitRecord::MISS)), ("1".into(), "0".into()));
        let none = HitRecord { t: f32::INFINITY, primitive: 0 };
        assert_eq!((Query::Count.cells(&hit), Query::Count.cells(&none)), ("0.1,7".into(), ",0".into()));
    }

    #[test]
    fn options_read_back() {
        for text in ["", "-q count --interval -s bvh -p small", "--query any"] {
            let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
            let arguments = Casting::parse(&words).unwrap().arguments();
            assert_eq!(Casting::parse(&arguments).unwrap().arguments(), arguments, "{text}");
        }
    }
}
