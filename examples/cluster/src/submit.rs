use std::{
    collections::BTreeSet,
    env,
    io::{self, IsTerminal, Write},
    path::{Path, PathBuf},
    process::Stdio,
    time::{Duration, Instant},
};

use async_nats::jetstream::consumer::PullConsumer;
use futures_util::{StreamExt, stream};
use hitscan_cli::{Casting, Failure, Settings, Source, version, write_atomically, write_png};
use tokio::{
    process::{Child, Command},
    time::sleep,
};

use crate::{
    assets,
    board::{Board, tile_of, tile_subject},
    connection::Connection,
    files,
    job::{Job, Work},
    refused,
    server::Serve,
};

/// How long to wait after something failed, and how often to look whether a job can be done at all.
const PAUSE: Duration = Duration::from_millis(300);
const LOOK: Duration = Duration::from_secs(1);

/// Draw a picture of an asset with all workers there are
///
/// The bytes are those of `hitscan render` with the same settings. To give a job again continues it: what is done stays
/// done. Without --server, a server and workers on this machine are started for as long as it takes.
#[derive(Debug, clap::Args)]
pub struct Submit {
    /// Asset, made by `hitscan bake`
    asset: PathBuf,
    /// PNG to write
    #[arg(short, long, value_name = "FILE", default_value = "picture.png")]
    output: PathBuf,
    #[command(flatten)]
    settings: Settings,
    /// PNG to write every two seconds while the picture grows
    #[arg(long, value_name = "FILE")]
    growing: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

/// Cast the rays of a file at an asset with all workers there are
///
/// The bytes are those of `hitscan cast` with the same settings.
#[derive(Debug, clap::Args)]
pub struct Cast {
    /// Asset, made by `hitscan bake`
    asset: PathBuf,
    /// Rays, as `hitscan cast` takes them
    rays: PathBuf,
    /// Hits to write
    #[arg(short, long, value_name = "HITS")]
    output: PathBuf,
    #[command(flatten)]
    casting: Casting,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, clap::Args)]
struct Common {
    #[command(flatten)]
    connection: Connection,
    /// Workers to start on this machine for this job: a single one works on all cores, several on one thread each
    /// [default: 1 if a server is started, else none]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=1024))]
    workers: Option<u16>,
    /// Only enter the job, do not wait for it; give it again to fetch the result
    #[arg(long)]
    detach: bool,
    /// Folder of the server that is started without --server [default: in the user's cache]
    #[arg(long, value_name = "FOLDER")]
    store: Option<PathBuf>,
    /// Tiles to divide the work into [default: by its size]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    tiles: Option<u32>,
}

impl Submit {
    pub async fn run(&self) -> Result<(), Failure> {
        let (width, height) = self.settings.size();
        let work = Work::Picture { settings: self.settings.arguments(), width, height };
        let mut shown = Instant::now();
        let pixels = |bytes: &[u8]| bytes.as_chunks().0.to_vec();
        let grow = |bytes: &[u8]| {
            if let Some(path) = self.growing.as_ref().filter(|_| shown.elapsed() > Duration::from_secs(2)) {
                write_png(path, width, height, &pixels(bytes))?;
                shown = Instant::now();
            }
            Ok(())
        };
        let Some(bytes) = self.common.run(&self.asset, work, None, height, grow).await? else { return Ok(()) };
        Ok(write_png(&self.output, width, height, &pixels(&bytes))?)
    }
}

impl Cast {
    pub async fn run(&self) -> Result<(), Failure> {
        let rays = files::read(&self.rays)?;
        let size = self.casting.ray_bytes();
        if !rays.len().is_multiple_of(size) {
            let what = format!("{}: {} bytes are not whole rays of {size}", self.rays.display(), rays.len());
            return Err(Failure::new(what, "see `hitscan cast --help`"));
        }
        let count = (rays.len() / size) as u64;
        let work = Work::Hits { casting: self.casting.arguments(), rays: files::hash(&rays), count };
        let most = u32::try_from(count).unwrap_or(u32::MAX).max(1);
        let Some(bytes) = self.common.run(&self.asset, work, Some(&rays), most, |_| Ok(())).await? else {
            return Ok(());
        };
        Ok(write_atomically(&self.output, |file| file.write_all(&bytes))?)
    }
}

