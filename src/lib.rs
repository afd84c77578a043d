//! draft
#![no_std]
#![forbid(unsafe_code)]
#[cfg(any(test, feature = "std"))]
extern crate std;

pub use accel::{Accelerator, KdTree, List, Traversal, kdtree};
pub use arena::Arena;
pub use error::Error;
pub use geometry::{PreparedRay, Ray};
pub use glam;
pub use primitives::{Hit, Mesh, Primitives, Span, from_fn};
pub use scene::Scene;

pub mod accel;
pub mod arena;
pub mod asset;
#[cfg(feature = "graphics")]
pub mod display;
pub mod error;
pub mod geometry;
mod math;
#[cfg(feature = "std")]
pub mod parallel;
pub mod primitives;
pub mod query;
pub mod render;
pub mod scene;
#[cfg(test)]
mod testing;
