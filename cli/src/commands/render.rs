use std::{
    ops::Range,
    path::{Path, PathBuf},
    process::ExitCode,
    time::{Duration, Instant},
};

use super::{Threads, line, print};
use crate::{
    failure::{self, Failure},
    output::{self, write_atomically},
    picture::{preview, write_png},
    progress::Progress,
    scene::Source,
    shot::{Identity, Part, Settings, Shot, Tiles, rows, with_shot},
    stage::{DEPTHS, Tally},
    units::{count, seconds, things},
};

/// Draw a mesh, an asset, a world or, without any, the built-in scene
///
/// Prints triangles, the structure's bytes and build time, the rays by kind and depth, their rate, and the share of time
/// spent in queries. That share is an estimate: reading the clock around every query would distort it, so each thread times
/// one in 61 of its own; where other programs compete for the processor, it is rough.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: hitscan render\n          \
                        hitscan render bunny.obj.gz -o bunny.png --size 1280x960 --camera 0,0.2,0.4/0,0.1,0")]
pub struct Render {
    /// Mesh (.obj, .stl, .ply, .gltf, .glb, each also with .gz), baked asset or world (.toml); none for the built-in scene
    #[arg(value_name = "MODEL|ASSET|WORLD")]
    model: Option<PathBuf>,
    /// PNG to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "picture.png")]
    output: PathBuf,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    threads: Threads,
    /// Draw only these of N tiles, A..B from A to before B or a single one, as a part for `hitscan merge`; a part that
    /// stands in the file already is continued
    #[arg(long, value_name = "A..B", requires = "of", conflicts_with = "preview")]
    tiles: Option<Tiles>,
    /// How many tiles the picture is divided into, from top to bottom
    #[arg(long, value_name = "N", requires = "tiles", value_parser = clap::value_parser!(u32).range(1..))]
    of: Option<u32>,
    /// Draw the picture in the terminal, too
    #[arg(long)]
    preview: bool,
}

/// A picture and how it came about.
struct Picture {
    pixels: Vec<[u8; 3]>,
    tally: Tally,
    seconds: f64,
}

impl Render {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        /// The most pixels along a side of a texture.
        const TEXTURES: u16 = 2048;
        output::check(&self.output)?;
        output::spare("-o", &self.output, self.model.as_deref())?;
        let begun = Instant::now();
        let load = |path| Source::load_with(path, Some(TEXTURES)).map(|source| (source, path));
        let source = self.model.as_deref().map(load).transpose()?;
        let source = source.as_ref().map(|(source, path)| (source, *path));
        let (width, height) = self.settings.size();
        let (mut text, picture) = match self.tiles.zip(self.of) {
            Some((tiles, of)) => self.part(source, tiles, of)?,
            None => {
                let drawn = with_shot(source, &self.settings, |shot, text| Ok((text, self.draw(shot, 0..height)?)))?;
                let writing = Progress::spinner("writing the picture …");
                write_png(&self.output, width, height, &drawn.1.pixels)?;
                drop(writing);
                drawn
            }
        };
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

    /// The part that is there already; what else is there is not this command's to replace.
    fn standing(&self) -> Result<Option<Part>, Failure> {
        if self.output == Path::new("-") || !self.output.is_file() {
            return Ok(None);
        }
        let strange = |_| {
            let what = format!("{}: stands there and is no part of a picture", self.output.display());
            Failure::new(what, "give another -o, or remove it")
        };
        Part::read(&self.output).map(Some).map_err(strange)
    }

    /// Draws some tiles, continues if the file holds the first of them, and keeps it up to date on the way.
    fn part(&self, source: Option<(&Source, &Path)>, tiles: Tiles, of: u32) -> Result<(String, Picture), Failure> {
        /// How much work may be lost.
        const BETWEEN_SAVES: Duration = Duration::from_secs(10);
        let (width, height) = self.settings.size();
        if of > height {
            let what = format!("--of {of}: the picture has {height} rows");
            return Err(Failure::new(what, "divide it into at most as many tiles"));
        }
        if tiles.end > of {
            let what = format!("--tiles {tiles} --of {of}: there are tiles 0 to {}", of - 1);
            return Err(Failure::new(what, "ask for some of these"));
        }
        let identity = Identity::new(source.map(|(source, _)| source), &self.settings)?;
        let standing = self.standing()?.filter(|part| part.begins(&identity, (width, height), tiles, of));
        let empty = Tiles { end: tiles.start, ..tiles };
        let mut part = standing.unwrap_or(Part { identity, width, height, tiles: empty, of, pixels: Vec::new() });
        with_shot(source, &self.settings, |shot, text| {
            let mut all = Picture { pixels: Vec::new(), tally: Tally::default(), seconds: 0.0 };
            let mut saved = Instant::now();
            while part.tiles.end < tiles.end {
                let picture = self.draw(shot, rows(height, part.tiles.end, of))?;
                part.pixels.extend(picture.pixels);
                part.tiles.end += 1;
                all.tally.add(&picture.tally);
                all.seconds += picture.seconds;
                if part.tiles.end == tiles.end || saved.elapsed() > BETWEEN_SAVES && self.output != Path::new("-") {
                    part.write(&self.output)?;
                    saved = Instant::now();
                }
            }
            Ok((text, all))
        })
    }

    fn draw(&self, shot: &Shot<'_>, rows: Range<u32>) -> Result<Picture, Failure> {
        let pool = self.threads.pool()?;
        let progress = Progress::bar("drawing", rows.len() as u64);
        let (pixels, tally) = shot.counted(self.threads.count(), |shot| {
            pool.install(|| shot.rows_with(rows, |rows| progress.advance(rows.into())))
        });
        Ok(Picture { pixels: pixels?, tally, seconds: progress.finish() })
    }

    /// Adds what the picture took.
    fn describe(&self, text: &mut String, picture: &Picture, total: f64) {
        let Picture { tally, seconds: drawing, .. } = picture;
        let samples = things(self.settings.samples * self.settings.samples, "sample", "samples");
        let of = self.tiles.zip(self.of).map_or(String::new(), |(tiles, of)| format!(", tiles {tiles} of {of}"));
        let size = self.settings.size;
        line(text, "picture", format!("{}, {size} x {samples}{of}", self.output.display()));
        for depth in 0..DEPTHS {
            let (closest, shadow) = (tally.closest[depth], tally.shadow[depth]);
            if closest > 0 {
                let (what, closest, shadow) =
                    (if depth == 0 { "primary" } else { "reflected" }, count(closest), count(shadow));
                line(text, &format!("rays at depth {depth}"), format!("{closest:>12} {what:<9} {shadow:>12} shadow"));
            }
        }
        let threads = self.threads.count();
        let rate = tally.rays() as f64 / drawing.max(1.0e-9) * 1.0e-6;
        line(text, "rays in all", format!("{:>12} in {}, {rate:.2} million/s", count(tally.rays()), seconds(*drawing)));
        let share = (tally.seconds / (drawing * threads as f64).max(1.0e-9)).min(1.0) * 100.0;
        let plural = if threads == 1 { "thread" } else { "threads" };
        line(text, "time in queries", format!("about {share:.0} % on {threads} {plural} (sampled)"));
        line(text, "total", seconds(total));
    }
}
