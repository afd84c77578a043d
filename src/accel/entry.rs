use core::mem::swap;

use super::{Cell, Hierarchy, Inside};
use crate::geometry::{Aabb, Bundle};

/// A place where walks may begin: a part of a structure and a box around it.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The box.
    pub bounds: Aabb,
    /// What the structure knows the part by.
    pub node: u32,
    /// No ray of the bundle enters the box before this.
    pub enter: f32,
}

/// The parts of a structure that the rays of a [`Bundle`] can enter, the nearest first.
///
/// Reshetov, Soupikov and Hurley, *Multi-level ray tracing algorithm*, 2005, with some entries in the place of one.
#[derive(Clone, Debug, Default)]
pub struct Entries(heapless::Vec<Entry, MOST>);

/// How many entries there may be.
const MOST: usize = 4;

/// Levels that a search goes down at most: the rest is for the walks, and no search takes long.
const LEVELS: usize = 12;

impl Entries {
    /// One: everything, for rays of which nothing is known.
    #[must_use]
    pub fn everything(bounds: Aabb) -> Self {
        Entry { bounds, node: 0, enter: f32::NEG_INFINITY }.into()
    }

    /// Everything, or nothing if no ray meets its box.
    #[must_use]
    pub fn whole(bounds: Aabb, bundle: &Bundle) -> Self {
        match bundle.entry(&bounds) {
            Some(_) => Self::everything(bounds),
            None => Self::default(),
        }
    }

    /// At most `most` subtrees of a structure that together hold all that the rays can meet.
    ///
    /// Level by level: what no ray meets goes, what they meet takes its parent's place. Where there is no room for both
    /// children, their parent stays, so that nothing is ever left out.
    pub(crate) fn find<H: Hierarchy<Node = u32>>(structure: &H, bundle: &Bundle, most: usize) -> Self {
        let mut entries = Self::default();
        if let Some(Cell { bounds, node }) = structure.root()
            && let Some(enter) = bundle.entry(&bounds)
        {
            entries.insert(Entry { bounds, node, enter });
        }
        for _ in 0..LEVELS {
            let (mut below, mut left, mut changed) = (Self::default(), entries.0.len(), false);
            for entry in entries.iter() {
                left -= 1;
                let children = match structure.open(&Cell { bounds: entry.bounds, node: entry.node }) {
                    Inside::Cells(children) => children,
                    Inside::Leaf(_) => {
                        below.insert(*entry);
                        continue;
                    }
                };
                let enters = children.each_ref().map(|child| bundle.entry(&child.as_ref()?.bounds));
                let room = most.saturating_sub(below.0.len() + left);
                if enters.iter().flatten().count() > room {
                    below.insert(*entry);
                    continue;
                }
                changed = true;
                for (child, enter) in children.iter().zip(enters) {
                    if let (Some(Cell { bounds, node }), Some(enter)) = (child, enter) {
                        below.insert(Entry { bounds: *bounds, node: *node, enter });
                    }
                }
            }
            entries = below;
            if !changed {
                break;
            }
        }
        entries
    }

    /// Whether no ray of the bundle meets anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether walks begin as ever: they may as well be asked for by [`closest_hit`](crate::Scene::closest_hit), which over a grid
    /// takes two thirds of the instructions.
    #[must_use]
    pub fn is_everything(&self) -> bool {
        self.0.first().is_some_and(|entry| entry.enter == f32::NEG_INFINITY)
    }

    /// The entries, the nearest first.
    pub fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.0.iter()
    }

    /// Puts an entry in its place; there is room.
    fn insert(&mut self, mut entry: Entry) {
        for place in &mut self.0 {
            if entry.enter < place.enter {
                swap(place, &mut entry);
            }
        }
        let _ = self.0.push(entry);
    }
}

/// One.
impl From<Entry> for Entries {
    fn from(entry: Entry) -> Self {
        let mut entries = Self::default();
        entries.insert(entry);
        entries
    }
}
