use std::{
    fs,
    path::PathBuf,
    sync::{
        Arc,
        mpsc::{self, Receiver, Sender},
    },
    thread,
    time::Duration,
};

use hitscan_cli::{Casting, Failure, Settings, Source};
use tokio::sync::oneshot;

use crate::job::{Job, Work};

/// A tile that somebody waits for.
pub struct Order {
    pub id: String,
    pub job: Arc<Job>,
    /// The asset's file.
    pub asset: PathBuf,
    /// The rays' file, if the job is about rays.
    pub rays: Option<PathBuf>,
    pub tile: u32,
    pub reply: oneshot::Sender<Result<Vec<u8>, String>>,
}

/// A thread that takes orders one after another, each on all threads of a pool; the scene stays open between tiles of one
/// job. It ends when nobody can order any more.
pub fn start(threads: usize, pause: Duration) -> Result<Sender<Order>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::new(format!("no threads: {error}"), "ask for fewer");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| failed(&error))?;
    let (sender, orders) = mpsc::channel();
    let work = move || {
        pool.install(move || {
            let mut next = orders.recv().ok();
            while let Some(order) = next {
                next = serve(order, &orders, pause);
            }
        });
    };
    thread::Builder::new().name("craft".to_owned()).spawn(work).map_err(|error| failed(&error))?;
    Ok(sender)
}

/// Serves an order and all that follow for the same job; the first one for another job.
fn serve(order: Order, orders: &Receiver<Order>, pause: Duration) -> Option<Order> {
    let (job, asset, rays) = (order.job.clone(), order.asset.clone(), order.rays.clone());
    let mut waiting = Some(order);
    let mut work = |tile: &dyn Fn(u32) -> Result<Vec<u8>, Failure>| {
        let id = waiting.as_ref().map(|order| order.id.clone());
        while let Some(order) = waiting.take_if(|order| Some(&order.id) == id.as_ref()) {
            thread::sleep(pause);
            let bytes = tile(order.tile).map_err(|failure| failure.to_string());
            // Whoever ordered may be gone.
            let _ = order.reply.send(bytes);
            waiting = orders.recv().ok();
        }
        Ok(())
    };
    let opened = Source::load(&asset).and_then(|source| match &job.work {
        Work::Picture { settings, .. } => Settings::parse(settings)?.shoot(&source, &asset, |shot| {
            work(&|tile| {
                let share = job.share(tile);
                Ok(shot.rows(share.start as u32..share.end as u32)?.into_flattened())
            })
        }),
        Work::Hits { casting, .. } => {
            let casting = Casting::parse(casting)?;
            let path = rays.unwrap_or_default();
            let bytes = fs::read(&path)
                .map_err(|error| Failure::new(format!("{}: {error}", path.display()), "look at the --cache"))?;
            casting.open(&source, &asset, |cast| {
                work(&|tile| {
                    let share = job.share(tile);
                    let at = |ray: u64| ray as usize * casting.ray_bytes();
                    Ok(cast(bytes.get(at(share.start)..at(share.end)).unwrap_or_default()))
                })
            })
        }
    });
    match opened {
        Ok(()) => waiting,
        Err(failure) => {
            if let Some(order) = waiting {
                let _ = order.reply.send(Err(failure.to_string()));
            }
            orders.recv().ok()
        }
    }
}
