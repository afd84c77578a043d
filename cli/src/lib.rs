//! `hitscan` on the command line: renders, bakes, inspects meshes, casts rays at them and compares structures over them.
//!
//! Every failure is one line on standard error, `hitscan: WHAT: HOW TO MEND IT`, and exit code 2. Outputs appear whole or
//! not at all.
//!
//! The program is [`main`]. The rest of what is public is for programs that share its work among machines: they draw with
//! the same [`Settings`] and cast with the same [`Casting`], and so make the same bytes.

mod casting;
mod chip;
mod commands;
mod compare;
mod difference;
mod failure;
mod hits;
mod input;
mod interrupt;
mod model;
mod output;
mod picture;
mod progress;
mod rays;
mod scene;
mod shot;
mod stage;
mod trial;
mod units;
mod version;
mod world;

pub use casting::Casting;
pub use failure::Failure;
pub use output::write_atomically;
pub use picture::write_png;
pub use scene::Source;
pub use shot::{Settings, Shot, Tiles, rows};
pub use version::version;
pub use world::bake as bake_world;

use std::{
    env,
    io::{self, Write},
    process::ExitCode,
};

use clap::{Parser, error::ErrorKind};

use commands::Command;

/// Exact ray queries on meshes: pictures, assets for firmware, hits
#[derive(Debug, Parser)]
#[command(name = "hitscan", version, after_help = "`hitscan render` alone draws a built-in scene into picture.png.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The program.
#[must_use]
pub fn main() -> ExitCode {
    interrupt::listen();
    match Cli::try_parse() {
        Ok(cli) => cli.command.run().unwrap_or_else(|failure| failure.report()),
        Err(error) => refuse(&error),
    }
}

/// Prints what clap found: help as it is, an error in one line.
fn refuse(error: &clap::Error) -> ExitCode {
    let text = error.render().to_string();
    if !error.use_stderr() {
        // A reader that has seen enough (`| head`) is no error.
        let _ = io::stdout().write_all(text.as_bytes());
        return ExitCode::SUCCESS;
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        let _ = io::stderr().write_all(text.as_bytes());
    } else {
        let _ = writeln!(io::stderr(), "hitscan: {}: see `{} --help`", one_line(&text), command_so_far());
    }
    ExitCode::from(2)
}

/// The words of an error of clap's, without the tips and the usage that follow them.
fn one_line(text: &str) -> String {
    let complaint = text.lines().take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let complaint = complaint.filter(|line| !line.trim_start().starts_with("tip:"));
    let words: Vec<&str> = complaint.flat_map(str::split_whitespace).skip_while(|word| *word == "error:").collect();
    words.join(" ")
}

/// `hitscan` and its subcommand, if the arguments begin with one.
fn command_so_far() -> String {
    match env::args().nth(1) {
        Some(name) if Command::NAMES.contains(&name.as_str()) => format!("hitscan {name}"),
        _ => "hitscan".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
        let command = Cli::command();
        let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        assert_eq!(names, Command::NAMES);
    }

    #[test]
    fn errors_of_the_command_line_are_one_line() {
        for bad in [&["hitscan", "cast"][..], &["hitscan", "paint"], &["hitscan", "render", "--size", "0x0"]] {
            let text = one_line(&Cli::try_parse_from(bad).unwrap_err().to_string());
            assert!(!text.contains('\n') && !text.contains("Usage") && !text.starts_with("error"), "{text}");
        }
    }
}
