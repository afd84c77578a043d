use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering::Relaxed},
        mpsc::Sender,
    },
    thread,
    time::{Duration, Instant},
};

use async_nats::jetstream::{self, AckKind};
use futures_util::StreamExt;
use hitscan_cli::{Failure, version};
use tokio::{sync::Mutex, sync::oneshot, time::sleep};

use crate::{
    assets::{self, Missing},
    board::{Board, Presence, result_subject, tile_of},
    connection::Connection,
    craft::{self, Order},
    files,
    job::{Job, Work},
};

/// Tiles that a worker has at a time: while one is in work, the other comes or its result goes.
const SLOTS: usize = 2;

/// How long to wait after something failed, and for a tile when there is none.
const PAUSE: Duration = Duration::from_millis(300);
const PATIENCE: Duration = Duration::from_secs(1);

/// Work on tiles until interrupted
///
/// Workers come and go as they like: a tile that one leaves behind goes to another when its acknowledgement is overdue.
#[derive(Clone, Debug, clap::Args)]
pub struct Worker {
    #[command(flatten)]
    pub connection: Connection,
    /// Threads to work on [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Folder for assets [default: in the user's cache]
    #[arg(long, value_name = "FOLDER")]
    pub cache: Option<PathBuf>,
    /// Seconds without a sign of life after which a tile is given to another worker
    #[arg(long, value_name = "SECONDS", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=3600))]
    pub ack_wait: u32,
    /// Leave when there has been nothing to do for so many seconds
    #[arg(long, value_name = "SECONDS")]
    pub leave_after: Option<u32>,
    /// Be of another version, for tests
    #[arg(long, hide = true)]
    pub pretend: Option<String>,
    /// Wait so many milliseconds before each tile, for tests
    #[arg(long, hide = true, default_value_t = 0)]
    pub pause: u64,
}

/// A worker at work.
struct Shop {
    board: Board,
    version: String,
    ack_wait: Duration,
    cache: PathBuf,
    orders: Sender<Order>,
    /// The last job, with the files that it needs.
    open: Mutex<Option<(String, Opened)>>,
    tiles: AtomicU64,
    leaving: AtomicBool,
}

type Opened = (Arc<Job>, PathBuf, Option<PathBuf>);

impl Worker {
    pub async fn run(&self) -> Result<(), Failure> {
        let version = self.pretend.clone().unwrap_or_else(version);
        let board = Board::open(self.connection.open().await?).await?;
        refuse_other_versions(&board, &version).await?;
        let threads = self.threads.map_or_else(|| thread::available_parallelism().map_or(1, |n| n.get()), usize::from);
        let shop = Arc::new(Shop {
            board,
            version,
            ack_wait: Duration::from_secs(self.ack_wait.into()),
            cache: self.cache.clone().unwrap_or_else(|| files::home().join("assets")),
            orders: craft::start(threads, Duration::from_millis(self.pause))?,
            open: Mutex::new(None),
            tiles: AtomicU64::new(0),
            leaving: AtomicBool::new(false),
        });
        let name = format!("{}-{}", host(), std::process::id());
        let mut slots = tokio::task::JoinSet::new();
        let leave_after = self.leave_after.map(|seconds| Duration::from_secs(seconds.into()));
        for _ in 0..SLOTS {
            slots.spawn(Arc::clone(&shop).work(leave_after));
        }
        let greetings = async {
            loop {
                let tiles = shop.tiles.load(Relaxed);
                // A server that is away hears of us when it is back.
                let _ = shop.board.greet(&name, &Presence { version: shop.version.clone(), threads, tiles }).await;
                sleep(PATIENCE).await;
            }
        };
        tokio::select! {
            () = interrupted() => shop.leaving.store(true, Relaxed),
            () = greetings => {}
            _ = slots.join_next() => {}
        }
        // What is in work is finished first.
        while slots.join_next().await.is_some() {}
        shop.board.leave(&name).await;
        Ok(())
    }
}

/// Refuses to wait for jobs that are all for another version.
async fn refuse_other_versions(board: &Board, version: &str) -> Result<(), Failure> {
    let jobs = board.jobs().await?;
    match jobs.values().next() {
        Some(job) if jobs.values().all(|job| job.version != version) => {
            let what = format!("this is version {version}, the jobs are for {}", job.version);
            Err(Failure::new(what, "use one build everywhere"))
        }
        _ => Ok(()),
    }
}

impl Shop {
    /// Fetches and does tiles one by one.
    async fn work(self: Arc<Self>, leave_after: Option<Duration>) {
        let mut queue = None;
        let mut last = Instant::now();
        while !self.leaving.load(Relaxed) && leave_after.is_none_or(|patience| last.elapsed() < patience) {
            let found = match &queue {
                Some(queue) => next(queue).await,
                None => match self.board.queue(&self.version, self.ack_wait).await {
                    Ok(found) => {
                        queue = Some(found);
                        continue;
                    }
                    Err(failure) => Err(failure.to_string()),
                },
            };
            match found {
                Ok(Some(message)) => {
                    self.tile(&message).await;
                    last = Instant::now();
                }
                Ok(None) => {}
                // The server is away, or came back without its consumers.
                Err(_) => {
                    queue = None;
                    sleep(PAUSE).await;
                }
            }
        }
    }

