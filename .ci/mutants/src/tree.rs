//! A copy of the source tree that holds the mutants.

use std::{
    collections::{BTreeMap, BTreeSet, HashSet},
    error::Error,
    fs,
    ops::Range,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use serde_json::Value;

use crate::{
    Mutant,
    source::{Woven, weave},
};

/// What asks which mutant is awake. In constants, none is.
const MUTATION: &str = r#"
#[doc(hidden)]
pub mod mutation {
    use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
    use std::io::Write;

    const UNKNOWN: u32 = u32::MAX;
    const TRACE: u32 = u32::MAX - 1;
    static AWAKE: AtomicU32 = AtomicU32::new(UNKNOWN);
    static REACHED: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

    #[inline(always)]
    pub const fn is(mutant: u32) -> bool {
        core::intrinsics::const_eval_select((mutant,), never, now)
    }

    const fn never(_: u32) -> bool {
        false
    }

    #[inline(always)]
    fn now(mutant: u32) -> bool {
        let awake = AWAKE.load(Relaxed);
        awake == mutant || awake >= TRACE && first(mutant)
    }

    #[cold]
    fn first(mutant: u32) -> bool {
        if AWAKE.load(Relaxed) == UNKNOWN {
            let named = std::env::var("MUTANT").ok().and_then(|number| number.parse().ok());
            AWAKE.store(named.unwrap_or(0), Relaxed);
        }
        let awake = AWAKE.load(Relaxed);
        let reached = &REACHED[mutant as usize];
        if awake == TRACE && !reached.load(Relaxed) && !reached.swap(true, Relaxed) {
            let trace = std::env::var("MUTANT_TRACE").unwrap();
            let mut trace = std::fs::OpenOptions::new().append(true).create(true).open(trace).unwrap();
            trace.write_all(std::format!("{mutant}\n").as_bytes()).unwrap();
        }
        awake == mutant
    }
}
"#;

/// The number that has every mutant reached written down.
pub const TRACE: u32 = u32::MAX - 1;

/// Mutants that cannot be tried, and why.
type LeftOut = Vec<(Mutant, &'static str)>;

pub struct Tree {
    pub folder: PathBuf,
    pub target: PathBuf,
}

impl Tree {
    /// Copies what git knows, and what it would know.
    pub fn new(root: &Path, target: &Path) -> Result<Self, Box<dyn Error>> {
        let tree = Self { folder: target.join("tree"), target: target.join("build") };
        let files = Command::new("git").args(["ls-files", "-co", "--exclude-standard"]).current_dir(root).output()?;
        for file in String::from_utf8(files.stdout)?.lines() {
            if let Ok(bytes) = fs::read(root.join(file)) {
                // The library's sources are written with mutants in them.
                let original = if file.starts_with("src/") { "original/" } else { "" };
                tree.write(&format!("{original}{file}"), &bytes)?;
            }
        }
        Ok(tree)
    }

    /// Leaves alone what would not change, so that cargo sees that it hasn't.
    fn write(&self, file: &str, bytes: &[u8]) -> Result<(), std::io::Error> {
        let path = self.folder.join(file);
        if fs::read(&path).is_ok_and(|old| old == bytes) {
            return Ok(());
        }
        fs::create_dir_all(path.parent().unwrap_or(&path))?;
        fs::write(path, bytes)
    }

    pub fn cargo(&self, verb: &str) -> Command {
        let mut command = Command::new("cargo");
        command.args([verb, "-p", "hitscan", "--all-features", "--message-format", "json"]);
        command.current_dir(&self.folder).stderr(Stdio::inherit());
        command.env("CARGO_TARGET_DIR", &self.target);
        command.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "--cap-lints allow");
        command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "2").env("CARGO_PROFILE_DEV_DEBUG", "0");
        command.env("CARGO_PROFILE_DEV_DEBUG_ASSERTIONS", "false").env("CARGO_PROFILE_DEV_OVERFLOW_CHECKS", "false");
        command
    }

    /// Writes the sources with their mutants, without those that do not build or stand in constants. Returns both.
    pub fn weave(&self, mutants: &[Mutant]) -> Result<(Vec<Mutant>, LeftOut), Box<dyn Error>> {
        let mut mutants = mutants.to_vec();
        let mut left_out = vec![];
        let count = mutants.len() + 1;
        loop {
            let sources = self.write_sources(&mutants, count)?;
            let placed: HashSet<u32> = sources.values().flat_map(|woven| woven.placed.iter().copied()).collect();
            let culprits = self.culprits(&sources)?;
            mutants.retain(|mutant| {
                let why = match (placed.contains(&mutant.number), culprits.contains(&mutant.number)) {
                    (false, _) => "constant",
                    (true, true) => "unviable",
                    (true, false) => return true,
                };
                left_out.push((mutant.clone(), why));
                false
            });
            if culprits.is_empty() {
                return Ok((mutants, left_out));
            }
        }
    }

    fn write_sources(&self, mutants: &[Mutant], count: usize) -> Result<BTreeMap<String, Woven>, Box<dyn Error>> {
        let mut woven = BTreeMap::new();
        let original = self.folder.join("original");
        let mut folders = vec![original.join("src")];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder)? {
                let path = entry?.path();
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let file = path.strip_prefix(&original)?.to_str().ok_or("a name in Unicode")?.to_owned();
                let inside: Vec<_> = mutants.iter().filter(|mutant| mutant.file == file).collect();
                let source = fs::read_to_string(&path)?;
                let mut result = weave(&source, &inside)?;
                if file == "src/lib.rs" {
                    let gate = "#![no_std]\n#![feature(core_intrinsics, const_eval_select)]\n";
                    result.text =
                        result.text.replacen("#![no_std]\n", gate, 1) + &MUTATION.replace("COUNT", &count.to_string());
                }
                self.write(&file, result.text.as_bytes())?;
                woven.insert(file, result);
            }
        }
        Ok(woven)
    }

    /// The mutants that keep the library from building.
    fn culprits(&self, sources: &BTreeMap<String, Woven>) -> Result<BTreeSet<u32>, Box<dyn Error>> {
        let output = self.cargo("check").output()?;
        let mut culprits = BTreeSet::new();
        let mut errors = vec![];
        for line in String::from_utf8(output.stdout)?.lines() {
            let message: Value = serde_json::from_str(line)?;
            if message["message"]["level"] != "error" {
                continue;
            }
            let mut places: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
            for span in message["message"]["spans"].as_array().into_iter().flatten() {
                let place = |end: &str| span[end].as_u64().unwrap_or_default() as usize;
                let file = span["file_name"].as_str().unwrap_or_default();
                places.entry(file).or_default().push(place("byte_start")..place("byte_end"));
            }
            let found: Vec<_> = places
                .iter()
                .filter_map(|(file, places)| Some(sources.get(*file)?.culprits(places)))
                .flatten()
                .collect();
            if found.is_empty() {
                errors.push(message["message"]["rendered"].as_str().unwrap_or_default().to_owned());
            }
            culprits.extend(found);
        }
        if !output.status.success() && culprits.is_empty() {
            return Err(errors.concat().into());
        }
        Ok(culprits)
    }
}
