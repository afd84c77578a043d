use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use hitscan::{Mesh, Ray};

use super::print;
use crate::{
    compare::{self, Contest, Report, Row, SIZES, medians, plot_bytes, plot_growth, rays_at, write_csv},
    failure::Failure,
    output,
    rays::read_rays,
    scene::{Preset, Source, builtin::BuiltIn},
    stage::CameraArg,
    trial::Rays,
    units::{count, parse_count, things},
};

/// Compare all structures over the same triangles
///
/// Prints, for each structure, the time to build it, its bytes, the nodes visited and triangles tested per bounce ray,
/// million rays per second on one thread, and the speed-up over the list, which tests every triangle. All answers are
/// compared bit for bit; exit code 1 if any differ. The last line recommends a structure by counts and bytes, not by the
/// clock: the one that `--structure auto` takes.
///
/// The structures take turns, and medians are shown. Slow ones, such as the list, answer only some of the rays.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: hitscan compare bunny.obj.gz --csv bunny.csv --plot bunny.svg\n          \
                        hitscan compare --growth=250k --plot growth.svg")]
pub struct Compare {
    /// Meshes (.obj, .stl, .ply, .gltf, .glb, each also with .gz) or baked assets; none for the built-in scene's triangles
    #[arg(value_name = "MODEL|ASSET", conflicts_with = "growth")]
    models: Vec<PathBuf>,
    /// Rays to count and time in place of the bounce rays, as `hitscan cast` reads them; - for standard input
    #[arg(short, long, value_name = "FILE", conflicts_with = "growth")]
    rays: Option<PathBuf>,
    /// The rays of --rays are eight f32: t_min and t_max follow the direction
    #[arg(short, long, requires = "rays")]
    interval: bool,
    /// Where the rays come from and what they look at, and the vertical angle of view; all is seen if not given
    #[arg(long, value_name = "EYE/TARGET[/DEGREES]", allow_hyphen_values = true, conflicts_with = "growth")]
    camera: Option<CameraArg>,
    /// What the structures are tuned for
    #[arg(short, long, value_name = "PRESET", default_value = "balanced")]
    preset: Preset,
    /// Rays from the camera; about as many others as of these hit
    #[arg(short = 'n', long, value_name = "N", default_value = "40k", value_parser = parse_count)]
    count: u32,
    /// How often each structure casts its rays
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..=99))]
    rounds: u8,
    /// Compare over terrains of 1 k to so many triangles instead, 4M at most
    #[arg(long, value_name = "MOST", num_args = 0..=1, require_equals = true, default_missing_value = "1M",
          value_parser = parse_count)]
    growth: Option<u32>,
    /// Write the figures as comma-separated values, too
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw them, too: bytes against speed, or growth; an SVG
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

impl Compare {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        let outputs = [("--csv", &self.csv), ("--plot", &self.plot)];
        for (option, path) in outputs.into_iter().filter_map(|(option, path)| Some((option, path.as_ref()?))) {
            output::check(path)?;
            output::spare(option, path, self.models.iter().chain(&self.rays).map(PathBuf::as_path))?;
        }
        let reports = match self.growth {
            Some(most) => self.growth(most)?,
            None => self.models()?,
        };
        if let Some(path) = &self.csv {
            write_csv(path, &reports)?;
        }
        if let Some(path) = &self.plot {
            match medians(&reports) {
                Some(_) if self.growth.is_some() => plot_growth(path, &reports)?,
                Some(_) if reports.len() == 1 => plot_bytes(path, &reports[0])?,
                Some(medians) => plot_bytes(path, &medians)?,
                None => {}
            }
        }
        Ok(ExitCode::SUCCESS)
    }

    /// The tables of all models, each printed when it is done, and that of their medians.
    fn models(&self) -> Result<Vec<Report>, Failure> {
        let given = match &self.rays {
            None => None,
            Some(path) => Some(self.given_rays(path)?),
        };
        let mut reports = Vec::new();
        if self.models.is_empty() {
            let builtin = BuiltIn::new();
            reports.push(self.model("built-in", &builtin.geometry.mesh()?, given.as_deref())?);
        }
        for (place, path) in self.models.iter().enumerate() {
            if place > 0 {
                print("\n")?;
            }
            let source = Source::load(path)?;
            let view = source.view(path)?;
            reports.push(self.model(&path.display().to_string(), &view.mesh, given.as_deref())?);
        }
        if reports.len() > 1 {
            let medians =
                medians(&reports).map_or(String::new(), |medians| format!("\n{}\n{}", medians.model, medians.render()));
            print(&medians)?;
        }
        Ok(reports)
    }

    /// Measures and prints one model.
    fn model(&self, name: &str, mesh: &Mesh<'_>, given: Option<&[Ray]>) -> Result<Report, Failure> {
        let (mut rays, mut trial) = rays_at(mesh, self.camera, self.count as usize)?;
        if let Some(given) = given {
            rays.bounce = given.to_vec();
            trial.bounce = given.to_vec();
        }
        let contest = Contest { rays: &rays, trial: &trial.bounce, rounds: self.rounds.into(), preset: self.preset };
        let entries = contest.run(*mesh, &Row::all()).map_err(|failure| failure.about(name))?;
        let triangles = hitscan::Primitives::len(mesh);
        let report = Report { model: name.to_owned(), triangles, preset: self.preset, entries };
        print(&format!("{}\n{}", self.head(name, triangles, &rays), report.render()))?;
        Ok(report)
    }

    /// What a table is about.
    fn head(&self, name: &str, triangles: u32, rays: &Rays) -> String {
        let [primary, bounce, shadow] = [&rays.primary, &rays.bounce, &rays.shadow].map(|rays| count(rays.len()));
        let (triangles, preset) = (things(triangles, "triangle", "triangles"), self.preset.name());
        let what = if self.rays.is_some() { "given" } else { "bounce" };
        format!("{name}: {triangles}, preset {preset}; {primary} primary, {bounce} {what}, {shadow} shadow rays")
    }

    fn given_rays(&self, path: &Path) -> Result<Vec<Ray>, Failure> {
        let records = read_rays(path, self.interval)?;
        if records.is_empty() {
            return Err(Failure::new(format!("{}: holds no rays", path.display()), "name a file with some"));
        }
        Ok(records.iter().map(Ray::from).collect())
    }

    /// The tables of growing terrains.
    fn growth(&self, most: u32) -> Result<Vec<Report>, Failure> {
        if most > SIZES[SIZES.len() - 1] {
            return Err(Failure::new(
                format!("--growth={most}: the largest terrain has 4,000,000 triangles"),
                "ask for fewer",
            ));
        }
        let sizes: Vec<u32> = SIZES.into_iter().filter(|size| *size <= most).collect();
        if sizes.is_empty() {
            return Err(Failure::new(
                format!("--growth={most}: the smallest terrain has 1,000 triangles"),
                "ask for more",
            ));
        }
        let reports = compare::growth(&sizes, self.preset, self.count as usize, self.rounds.into())?;
        print(&format!("terrains, preset {}\n{}", self.preset.name(), compare::describe(&reports)))?;
        Ok(reports)
    }
}
