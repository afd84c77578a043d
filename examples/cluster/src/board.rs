use std::{collections::BTreeMap, time::Duration};

use async_nats::{
    Client,
    jetstream::{
        self, Context,
        consumer::{AckPolicy, PullConsumer, pull},
        context::PublishErrorKind,
        kv,
        message::PublishMessage,
        object_store::{self, ObjectStore},
        stream::{self, DiscardPolicy, RetentionPolicy, StorageType, Stream},
    },
};
use futures_util::{StreamExt, TryStreamExt};
use hitscan_cli::Failure;
use serde::{Deserialize, Serialize};

use crate::{job::Job, refused};

/// How long what nobody fetched is kept.
const KEPT: Duration = Duration::from_hours(24 * 7);

/// How long a worker is thought to live without a word of it.
const ALIVE: Duration = Duration::from_secs(10);

/// All that the machines share: jobs, a queue of their tiles, results, assets, and who works.
#[derive(Clone)]
pub struct Board {
    pub context: Context,
    /// Tiles that are to be done: taken out when they are.
    pub tiles: Stream,
    /// The bytes of tiles that are done, one message each.
    pub results: Stream,
    /// Jobs that are not finished, by name, and why some cannot be.
    jobs: kv::Store,
    workers: kv::Store,
    /// Assets and rays by their hash.
    pub assets: ObjectStore,
}

/// A worker, as it tells of itself.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Presence {
    pub version: String,
    pub threads: usize,
    pub tiles: u64,
}

impl Board {
    /// Finds all that, or sets it up.
    pub async fn open(client: Client) -> Result<Self, Failure> {
        let context = jetstream::new(client);
        let failed = |error: &dyn std::fmt::Display| refused("the server's store", error);
        let queue = |name: &str, subjects: &str, retention| stream::Config {
            name: name.to_owned(),
            subjects: vec![subjects.to_owned()],
            retention,
            max_age: KEPT,
            ..Default::default()
        };
        let tiles = queue("hitscan-tiles", "hitscan.tile.>", RetentionPolicy::WorkQueue);
        let tiles = context.get_or_create_stream(tiles).await.map_err(|error| failed(&error))?;
        let results = queue("hitscan-results", "hitscan.result.>", RetentionPolicy::Limits);
        let results = context.get_or_create_stream(results).await.map_err(|error| failed(&error))?;
        // By hand, because `create_key_value` wants to know more of the account than servers before 2.10 tell.
        let bucket = async |name: &str, max_age, storage| {
            let config = stream::Config {
                name: format!("KV_{name}"),
                subjects: vec![format!("$KV.{name}.>")],
                max_messages_per_subject: 1,
                max_age,
                storage,
                allow_rollup: true,
                deny_delete: true,
                allow_direct: true,
                discard: DiscardPolicy::New,
                ..Default::default()
            };
            context.get_or_create_stream(config).await.map_err(|error| failed(&error))?;
            context.get_key_value(name).await.map_err(|error| failed(&error))
        };
        let jobs = bucket("hitscan-jobs", KEPT, StorageType::File).await?;
        let workers = bucket("hitscan-workers", ALIVE, StorageType::Memory).await?;
        let config = object_store::Config { bucket: "hitscan-assets".to_owned(), max_age: KEPT, ..Default::default() };
        let assets = context.create_object_store(config).await.map_err(|error| failed(&error))?;
        Ok(Self { context, tiles, results, jobs, workers, assets })
    }

    /// Enters a job, which has not failed then.
    pub async fn enter(&self, id: &str, job: &Job) -> Result<(), Failure> {
        let text = serde_json::to_vec(job).unwrap_or_default();
        self.jobs.purge(format!("failed.{id}")).await.map_err(|error| refused("the job", error))?;
        self.jobs.put(format!("job.{id}"), text.into()).await.map_err(|error| refused("the job", error))?;
        Ok(())
    }

    /// A job that is not finished.
    pub async fn job(&self, id: &str) -> Result<Option<Job>, Failure> {
        let text = self.jobs.get(format!("job.{id}")).await.map_err(|error| refused("the job", error))?;
        Ok(text.and_then(|text| serde_json::from_slice(&text).ok()))
    }

    /// All jobs that are not finished.
    pub async fn jobs(&self) -> Result<BTreeMap<String, Job>, Failure> {
        let mut jobs = BTreeMap::new();
        for id in keys(&self.jobs).await?.iter().filter_map(|key| key.strip_prefix("job.")) {
            if let Some(job) = self.job(id).await? {
                jobs.insert(id.to_owned(), job);
            }
        }
        Ok(jobs)
    }

    /// Notes that a job cannot be done, and why.
    pub async fn fail(&self, id: &str, why: &str) -> Result<(), Failure> {
        let noted = self.jobs.put(format!("failed.{id}"), why.to_owned().into()).await;
        noted.map(|_| ()).map_err(|error| refused("the job", error))
    }

    /// Why a job cannot be done, if so.
    pub async fn failure(&self, id: &str) -> Result<Option<String>, Failure> {
        let text = self.jobs.get(format!("failed.{id}")).await.map_err(|error| refused("the job", error))?;
        Ok(text.map(|text| String::from_utf8_lossy(&text).into_owned()))
    }

