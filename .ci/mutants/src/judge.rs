//! Runs the tests against one mutant after the other.

use std::{
    collections::BTreeSet,
    error::Error,
    fs, io, mem,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

use crate::{
    Mutant,
    tree::{TRACE, Tree},
};

/// Tests that look at the sources, or break the walk themselves.
const LEFT_OUT: [&str; 2] = ["floors", "mutants"];

struct Test {
    name: String,
    executable: PathBuf,
    usual: Duration,
    reaches: BTreeSet<u32>,
}

pub struct Judge {
    folder: PathBuf,
    /// The quickest first.
    tests: Vec<Test>,
}

impl Judge {
    /// Builds the tests, and runs each once with all mutants asleep.
    pub fn new(tree: &Tree) -> Result<Self, Box<dyn Error>> {
        let output = tree.cargo("test").args(["--lib", "--tests", "--no-run"]).output()?;
        if !output.status.success() {
            return Err("the mutants do not build".into());
        }
        let mut judge = Self { folder: tree.folder.clone(), tests: vec![] };
        for line in String::from_utf8(output.stdout)?.lines() {
            let artifact: Value = serde_json::from_str(line)?;
            let (Some(name), Some(executable)) = (artifact["target"]["name"].as_str(), artifact["executable"].as_str())
            else {
                continue;
            };
            if LEFT_OUT.contains(&name) {
                continue;
            }
            let trace = tree.folder.join("trace");
            fs::write(&trace, "")?;
            let started = Instant::now();
            let status = judge.command(Path::new(executable), TRACE).env("MUTANT_TRACE", &trace).status()?;
            if !status.success() {
                return Err(format!("{name} fails without a mutant").into());
            }
            let reaches = fs::read_to_string(&trace)?.lines().filter_map(|line| line.parse().ok()).collect();
            let test = Test { name: name.into(), executable: executable.into(), usual: started.elapsed(), reaches };
            println!("{name}: {:.1} s, reaches {}", test.usual.as_secs_f64(), test.reaches.len());
            judge.tests.push(test);
        }
        judge.tests.sort_by_key(|test| test.usual);
        Ok(judge)
    }

    fn command(&self, executable: &Path, mutant: u32) -> Command {
        let mut command = Command::new(executable);
        command.current_dir(&self.folder).env("MUTANT", mutant.to_string()).env("RUST_BACKTRACE", "0");
        command.env("CARGO_MANIFEST_DIR", &self.folder).stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// Tries all mutants with the quickest test, those that are left with the next, and tells each verdict: `caught by TEST`,
    /// `hangs TEST`, `missed`, or `unreached`.
    pub fn judge(&self, mutants: &[Mutant], mut tell: impl FnMut(&Mutant, &str) -> io::Result<()>) -> io::Result<()> {
        let mut left: Vec<&Mutant> = mutants.iter().collect();
        for test in &self.tests {
            println!("{}: {} left", test.name, left.len());
            for mutant in mem::take(&mut left) {
                let verdict = if test.reaches.contains(&mutant.number) { self.verdict(test, mutant)? } else { None };
                match verdict {
                    Some(verdict) => tell(mutant, &format!("{verdict} {}", test.name))?,
                    None => left.push(mutant),
                }
            }
        }
        left.into_iter().try_for_each(|mutant| {
            let reached = self.tests.iter().any(|test| test.reaches.contains(&mutant.number));
            tell(mutant, if reached { "missed" } else { "unreached" })
        })
    }

    fn verdict(&self, test: &Test, mutant: &Mutant) -> io::Result<Option<&'static str>> {
        let limit = test.usual * 5 + Duration::from_secs(20);
        let started = Instant::now();
        let mut child = self.command(&test.executable, mutant.number).spawn()?;
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok((!status.success()).then_some("caught by"));
            }
            if started.elapsed() > limit {
                child.kill()?;
                child.wait()?;
                return Ok(Some("hangs"));
            }
            thread::sleep(Duration::from_millis(5));
        }
    }
}
