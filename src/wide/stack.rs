use super::{
    build::MAX_DEPTH,
    node::{Child, WIDTH},
};

/// The most children that wait while a ray walks: of each node on the way all but one, and the last one's.
pub(super) const ROOM: usize = (WIDTH - 1) * MAX_DEPTH as usize + WIDTH;

/// Children that wait.
// Aligned so that the walk's frame is, too: vectors that are put aside there then do not straddle lines of the cache.
#[derive(Debug)]
#[repr(align(64))]
pub(super) struct Stack(heapless::Vec<Waiting, ROOM>);

/// A child and where it is entered, in the upper half, so that nearer ones are less where `t` is not negative; blocks before nodes
/// among those in which the ray begins, because a hit nearby spares more than a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Waiting(u64);

impl Waiting {
    #[inline(always)]
    pub(super) fn new(enter: f32, child: u32) -> Self {
        Self(u64::from(enter.to_bits()) << 32 | u64::from(child ^ Child::LEAF))
    }

    #[inline(always)]
    pub(super) fn enter(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    pub(super) const fn child(self) -> Child {
        Child(self.0 as u32 ^ Child::LEAF)
    }
}

impl Stack {
    #[inline(always)]
    pub(super) const fn new() -> Self {
        Self(heapless::Vec::new())
    }

    /// There is room for what a tree can need.
    #[inline(always)]
    pub(super) fn push(&mut self, waiting: Waiting) {
        let _ = self.0.push(waiting);
    }

    /// Puts the nearer of the last two above the other.
    #[inline(always)]
    pub(super) fn order(&mut self) {
        if let [.., below, above] = &mut self.0[..] {
            (*below, *above) = ((*below).max(*above), (*below).min(*above));
        }
    }

    /// The last one that is not entered behind `limit`.
    #[inline(always)]
    pub(super) fn pop(&mut self, limit: f32) -> Option<Child> {
        loop {
            let waiting = self.0.pop()?;
            if !(waiting.enter() > limit) {
                return Some(waiting.child());
            }
        }
    }
}
