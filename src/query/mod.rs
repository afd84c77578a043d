//! What a query makes of the hits it is offered, and queries that go on later.

mod collector;
mod hits;
mod item_buffer;
mod lattice_items;
mod nearby;
mod overlaps;
mod paused;
mod recent;
mod wanted;

pub(crate) use collector::{Any, Closest, Collector, First, Inner, Nearest, Next, Where, end_of, start_of};
pub use hits::Hits;
pub use item_buffer::ItemBuffer;
pub use overlaps::Overlaps;
pub use paused::{PausedQuery, Progress};
pub use wanted::Wanted;
