//! `hitscan-cluster`: one picture, or one file of rays, worked on by many machines.
//!
//! A job is an asset's hash and the settings of `hitscan render` or `hitscan cast`; a tile of it is a pure function of
//! these and its number. So tiles may be done twice, by anybody, in any order: the bytes are the same, and they are those
//! of the program that does it all alone.

mod assets;
mod board;
mod connection;
mod craft;
mod files;
mod job;
mod server;
mod status;
mod submit;
mod worker;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use hitscan_cli::Failure;

/// Pictures and hits by many machines, through NATS JetStream
#[derive(Debug, Parser)]
#[command(name = "hitscan-cluster", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Submit(submit::Submit),
    Cast(submit::Cast),
    Worker(worker::Worker),
    Status(status::Status),
    Serve(server::Serve),
}

#[tokio::main]
async fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Submit(submit) => submit.run().await,
        Command::Cast(cast) => cast.run().await,
        Command::Worker(worker) => worker.run().await,
        Command::Status(status) => status.run().await,
        Command::Serve(serve) => serve.run().await,
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("hitscan-cluster: {failure}");
            ExitCode::from(2)
        }
    }
}

/// A failure of the network or the server, by what was to be done.
fn refused(what: &str, error: impl std::fmt::Display) -> Failure {
    let error = error.to_string().replace('\n', " ");
    Failure::new(format!("{what}: {error}"), "see whether the server runs, and whether it lets you in")
}
