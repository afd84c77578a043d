//! What the program does: [`Command`].

mod bench;
mod cast;
mod render;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use hitscan::asset::Asset;

use crate::{Device, Parts, Uploaded, World};

/// A subcommand.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// List the GPUs that can be named with --adapter
    Adapters,
    /// Cast the rays of a file; hits are those of `hitscan cast`, bit for bit
    Cast(cast::Cast),
    /// Draw an asset
    Render(render::Render),
    /// Measure primary, bounce and shadow rays, and what bounds them
    Bench(bench::Bench),
}

impl Command {
    /// Runs it.
    ///
    /// # Errors
    ///
    /// What went wrong, and how to mend it.
    pub fn run(&self) -> Result<()> {
        match self {
            Self::Adapters => {
                Device::open(None)?;
                Device::list().iter().for_each(|name| println!("{name}"));
                Ok(())
            }
            Self::Cast(cast) => cast.run(),
            Self::Render(render) => render.run(),
            Self::Bench(bench) => bench.run(),
        }
    }
}

/// The GPU and the asset, of all subcommands.
#[derive(Debug, clap::Args)]
struct Source {
    /// Asset made by `hitscan bake`, with a kdtree, bvh or dual-split
    asset: PathBuf,
    /// A part of the name of the GPU to use; the likely fastest if not given
    #[arg(short, long, value_name = "NAME")]
    adapter: Option<String>,
    /// The most bytes per binding; what the GPU allows if not given
    #[arg(long, value_name = "BYTES")]
    binding: Option<u64>,
}

impl Source {
    /// Reads and checks the asset, uploads it, and hands all over.
    fn open<T>(&self, run: impl FnOnce(&Uploaded, &Asset<'_>, &World<'_, '_>) -> Result<T>) -> Result<T> {
        let words = read_words(&self.asset)?;
        let named = || self.asset.display().to_string();
        let asset = Asset::from_words(&words).with_context(named)?;
        let parts = Parts::read(&asset).with_context(named)?;
        let world = World::read(&asset, &parts).with_context(named)?;
        let device = Device::open(self.adapter.as_deref())?;
        let uploaded = Uploaded::new(&device, &asset, self.binding).with_context(named)?;
        eprintln!(
            "{}: {} bytes in {} binding{}",
            device.name(),
            words.len() * 4,
            uploaded.bindings(),
            if uploaded.bindings() == 1 { "" } else { "s" }
        );
        run(&uploaded, &asset, &world)
    }
}

/// The words of a file.
fn read_words(path: &Path) -> Result<Vec<u32>> {
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    ensure!(bytes.len().is_multiple_of(4), "{}: not a whole number of words: bake the asset again", path.display());
    Ok(bytes.as_chunks().0.iter().copied().map(u32::from_le_bytes).collect())
}
