//! Ctrl-C and its like: the program ends with one line and leaves no half file behind.

use std::{
    fs,
    path::{Path, PathBuf},
    process,
    sync::{Mutex, PoisonError},
};

use crate::failure::note;

/// The code to exit with, as shells have it: 128 and the number of the signal.
const CODE: i32 = 130;

/// Files that hardly live longer than it takes to write them; most of them are gone.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file that is to be removed if the program is interrupted.
pub fn forget_if_interrupted(path: &Path) {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
}

/// From here on, an interrupted program says so. Where no handler can be set, it ends as the system has it.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        // Kept locked, so that no further file is begun.
        let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        for path in unfinished.iter() {
            let _ = fs::remove_file(path);
        }
        note("hitscan: interrupted: what was begun is not written\n");
        process::exit(CODE);
    });
}
