use std::{
    iter,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use hitscan::{
    Primitives, parallel,
    primitives::{Smooth, Spheres},
    render::{Camera, Caster, Materials, Renderer, Terms},
};

use super::{Threads, line, print};
use crate::{
    failure::{self, Failure},
    output::{self, write_atomically},
    picture::{preview, write_png},
    progress::Progress,
    scene::{Built, Palette, Source, StructureArgs, View, builtin::BuiltIn, normals_by_place},
    stage::{CameraArg, Counted, DEPTHS, Grounded, Lighting, Tally, Up, Viewpoint, glazed, plate},
    units::{Size, count, seconds},
};

/// Draw a mesh, an asset or, without either, the built-in scene
///
/// Prints triangles, the structure's bytes and build time, the rays by kind and depth, their rate, and the share of time
/// spent in queries. That share is an estimate: reading the clock around every query would distort it, so each thread times
/// one in 61 of its own; where other programs compete for the processor, it is rough.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: hitscan render\n          \
                        hitscan render bunny.obj.gz -o bunny.png --size 1280x960 --camera 0,0.2,0.4/0,0.1,0")]
pub struct Render {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz) or baked asset; none for the built-in scene
    #[arg(value_name = "MODEL|ASSET")]
    model: Option<PathBuf>,
    /// PNG to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "picture.png")]
    output: PathBuf,
    /// Pixels of the picture
    #[arg(long, value_name = "WxH", default_value = "960x640")]
    size: Size,
    #[command(flatten)]
    structure: StructureArgs,
    /// The most mirror images within mirror images
    #[arg(short, long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(0..DEPTHS as i64))]
    bounces: u32,
    /// Rays per pixel along each side: 3 makes 9
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=16))]
    samples: u32,
    #[command(flatten)]
    threads: Threads,
    /// Where to look from and at, and the vertical angle of view; found by itself if not given
    #[arg(short, long, value_name = "EYE/TARGET[/DEGREES]", allow_hyphen_values = true)]
    camera: Option<CameraArg>,
    /// The axis that points up; guessed from the shape if not given
    #[arg(long, value_name = "AXIS")]
    up: Option<Up>,
    /// The terms of light to compute, separated by commas
    #[arg(long, value_name = "TERMS", value_delimiter = ',', default_values = ["all"])]
    terms: Vec<Term>,
    /// Shade the triangles of a mesh or an asset as if they were curved, but for sharp edges; an asset with normals is so anyway
    #[arg(long)]
    smooth: bool,
    /// No plate below a mesh or an asset
    #[arg(long)]
    no_ground: bool,
    /// Draw the picture in the terminal, too
    #[arg(long)]
    preview: bool,
}

/// A term of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
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

/// What a picture shows, and how.
struct Shot<'a> {
    scene: &'a (dyn Caster + Sync),
    camera: Camera,
    lighting: &'a Lighting,
    materials: Materials<'a>,
}

/// A picture and how it came about.
struct Picture {
    pixels: Vec<[u8; 3]>,
    tally: Tally,
    seconds: f64,
}