impl Common {
    /// Has a job done: its bytes, unless nobody waits for them.
    async fn run(
        &self,
        asset: &Path,
        work: Work,
        rays: Option<&[u8]>,
        most: u32,
        mut grow: impl FnMut(&[u8]) -> Result<(), Failure>,
    ) -> Result<Option<Vec<u8>>, Failure> {
        let begun = Instant::now();
        if !matches!(Source::load(asset)?, Source::Asset { .. }) || asset.extension().is_some_and(|e| e == "toml") {
            let what = format!("{}: is no asset", asset.display());
            return Err(Failure::new(what, "make one of it with `hitscan bake`"));
        }
        let tiles = self.tiles.unwrap_or_else(|| work.tiles()).min(most).max(work.tiles().min(most));
        let job = Job { version: version(), asset: files::hash(&files::read(asset)?), work, tiles };
        let id = job.id();

        let embedded = Serve::embedded(self.store.clone());
        let alone = self.connection.server.is_none() && !embedded.is_up();
        if alone && self.detach {
            return Err(Failure::new("--detach: there is no server", "start one with `hitscan-cluster serve`"));
        }
        let _server = if alone { Some(embedded.start().await?) } else { None };
        let board = Board::open(self.connection.open().await?).await?;
        assets::upload(&board.assets, &files::read(asset)?).await?;
        if let Some(rays) = rays {
            assets::upload(&board.assets, rays).await?;
        }
        board.enter(&id, &job).await?;
        enqueue(&board, &id, &job).await?;
        println!("job {id}: {}, {} tiles", job.describe(), job.tiles);
        if self.detach {
            return Ok(None);
        }
        let workers = (0..self.workers.unwrap_or(u16::from(alone))).map(|_| self.hire());
        let _workers: Vec<Child> = workers.collect::<Result<_, _>>()?;
        let bytes = collect(&board, &id, &job, &mut grow).await?;
        board.finish(&id, &job).await?;
        println!("job {id}: done in {:.2} s", begun.elapsed().as_secs_f64());
        Ok(Some(bytes))
    }

    /// Starts a worker on this machine, which ends with the handle.
    fn hire(&self) -> Result<Child, Failure> {
        let failed = |error: io::Error| Failure::new(format!("no worker: {error}"), "start one by hand");
        let mut command = Command::new(env::current_exe().map_err(failed)?);
        command.arg("worker").args(self.connection.arguments()).stdin(Stdio::null()).kill_on_drop(true);
        if self.workers.is_some_and(|workers| workers > 1) {
            command.args(["--threads", "1"]);
        }
        command.spawn().map_err(failed)
    }
}

/// Puts the tiles into the queue that are neither done nor waiting there.
async fn enqueue(board: &Board, id: &str, job: &Job) -> Result<(), Failure> {
    let done: BTreeSet<u32> = board.done(id).await?.into_iter().collect();
    let missing = (0..job.tiles).filter(|tile| !done.contains(tile));
    let stored = missing.map(|tile| board.store_once(tile_subject(&job.version, id, tile), Vec::new()));
    let mut stored = stream::iter(stored).buffered(64);
    while let Some(stored) = stored.next().await {
        stored?;
    }
    Ok(())
}

/// Puts the results together as they come, each once.
async fn collect(
    board: &Board,
    id: &str,
    job: &Job,
    grow: &mut impl FnMut(&[u8]) -> Result<(), Failure>,
) -> Result<Vec<u8>, Failure> {
    let mut whole = vec![0; job.bytes(job.tiles - 1).end];
    let mut missing: BTreeSet<u32> = (0..job.tiles).collect();
    let mut results: Option<PullConsumer> = None;
    let mut looked = Instant::now();
    while !missing.is_empty() {
        if looked.elapsed() > LOOK {
            looked = Instant::now();
            if let Ok(Some(why)) = board.failure(id).await {
                return Err(Failure::new(format!("job {id}: {why}"), "mend that and give the job again"));
            }
            tell(job.tiles as usize - missing.len(), job.tiles, board).await;
        }
        let Some(consumer) = &results else {
            // A server that comes back has forgotten who listened: everything is delivered again, and known already.
            match board.collector(id).await {
                Ok(consumer) => results = Some(consumer),
                Err(_) => sleep(PAUSE).await,
            }
            continue;
        };
        let batch = consumer.batch().max_messages(64).expires(PAUSE).messages().await;
        let Ok(mut batch) = batch else {
            results = None;
            sleep(PAUSE).await;
            continue;
        };
        loop {
            match tokio::time::timeout(LOOK, batch.next()).await {
                Ok(None) => break,
                Ok(Some(Ok(message))) => {
                    let Some((_, tile)) = tile_of(&message.subject) else { continue };
                    let place = whole.get_mut(job.bytes(tile)).filter(|place| place.len() == message.payload.len());
                    let Some(place) = place.filter(|_| tile < job.tiles) else {
                        return Err(refused("a result", "has not the size of its tile"));
                    };
                    if missing.remove(&tile) {
                        place.copy_from_slice(&message.payload);
                    }
                }
                Ok(Some(Err(_))) | Err(_) => {
                    results = None;
                    break;
                }
            }
            if missing.is_empty() {
                break;
            }
        }
        grow(&whole)?;
    }
    tell(job.tiles as usize, job.tiles, board).await;
    if io::stderr().is_terminal() {
        eprintln!();
    }
    Ok(whole)
}

/// Shows how far it is, to people.
async fn tell(done: usize, of: u32, board: &Board) {
    if io::stderr().is_terminal() {
        let workers = board.workers().await.map_or(0, |workers| workers.len());
        eprint!("\r{done} of {of} tiles, {workers} workers  ");
        let _ = io::stderr().flush();
    }
}
