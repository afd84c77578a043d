//! As much of Embree as a comparison needs: triangles, the closest hit, any hit, and packets of 16 rays.
//!
//! The library is looked for when the program runs, so that nothing here needs Embree in order to be built, and
//! one program can hold several versions side by side. Embree 3 and 4 are known: they differ in how a query is called, not
//! in how rays lie in memory.

mod error;
mod layout;
mod library;
mod scene;

pub use self::{
    error::Error,
    library::Library,
    scene::{Options, Quality, Ray, Scene},
};
