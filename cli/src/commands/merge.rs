use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use super::print;
use crate::{
    failure::{self, Failure},
    output,
    picture::write_png,
    shot::{self, Part},
    units::things,
};

/// Put the parts of a picture together
///
/// Takes what `hitscan render --tiles` wrote, in any order, and writes the picture that `hitscan render` would have drawn
/// alone, to the byte. Parts of different scenes, settings or versions and gaps between them are refused.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitscan render bunny.hits --tiles 0..5 --of 10 -o a.png\n         \
                        hitscan render bunny.hits --tiles 5..10 --of 10 -o b.png\n         \
                        hitscan merge a.png b.png -o bunny.png")]
pub struct Merge {
    /// Parts of one picture
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,
    /// PNG to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "picture.png")]
    output: PathBuf,
}

impl Merge {
    pub fn run(&self) -> Result<ExitCode, Failure> {
        output::check(&self.output)?;
        output::spare("-o", &self.output, self.parts.iter().map(PathBuf::as_path))?;
        let read = |path: &PathBuf| Ok((path.display().to_string(), Part::read(path)?));
        let parts: Vec<_> = self.parts.iter().map(read).collect::<Result<_, Failure>>()?;
        let whole = shot::merge(parts)?;
        write_png(&self.output, whole.width, whole.height, &whole.pixels)?;
        let text = format!(
            "{}: {}x{} from {}, {}\n",
            self.output.display(),
            whole.width,
            whole.height,
            things(self.parts.len(), "part", "parts"),
            things(whole.of, "tile", "tiles")
        );
        if self.output == Path::new("-") {
            failure::note(&text);
        } else {
            print(&text)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
