//! The command line: see `--help` and README.md.

use std::process::ExitCode;

use clap::Parser;
use hitscan_gpu::commands::Command;

/// Rays and pictures on a GPU, from the words of a baked asset
#[derive(Debug, Parser)]
#[command(name = "hitscan-gpu", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

fn main() -> ExitCode {
    match Cli::parse().command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("hitscan-gpu: {error:#}");
            ExitCode::from(2)
        }
    }
}