    /// Does a tile, stores its result, and only then says so.
    async fn tile(&self, message: &jetstream::Message) {
        let subject = message.subject.to_string();
        let Some((id, tile)) = tile_of(&subject) else {
            let _ = message.ack_with(AckKind::Term).await;
            return;
        };
        // Somebody may have stored the result and died before saying so, or been slow.
        let again = message.info().is_ok_and(|info| info.delivered > 1);
        if again && self.board.done(id).await.is_ok_and(|done| done.contains(&tile)) {
            let _ = message.double_ack().await;
            return;
        }
        let mut done = std::pin::pin!(self.done(id, tile));
        let outcome = loop {
            tokio::select! {
                outcome = &mut done => break outcome,
                () = sleep(self.ack_wait / 3) => { let _ = message.ack_with(AckKind::Progress).await; }
            }
        };
        let answer = match outcome {
            Ok(true) => AckKind::Ack,
            // Nobody waits for it any more, or nobody can do it.
            Ok(false) => AckKind::Term,
            Err(failure) => {
                eprintln!("hitscan-cluster: tile {tile} of {id}: {failure}");
                AckKind::Nak(Some(PATIENCE))
            }
        };
        // If the server does not hear it, it will ask again, and find the result.
        let _ = message.double_ack_with(answer).await;
    }

    /// Does a tile and stores its result; whether it is stored.
    async fn done(&self, id: &str, tile: u32) -> Result<bool, Failure> {
        let Some((job, asset, rays)) = self.open(id).await? else { return Ok(false) };
        if tile >= job.tiles {
            return Ok(false);
        }
        let (reply, answer) = oneshot::channel();
        let order = Order { id: id.to_owned(), job: Arc::clone(&job), asset, rays, tile, reply };
        let ended = || Failure::new("the thread that draws has ended", "report this as a bug");
        self.orders.send(order).map_err(|_| ended())?;
        let bytes = match answer.await.map_err(|_| ended())? {
            Ok(bytes) => bytes,
            Err(why) => {
                self.board.fail(id, &why).await?;
                return Ok(false);
            }
        };
        // The server may be away for a while; what was computed is not thrown away for that.
        let stored = loop {
            match self.board.store_once(result_subject(id, tile), bytes.clone()).await {
                Ok(stored) => break stored,
                Err(failure) => eprintln!("hitscan-cluster: tile {tile} of {id}: {failure}"),
            }
            sleep(PAUSE).await;
        };
        self.tiles.fetch_add(stored.into(), Relaxed);
        Ok(true)
    }

    /// A job and its files, fetched once; none if it is finished or cannot be done.
    async fn open(&self, id: &str) -> Result<Option<Opened>, Failure> {
        let mut open = self.open.lock().await;
        if let Some((name, opened)) = &*open
            && name == id
        {
            return Ok(Some(opened.clone()));
        }
        let Some(job) = self.board.job(id).await? else { return Ok(None) };
        if job.version != self.version {
            return Ok(None);
        }
        let file =
            async |name: &str, ending| match assets::download(&self.board.assets, name, &self.cache, ending).await {
                Ok(path) => Ok(Some(path)),
                Err(Missing::Unreachable(failure)) => Err(failure),
                Err(Missing::Corrupt(why)) => {
                    eprintln!("hitscan-cluster: {id}: {why}");
                    self.board.fail(id, &why).await.map(|()| None)
                }
            };
        let Some(asset) = file(&job.asset, "hits").await? else { return Ok(None) };
        let rays = match &job.work {
            Work::Hits { rays, .. } => match file(rays, "rays").await? {
                Some(path) => Some(path),
                None => return Ok(None),
            },
            Work::Picture { .. } => None,
        };
        let opened = (Arc::new(job), asset, rays);
        *open = Some((id.to_owned(), opened.clone()));
        Ok(Some(opened))
    }
}

/// The next tile, if one comes soon.
async fn next(queue: &jetstream::consumer::PullConsumer) -> Result<Option<jetstream::Message>, String> {
    let batch = queue.batch().max_messages(1).expires(PATIENCE).messages().await;
    let mut batch = batch.map_err(|error| error.to_string())?;
    // A server that went away answers nothing at all.
    match tokio::time::timeout(PATIENCE * 2, batch.next()).await {
        Ok(Some(Ok(message))) => Ok(Some(message)),
        Ok(Some(Err(error))) => Err(error.to_string()),
        Ok(None) => Ok(None),
        Err(_) => Err("no answer".to_owned()),
    }
}

/// This machine's name, as far as it can be a part of a key.
fn host() -> String {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_else(|_| "worker".to_owned());
    name.trim().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
}

/// Waits for Ctrl-C, or what schedulers send.
async fn interrupted() {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut terminated) = signal(SignalKind::terminate()) {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = terminated.recv() => {}
            }
            return;
        }
    }
    let _ = tokio::signal::ctrl_c().await;
}
