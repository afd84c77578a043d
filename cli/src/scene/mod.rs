//! What rays are cast at: a mesh file, a baked asset or the built-in scene, under the structure that was asked for.

mod anatomy;
pub mod builtin;
mod palette;
mod queries;
mod smooth;
mod source;
mod structure;

pub use anatomy::Anatomy;
pub use palette::Palette;
pub use queries::Queries;
pub use smooth::Smooth;
pub use source::{Geometry, Source, View};
pub use structure::{Built, Preset, Structure, StructureArgs};