impl Render {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        output::check(&self.output)?;
        let begun = Instant::now();
        let (mut text, picture) = match &self.model {
            Some(path) => self.file(path)?,
            None => self.built_in()?,
        };
        let writing = Progress::spinner("writing the picture …");
        let Size { width, height } = self.size;
        write_png(&self.output, width, height, &picture.pixels)?;
        drop(writing);
        self.describe(&mut text, &picture, begun.elapsed().as_secs_f64());
        if self.output == Path::new("-") {
            failure::note(&text);
            return Ok(ExitCode::SUCCESS);
        }
        if self.preview {
            let columns = console::Term::stdout().size_checked().map_or(80, |(_, columns)| u32::from(columns));
            let shown = preview(width, height, &picture.pixels, columns);
            write_atomically(Path::new("-"), |out| out.write_all(shown.as_bytes()))?;
        }
        print(&text)?;
        Ok(ExitCode::SUCCESS)
    }

    /// The picture of a mesh file or an asset.
    fn file(&self, path: &Path) -> Result<(String, Picture), Failure> {
        let source = Source::load(path)?;
        let view = source.view(path)?;
        let built = view.build(self.structure.structure, self.structure.preset)?;
        let normals = if self.smooth { normals_by_place(&view.mesh) } else { Vec::new() };
        let shaded = match view.normals {
            Some(normals) if !self.smooth => Smooth::packed(view.mesh, normals),
            _ => Smooth::new(view.mesh, &normals),
        };
        let renumbered = view.renumbered(shaded)?;
        let scene = match &renumbered {
            Some(triangles) => built.scene(triangles)?,
            None => built.scene(&shaded)?,
        };
        let primitives = view.mesh.len();

        let bounds = scene.bounds();
        let up = self.up.unwrap_or_else(|| if view.y_up { Up::Y } else { Up::guess(&bounds) });
        let points = view.mesh.vertices().iter().copied().filter(|point| bounds.contains(*point));
        let viewpoint = Viewpoint::new(self.camera, &bounds, up, self.aspect(), points);
        let lighting = Lighting::studio(&bounds, &viewpoint);
        let palette = dress(&view);
        let grounded = Grounded::new(&*scene, up as usize, primitives)?;
        let shot = Shot {
            scene: if self.no_ground { &*scene } else { &grounded },
            camera: viewpoint.camera,
            lighting: &lighting,
            materials: palette.as_materials(),
        };
        let what = format!("{}: {} triangles", path.display(), count(primitives));
        Ok((summary(&what, &built, primitives), self.draw(&shot)?))
    }

    /// The picture of the built-in scene.
    fn built_in(&self) -> Result<(String, Picture), Failure> {
        let builtin = BuiltIn::new();
        let internal = |error: &dyn std::fmt::Display| Failure::new(error, "report this as a bug");
        let mesh = Smooth::new(builtin.geometry.mesh()?, &builtin.normals);
        let spheres = Spheres::new(&builtin.spheres).map_err(|error| internal(&error))?;
        let primitives = (mesh, spheres);
        let structure = self.structure.structure.unwrap_or_default();
        let built = Built::new(&primitives, structure, self.structure.preset)?;
        let scene = built.scene(&primitives)?;

        let camera = self.camera.unwrap_or(BuiltIn::CAMERA);
        let up = self.up.unwrap_or(Up::Y);
        let viewpoint = Viewpoint::new(Some(camera), &scene.bounds(), up, self.aspect(), iter::empty());
        let lighting = BuiltIn::lighting();
        let materials = builtin.palette.as_materials();
        let shot = Shot { scene: &*scene, camera: viewpoint.camera, lighting: &lighting, materials };
        let (triangles, spheres) = (builtin.geometry.len(), builtin.spheres.len());
        let what = format!("built-in scene: {} triangles, {spheres} spheres", count(triangles));
        Ok((summary(&what, &built, primitives.len()), self.draw(&shot)?))
    }

    fn aspect(&self) -> f32 {
        self.size.width as f32 / self.size.height as f32
    }

    fn terms(&self) -> Terms {
        let has = |term| self.terms.contains(&Term::All) || self.terms.contains(&term);
        Terms {
            ambient: has(Term::Ambient),
            diffuse: has(Term::Diffuse),
            specular: has(Term::Specular),
            shadows: has(Term::Shadows),
            reflections: has(Term::Reflections),
        }
    }

    fn draw(&self, shot: &Shot<'_>) -> Result<Picture, Failure> {
        let Size { width, height } = self.size;
        let pool = self.threads.pool()?;
        let counted = Counted::new(shot.scene, self.threads.count());
        let [below, above] = shot.lighting.background;
        let renderer = Renderer::new(&counted, shot.camera, width, height)
            .with_lights(&shot.lighting.lights)
            .with_ambient(shot.lighting.ambient)
            .with_background(below, above)
            .with_materials(shot.materials)
            .with_terms(self.terms())
            .with_bounces(self.bounces)
            .with_samples(self.samples);
        let mut pixels = vec![[0; 3]; width as usize * height as usize];
        let progress = Progress::bar("drawing", height.into());
        pool.install(|| parallel::render_with(&renderer, &mut pixels, |tile| progress.advance(tile.height.into())))
            .map_err(|error| Failure::new(error, "report this as a bug"))?;
        let seconds = progress.finish();
        Ok(Picture { pixels, tally: counted.tally(), seconds })
    }

    /// Adds what the picture took.
    fn describe(&self, text: &mut String, picture: &Picture, total: f64) {
        let Picture { tally, seconds: drawing, .. } = picture;
        let samples = self.samples * self.samples;
        line(text, "picture", format!("{}, {} x {samples} samples", self.output.display(), self.size));
        for depth in 0..DEPTHS {
            let (closest, shadow) = (tally.closest[depth], tally.shadow[depth]);
            if closest > 0 {
                let (what, closest, shadow) =
                    (if depth == 0 { "primary" } else { "reflected" }, count(closest), count(shadow));
                line(text, &format!("rays at depth {depth}"), format!("{closest:>12} {what:<9} {shadow:>12} shadow"));
            }
        }
        let threads = self.threads.count();
        let rate = tally.rays() as f64 / drawing * 1.0e-6;
        line(text, "rays in all", format!("{:>12} in {}, {rate:.2} million/s", count(tally.rays()), seconds(*drawing)));
        let share = (tally.seconds / (drawing * threads as f64)).min(1.0) * 100.0;
        let plural = if threads == 1 { "thread" } else { "threads" };
        line(text, "time in queries", format!("about {share:.0} % on {threads} {plural} (sampled)"));
        line(text, "total", seconds(total));
    }
}

/// What is shown, under which structure.
fn summary(what: &str, built: &Built, primitives: u32) -> String {
    let mut text = format!("{what}\n");
    line(&mut text, "structure", built.describe(primitives as usize));
    text
}

/// The materials of all triangles, and that of the plate below them.
fn dress(view: &View<'_>) -> Palette {
    let mut palette = Palette::default();
    for index in 0..view.mesh.len() {
        palette.push(view.materials.map_or_else(glazed, |materials| materials.of(index)), 1);
    }
    palette.push(plate(), 1);
    palette
}
