//! Rays on a GPU: the words of a baked asset, uploaded as they are, and the library's own walks in WGSL.
//!
//! A GPU's arithmetic is not the library's: divisions may be off by 2.5 ulp, products and sums may be fused, the rounding may go
//! either way, denormals may vanish and infinities may be anything. So the shaders never ask *what* a result is, only
//! what it is *for certain*, with a bound on all that may be off. A ray of which everything is certain is answered by the
//! number of a primitive, and the library computes `t` from ray and primitive; every other ray is cast again by the
//! library. Both ways, the answers are the library's, bit for bit. README.md has the argument.
//!
//! A [`Device`] is a GPU, a [`World`] an asset as the library sees it, an [`Uploaded`] one as the GPU sees it, which casts
//! batches of rays; [`settle`] makes hits of its answers. A [`Picture`] is drawn of both.

mod alone;
mod device;
mod layout;
mod picture;
mod settle;
mod shader;
mod upload;
mod world;

pub mod commands;

pub use device::{Device, NoAdapter};
pub use layout::{Layout, Unfit};
pub use picture::{Picture, Stage};
pub use settle::{Tally, settle};
pub use upload::{Answer, Query, Uploaded};
pub use world::{Parts, Triangles, World};