    /// Forgets a job and all that is left of it.
    pub async fn finish(&self, id: &str, job: &Job) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| refused("tidying up", error);
        self.jobs.purge(format!("job.{id}")).await.map_err(|error| failed(&error))?;
        let tiles = tile_subject(&job.version, id, "*");
        self.tiles.purge().filter(tiles).await.map_err(|error| failed(&error))?;
        self.results.purge().filter(result_subject(id, "*")).await.map_err(|error| failed(&error))?;
        Ok(())
    }

    /// The tiles of a job whose results are there.
    pub async fn done(&self, id: &str) -> Result<Vec<u32>, Failure> {
        numbers(&self.results, &result_subject(id, "*")).await
    }

    /// The tiles of a job that wait in the queue or are in work.
    pub async fn waiting(&self, id: &str, job: &Job) -> Result<Vec<u32>, Failure> {
        numbers(&self.tiles, &tile_subject(&job.version, id, "*")).await
    }

    /// What hands out the tiles that a version can do; those not acknowledged in time go to somebody else.
    pub async fn queue(&self, version: &str, ack_wait: Duration) -> Result<PullConsumer, Failure> {
        let config = pull::Config {
            durable_name: Some(format!("workers-{}", token(version))),
            filter_subject: tile_subject(version, "*", "*"),
            ack_policy: AckPolicy::Explicit,
            ack_wait,
            max_ack_pending: 10_000,
            ..Default::default()
        };
        self.tiles.create_consumer(config).await.map_err(|error| refused("the queue", error))
    }

    /// What delivers all results of a job, those of the past first.
    pub async fn collector(&self, id: &str) -> Result<PullConsumer, Failure> {
        let config = pull::Config {
            filter_subject: result_subject(id, "*"),
            ack_policy: AckPolicy::None,
            inactive_threshold: Duration::from_secs(60),
            ..Default::default()
        };
        self.results.create_consumer(config).await.map_err(|error| refused("the results", error))
    }

    /// Stores a message unless there is one of this subject; whether it was stored now.
    pub async fn store_once(&self, subject: String, payload: Vec<u8>) -> Result<bool, Failure> {
        let message = PublishMessage::build().payload(payload.into()).expected_last_subject_sequence(0);
        let stored = match self.context.send_publish(subject, message).await {
            Ok(stored) => stored.await,
            Err(error) => Err(error),
        };
        match stored {
            Ok(_) => Ok(true),
            Err(error) if error.kind() == PublishErrorKind::WrongLastSequence => Ok(false),
            Err(error) => Err(refused("storing a message", error)),
        }
    }

    /// Says that a worker is there.
    pub async fn greet(&self, name: &str, presence: &Presence) -> Result<(), Failure> {
        let text = serde_json::to_vec(presence).unwrap_or_default();
        let said = self.workers.put(name, text.into()).await;
        said.map(|_| ()).map_err(|error| refused("the list of workers", error))
    }

    /// Who said so lately.
    pub async fn workers(&self) -> Result<BTreeMap<String, Presence>, Failure> {
        let mut workers = BTreeMap::new();
        for name in keys(&self.workers).await? {
            let text = self.workers.get(&name).await.map_err(|error| refused("the list of workers", error))?;
            if let Some(presence) = text.and_then(|text| serde_json::from_slice(&text).ok()) {
                workers.insert(name, presence);
            }
        }
        Ok(workers)
    }

    /// Takes a worker off the list.
    pub async fn leave(&self, name: &str) {
        let _ = self.workers.purge(name).await;
    }
}

async fn keys(store: &kv::Store) -> Result<Vec<String>, Failure> {
    let failed = |error: &dyn std::fmt::Display| refused("the server's store", error);
    let keys = store.keys().await.map_err(|error| failed(&error))?;
    keys.try_collect().await.map_err(|error| failed(&error))
}

/// The last parts of the subjects in a stream, which are numbers.
async fn numbers(stream: &Stream, filter: &str) -> Result<Vec<u32>, Failure> {
    let failed = |error: &dyn std::fmt::Display| refused("the state of the queue", error);
    let mut subjects = stream.info_with_subjects(filter).await.map_err(|error| failed(&error))?;
    let mut numbers = Vec::new();
    while let Some(subject) = subjects.next().await {
        let (subject, _) = subject.map_err(|error| failed(&error))?;
        numbers.extend(tile_of(&subject).map(|(_, tile)| tile));
    }
    numbers.sort_unstable();
    Ok(numbers)
}

/// Text as a part of a subject.
fn token(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

/// The subject of a tile that is to be done; `*` stands for any job or tile.
pub fn tile_subject(version: &str, id: &str, tile: impl std::fmt::Display) -> String {
    format!("hitscan.tile.{}.{id}.{tile}", token(version))
}

/// The subject of a tile's result.
pub fn result_subject(id: &str, tile: impl std::fmt::Display) -> String {
    format!("hitscan.result.{id}.{tile}")
}

/// The job and the tile of a subject.
pub fn tile_of(subject: &str) -> Option<(&str, u32)> {
    let (rest, tile) = subject.rsplit_once('.')?;
    Some((rest.rsplit_once('.')?.1, tile.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subjects_name_job_and_tile() {
        let subject = tile_subject("0.1.0-abc", "f00", 7);
        assert_eq!(subject, "hitscan.tile.0_1_0-abc.f00.7");
        assert_eq!(tile_of(&subject), Some(("f00", 7)));
        assert_eq!(tile_of(&result_subject("f00", 8)), Some(("f00", 8)));
        assert_eq!(tile_of("hitscan.result.f00.x"), None);
    }
}
