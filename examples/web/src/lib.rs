//! The engine behind the page: a model, a structure over it, and a picture that grows from coarse to fine.
//!
//! The module has raw exports and no imports. One instance holds one scene: for another model or structure the page makes
//! another instance, so what a broken file does to one never reaches the picture on the screen, and memory goes back.
#![deny(unsafe_code)]

mod builtin;
#[cfg(target_family = "wasm")]
mod exports;
mod heat;
mod lighting;
mod message;
mod model;
mod normals;
mod picture;
mod plan;
mod view;
mod world;

pub use builtin::BuiltIn;
pub use message::Message;
pub use model::Model;
pub use picture::Picture;
pub use plan::plan;
pub use view::View;
pub use world::World;
