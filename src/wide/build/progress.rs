use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicU32, Ordering},
};

/// How far a builder is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is done of it.
    pub done: u32,
    /// All work: about one for each primitive and each time that it is looked at.
    pub total: u32,
}

/// Tells the caller of progress, and asks whether to go on.
pub(in crate::wide) struct Monitor<'f, B> {
    tell: &'f (dyn Fn(Progress) -> ControlFlow<B> + Sync),
    done: AtomicU32,
    total: AtomicU32,
}

impl<'f, B> Monitor<'f, B> {
    /// Nothing is done.
    pub(in crate::wide) const fn new(tell: &'f (dyn Fn(Progress) -> ControlFlow<B> + Sync)) -> Self {
        Self { tell, done: AtomicU32::new(0), total: AtomicU32::new(0) }
    }

    /// There is so much more to do.
    pub(in crate::wide) fn expect(&self, work: u32) {
        self.total.fetch_add(work, Ordering::Relaxed);
    }

    /// So much more is done; whether to go on.
    pub(in crate::wide) fn advance(&self, by: u32) -> ControlFlow<B> {
        let done = self.done.fetch_add(by, Ordering::Relaxed) + by;
        (self.tell)(Progress { done, total: self.total.load(Ordering::Relaxed) })
    }
}
