use hitscan_cli::Failure;

use crate::{board::Board, connection::Connection};

/// Say which jobs are not finished, how far they are, and who works
#[derive(Debug, clap::Args)]
pub struct Status {
    #[command(flatten)]
    connection: Connection,
}

impl Status {
    pub async fn run(&self) -> Result<(), Failure> {
        let board = Board::open(self.connection.open().await?).await?;
        let jobs = board.jobs().await?;
        for (id, job) in &jobs {
            let (done, waiting) = (board.done(id).await?.len(), board.waiting(id, job).await?.len());
            let share = 100 * done / job.tiles as usize;
            let failure = board.failure(id).await?.map_or(String::new(), |why| format!(", cannot be done: {why}"));
            let (what, of, version) = (job.describe(), job.tiles, &job.version);
            println!("job {id}: {what}, {done} of {of} tiles ({share} %), {waiting} to do, version {version}{failure}");
        }
        if jobs.is_empty() {
            println!("no jobs");
        }
        for (name, presence) in board.workers().await? {
            let (threads, tiles, version) = (presence.threads, presence.tiles, presence.version);
            println!("worker {name}: {threads} threads, {tiles} tiles done, version {version}");
        }
        Ok(())
    }
}
