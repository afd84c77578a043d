//! Ctrl-C and its like: the program ends with one line and leaves no half file behind.

use std::{
    fs,
    io::{self, Write},
    path::PathBuf,
    process,
    sync::{Mutex, PoisonError},
};

/// The code to exit with, as shells have it after Ctrl-C: 128 and the number of the signal.
const CODE: i32 = 130;

/// Files that are being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Does what an interruption may come before or after, but not into: files begin and end to be unfinished.
pub fn undisturbed<R>(work: impl FnOnce(&mut Vec<PathBuf>) -> R) -> R {
    work(&mut UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner))
}

/// From here on, an interrupted program says so. Where no handler can be set, or the signals were turned off before (`nohup`),
/// all stays as it is.
pub fn listen() {
    let _ = ctrlc::try_set_handler(|| {
        // Kept locked, so that no further file is begun or finished.
        let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        for path in unfinished.iter() {
            let _ = fs::remove_file(path);
        }
        // Kept as well, so that nothing is said after it.
        let mut errors = io::stderr().lock();
        let _ = errors.write_all(b"hitscan: interrupted: what was not finished is not written\n");
        process::exit(CODE);
    });
}
