//! Pictures: a camera's rays, shaded by the lecture-book terms, tile by tile.
//!
//! A [`Renderer`] holds no pixels. It is asked for them: one [`pixel`](Renderer::pixel), the colours of a
//! [`Tile`] as an iterator, or a tile filled into a slice; threads, displays and network nodes all use the same tiles.
//! For displays of few colours a [`Dither`] chooses them.

mod camera;
mod caster;
mod channels;
mod color;
mod dither;
mod interlaced;
mod levels;
mod light;
mod material;
mod output;
mod patch;
mod progressive;
mod refine;
mod renderer;
mod shade;
mod texture;
mod textured;
mod textures;
mod tile;

pub use camera::Camera;
pub use caster::Caster;
pub use channels::Channels;
pub use color::Color;
#[cfg(feature = "graphics")]
pub(crate) use color::{encode, luminance};
pub use dither::{Diffusion, Dither, Nearest, Ordered};
pub use interlaced::Interlaced;
pub use levels::Levels;
pub use light::Light;
pub use material::{Material, Materials, Numbers};
pub use patch::Patch;
pub use progressive::Progressive;
pub use renderer::{Renderer, TooShort};
pub use shade::Terms;
pub use texture::{Filter, Texels, Texture, TextureError, Wrap};
pub use textured::Textured;
pub use textures::Textures;
pub use tile::{Tile, Tiles};
