//! What a renderer needs besides a scene: a place to look from, lights, ground, and somebody who counts.

mod camera;
mod counted;
mod ground;
mod lights;

pub use camera::{CameraArg, Up, Viewpoint};
pub use counted::{Counted, DEPTHS, Tally};
pub use ground::Grounded;
pub use lights::{Lighting, glazed, plate};
