//! The mutation score of the library: `.ci/long` runs it, or by hand, from anywhere,
//!
//!     cargo run --release --manifest-path .ci/mutants/Cargo.toml -- COUNT [SEED [FOLDER ...]]
//!
//! tries the next COUNT mutants, in the random order of the seed, of those that `cargo mutants --list` finds (in the folders of
//! `src` named, or in all), writes each verdict into `target/mutants/verdicts` and prints the score of all tried so far. Run
//! again, it goes on where it stopped.
//!
//! A build for each of ten thousand mutants would take weeks. Here hundreds are compiled together, each asleep until the
//! environment names it (Untch, Offutt and Harrold, "Mutation analysis using mutant schemata", 1993), so that a mutant costs no
//! more than the tests that reach it, up to the first that fails. Left out of the score are those that do not build, and those in
//! constants, which no test can wake.
//!
//! `HITSCAN_RAYS` and `PROPTEST_CASES` make tests shorter. `cargo mutants` must be installed.

mod judge;
mod source;
mod tree;

use std::{
    collections::{BTreeMap, HashMap},
    env,
    error::Error,
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::Value;

/// A change of the source that the tests ought to notice.
#[derive(Debug, Clone)]
pub struct Mutant {
    /// By which it is woken; from 1.
    pub number: u32,
    /// Place and change, in words.
    pub name: String,
    pub file: String,
    pub line: usize,
    pub column: usize,
    pub genre: String,
    pub replacement: String,
}

/// So many are compiled together: tests become no slower, and the build is shared by many.
const BATCH: usize = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let count: usize = arguments.first().ok_or("how many?")?.parse()?;
    let seed: u64 = arguments.get(1).map_or(Ok(0), |seed| seed.parse())?;
    let folders = arguments.get(2..).unwrap_or_default();

    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from).join("mutants");
    fs::create_dir_all(&target)?;
    let file = target.join("verdicts");
    let mut verdicts = read(&file);

    let mut mutants = list(&root)?;
    mutants.retain(|mutant| {
        folders.is_empty() || folders.iter().any(|folder| mutant.file.starts_with(&format!("src/{folder}")))
    });
    mutants.sort_by_key(|mutant| rank(&mutant.name, seed));
    let all = mutants.clone();
    mutants.retain(|mutant| !verdicts.contains_key(&mutant.name));
    mutants.truncate(count);

    let mut log = OpenOptions::new().create(true).append(true).open(&file)?;
    let mut record = |mutant: &Mutant, verdict: &str| -> io::Result<()> {
        println!("{}: {verdict}", mutant.name);
        writeln!(log, "{}\t{verdict}", mutant.name)?;
        verdicts.insert(mutant.name.clone(), verdict.into());
        Ok(())
    };
    let tree = tree::Tree::new(&root, &target)?;
    for batch in mutants.chunks_mut(BATCH) {
        batch.iter_mut().zip(1..).for_each(|(mutant, number)| mutant.number = number);
        let (viable, left_out) = tree.weave(batch)?;
        left_out.iter().try_for_each(|(mutant, why)| record(mutant, why))?;
        judge::Judge::new(&tree)?.judge(&viable, &mut record)?;
    }
    print(&all, &verdicts);
    Ok(())
}

fn read(verdicts: &Path) -> HashMap<String, String> {
    let text = fs::read_to_string(verdicts).unwrap_or_default();
    text.lines().filter_map(|line| line.split_once('\t')).map(|(name, verdict)| (name.into(), verdict.into())).collect()
}

/// FNV-1a: a random order that does not change when a mutant comes or goes.
fn rank(name: &str, seed: u64) -> u64 {
    let step = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let sum = seed.to_le_bytes().iter().chain(name.as_bytes()).fold(0xcbf2_9ce4_8422_2325, step);
    (sum ^ (sum >> 32)).wrapping_mul(0x9E37_79B9_7F4A_7C15)
}

fn list(root: &Path) -> Result<Vec<Mutant>, Box<dyn Error>> {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--list", "--json", "-p", "hitscan", "--all-features"]).current_dir(root);
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let listed: Value = serde_json::from_slice(&output.stdout)?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let place = |value: &Value| value.as_u64().unwrap_or_default() as usize;
    let mutant = |value: &Value| Mutant {
        number: 0,
        name: text(&value["name"]),
        file: text(&value["file"]),
        line: place(&value["span"]["start"]["line"]),
        column: place(&value["span"]["start"]["column"]),
        genre: text(&value["genre"]),
        replacement: text(&value["replacement"]),
    };
    Ok(listed.as_array().ok_or("no list")?.iter().map(mutant).collect())
}

/// The score of each module: what tests noticed among what builds.
fn print(mutants: &[Mutant], verdicts: &HashMap<String, String>) {
    let mut modules: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    for mutant in mutants {
        let module = mutant.file.trim_start_matches("src/").split(['/', '.']).next().unwrap_or_default();
        for name in [module, "~ all"] {
            let counts = modules.entry(name).or_default();
            counts[0] += 1;
            match verdicts.get(&mutant.name).map(String::as_str) {
                Some("unviable" | "constant") => counts[1] += 1,
                Some("missed" | "unreached") => counts[2] += 1,
                Some(_) => counts[3] += 1,
                None => {}
            }
        }
    }
    println!("{:16}{:>8}{:>10}{:>8}{:>8}{:>8}", "module", "mutants", "left out", "missed", "caught", "score");
    for (module, [listed, left_out, missed, caught]) in modules {
        let score = 100.0 * caught as f64 / (caught + missed).max(1) as f64;
        println!("{module:16}{listed:>8}{left_out:>10}{missed:>8}{caught:>8}{score:>7.1}%");
    }
}
