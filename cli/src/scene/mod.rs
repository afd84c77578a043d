//! What rays are cast at: a mesh file, a baked asset or the built-in scene, under the structure that was asked for.

mod anatomy;
mod built;
pub mod builtin;
mod choice;
mod geometry;
mod instancing;
mod normals;
mod palette;
mod placed;
mod preset;
mod queries;
mod shape;
mod skin;
mod source;
mod subject;
mod wide;

pub use anatomy::Anatomy;
pub(crate) use built::unwrapped;
pub use built::{Built, broken};
pub use choice::{Choice, Named, StructureArgs};
pub use geometry::Geometry;
pub use instancing::Instancing;
pub use normals::normals_by_place;
pub use palette::Palette;
pub use preset::Preset;
pub use queries::Queries;
pub use shape::Shape;
pub use skin::Skin;
pub use source::{Source, View};
pub use wide::Wide;
