use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, AtomicU32, Ordering},
};

/// How far a builder is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// References to primitives that have found their places.
    pub done: u32,
    /// How many there may be, in all hierarchies that are tried.
    pub total: u32,
}

/// Tells the caller of progress, and remembers whether to stop.
pub(super) struct Monitor<'f> {
    tell: &'f (dyn Fn(Progress) -> ControlFlow<()> + Sync),
    done: AtomicU32,
    total: u32,
    is_stopped: AtomicBool,
}

impl<'f> Monitor<'f> {
    /// Of `total` references.
    pub(super) fn new(total: u32, tell: &'f (dyn Fn(Progress) -> ControlFlow<()> + Sync)) -> Self {
        Self { tell, done: AtomicU32::new(0), total, is_stopped: AtomicBool::new(false) }
    }

    /// So many more are done.
    pub(super) fn advance(&self, by: u32) {
        let done = self.done.fetch_add(by, Ordering::Relaxed) + by;
        if (self.tell)(Progress { done, total: self.total }).is_break() {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the caller wants no hierarchy any more.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}
