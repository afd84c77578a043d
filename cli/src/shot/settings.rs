use clap::{Parser, ValueEnum};
use hitscan::render::Terms;

use crate::{
    failure::Failure,
    scene::StructureArgs,
    stage::{CameraArg, DEPTHS, Up},
    units::Size,
};

/// What a picture is to be: together with a scene, all that its bytes depend on.
#[derive(Clone, Debug, clap::Args)]
pub struct Settings {
    /// Pixels of the picture
    #[arg(long, value_name = "WxH", default_value = "960x640")]
    pub(crate) size: Size,
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    /// The most mirror images within mirror images
    #[arg(short, long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(0..=DEPTHS as i64 - 1))]
    pub(crate) bounces: u32,
    /// Rays per pixel along each side: 3 makes 9
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) samples: u32,
    /// Where to look from and at, and the vertical angle of view; found by itself if not given
    #[arg(short, long, value_name = "EYE/TARGET[/DEGREES]", allow_hyphen_values = true)]
    pub(crate) camera: Option<CameraArg>,
    /// The axis that points up; guessed from the shape if not given
    #[arg(long, value_name = "AXIS")]
    pub(crate) up: Option<Up>,
    /// The terms of light to compute, separated by commas
    #[arg(long, value_name = "TERMS", value_delimiter = ',', default_values = ["all"])]
    terms: Vec<Term>,
    /// Shade the triangles of a mesh or an asset as if they were curved, but for sharp edges; an asset with normals is so anyway
    #[arg(long)]
    pub(crate) smooth: bool,
    /// No plate below a mesh or an asset
    #[arg(long)]
    pub(crate) no_ground: bool,
}

/// A term of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
enum Term {
    /// All of them
    All,
    /// Light from everywhere
    Ambient,
    /// Light of the lamps, scattered
    Diffuse,
    /// Highlights
    Specular,
    /// Whether lamps are seen at all
    Shadows,
    /// Mirror images
    Reflections,
}

/// The settings alone, to read them from their own text.
#[derive(Debug, Parser)]
#[command(no_binary_name = true)]
struct Alone {
    #[command(flatten)]
    settings: Settings,
}

impl Settings {
    /// The settings that [`arguments`](Self::arguments) gave.
    ///
    /// # Errors
    ///
    /// A [`Failure`] that names what is not understood.
    pub fn parse(arguments: &[String]) -> Result<Self, Failure> {
        let parsed = Alone::try_parse_from(arguments).map(|alone| alone.settings);
        parsed.map_err(|error| Failure::new(crate::one_line(&error.to_string()), "use one version everywhere"))
    }

    /// As they are given on the command line, complete: they read back to the same picture.
    #[must_use]
    pub fn arguments(&self) -> Vec<String> {
        [self.picture(), self.structure.arguments()].concat()
    }

    /// Those on which the picture's bytes depend: all but the structure.
    pub(crate) fn picture(&self) -> Vec<String> {
        let mut terms = self.terms.clone();
        terms.sort();
        terms.dedup();
        let name = |term: &Term| term.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned());
        let terms: Vec<String> = terms.iter().map(name).collect();
        let mut arguments = Vec::new();
        let mut push = |option: &str, value: String| arguments.extend([option.to_owned(), value]);
        push("--size", self.size.to_string());
        push("--bounces", self.bounces.to_string());
        push("--samples", self.samples.to_string());
        push("--terms", terms.join(","));
        if let Some(camera) = self.camera {
            push("--camera", camera.to_string());
        }
        if let Some(up) = self.up.and_then(|up| up.to_possible_value()) {
            push("--up", up.get_name().to_owned());
        }
        for (flag, set) in [("--smooth", self.smooth), ("--no-ground", self.no_ground)] {
            arguments.extend(set.then(|| flag.to_owned()));
        }
        arguments
    }

    /// Pixels in a row, and rows.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.size.width, self.size.height)
    }

    /// How many times as wide as high.
    pub(crate) fn aspect(&self) -> f32 {
        self.size.width as f32 / self.size.height as f32
    }

    pub(crate) fn terms(&self) -> Terms {
        let has = |term| self.terms.contains(&Term::All) || self.terms.contains(&term);
        Terms {
            ambient: has(Term::Ambient),
            diffuse: has(Term::Diffuse),
            specular: has(Term::Specular),
            shadows: has(Term::Shadows),
            reflections: has(Term::Reflections),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_read_back() {
        for text in [
            "",
            "--size 31x7 --samples 2 -b 0 -s kdtree -p fast --smooth --no-ground",
            "--camera -1,2.5,1e-7/0,0,0/33.3 --up z --terms shadows,diffuse,diffuse",
            "-s auto",
        ] {
            let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
            let settings = Settings::parse(&words).unwrap();
            let arguments = settings.arguments();
            assert_eq!(Settings::parse(&arguments).unwrap().arguments(), arguments, "{text}");
            assert_eq!(settings.terms(), Settings::parse(&arguments).unwrap().terms());
        }
        let error = Settings::parse(&["--glow".to_owned()]).unwrap_err().to_string();
        assert!(error.contains("--glow") && !error.contains('\n'), "{error}");
    }

    #[test]
    fn the_structure_does_not_make_another_picture() {
        let of = |text: &str| Settings::parse(&text.split(' ').map(str::to_owned).collect::<Vec<_>>()).unwrap();
        assert_eq!(of("-s list").picture(), of("-s bvh").picture());
        assert_ne!(of("--bounces 1").picture(), of("--bounces 2").picture());
    }
}
