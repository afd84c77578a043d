//! [`Progress`]: a bar or a spinner for what takes longer than a moment.

use std::{
    sync::mpsc::{self, RecvTimeoutError, Sender},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// What is done sooner than this shows no bar: it would only flicker.
const PATIENCE: Duration = Duration::from_millis(700);

/// How often the bar is drawn.
const TICK: Duration = Duration::from_millis(100);

/// Work under way, drawn on standard error if that is a terminal and the work takes long enough; gone when dropped.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Work of unknown length.
    pub fn spinner(what: &str) -> Self {
        Self::new(ProgressBar::hidden(), "{spinner} {msg} {elapsed}", what)
    }

    /// Work of `steps` steps.
    pub fn bar(what: &str, steps: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        Self::new(bar, "{msg} [{wide_bar}] {percent}% {eta} left", what)
    }

    fn new(bar: ProgressBar, template: &str, what: &str) -> Self {
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("█▉▊▋▌▍▎▏ "));
        }
        bar.set_message(what.to_owned());
        // The work itself has no time to look at the clock, and spinners have no steps at which to.
        let (finished, waiting) = mpsc::channel();
        let shown = bar.clone();
        let watcher = thread::Builder::new().spawn(move || {
            if waiting.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(TICK);
                let _ = waiting.recv();
            }
        });
        Self { bar, begun: Instant::now(), watcher: watcher.ok().map(|handle| (finished, handle)) }
    }

    /// Counts steps that are done; cheap, from any thread.
    pub fn advance(&self, steps: u64) {
        self.bar.inc(steps);
    }

    /// Ends it and tells how many seconds it took.
    pub fn finish(self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((finished, watcher)) = self.watcher.take() {
            drop(finished);
            let _ = watcher.join();
        }
        self.bar.finish_and_clear();
    }
}
