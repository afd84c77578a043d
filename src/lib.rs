//! A ray engine that fits in flash: it answers "what does this ray hit?" and draws pictures from the answers, on
//! microcontrollers without heap and on desktop cores with threads, from one set of words.
//!
//! ```text
//! geometry → primitives → build → structure in an arena → traverse → scene → render → display
//!                                     ‖
//!                     the same u32 words in RAM, flash, a file, a message
//! ```
//!
//! # Promises
//!
//! * **Exact.** Every structure returns bit for bit what a list of all primitives returns: the least `(t, number)`. It
//!   follows from rules that ARCHITECTURE.md states and proves, and tests hold them against millions of adversarial rays.
//! * **Watertight.** No ray passes between triangles that share an edge or a corner: the inputs are read as real numbers,
//!   and what `f32` cannot prove, wider arithmetic decides.
//! * **No heap, no panic, no recursion, no `unsafe`.** The core links on bare metal without a panic handler being
//!   reachable. A kD-tree is at most [`kdtree::MAX_DEPTH`] = 32 deep and its walk keeps a stack of 384 bytes; the
//!   others are bounded likewise.
//! * **Zero RAM.** A baked scene is queried where it lies, in flash.
//! * **Any bits in, a defined answer out.** Invalid rays miss, damaged assets and non-finite meshes are errors with
//!   numbers in them.
//! * **Reproducible.** The same bits on every target and for any number of threads.
//!
//! # Example: query a scene from flash
//!
//! `hitscan bake model.obj -o scene.hits` makes the asset; a device includes it.
//!
//! ```ignore
//! use hitscan::{KdTree, Mesh, Ray, asset::Asset, include_asset};
//!
//! static SCENE: &[u8] = include_asset!("scene.hits");
//! let scene = Asset::open(SCENE)?.scene::<KdTree, Mesh>()?;
//! if let Some(hit) = scene.closest_hit(&Ray::new(origin, direction)) { /* hit.t, hit.primitive */ }
//! ```
//!
//! # Example: build on the device
//!
//! ```
//! use hitscan::{Arena, KdTree, Mesh, Ray, Scene, glam::Vec3, kdtree::Options};
//!
//! let vertices = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
//! let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
//! let mut memory = [0_u32; KdTree::words(1, &Options::small())];
//! let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::small())?;
//! let scene = Scene::new(tree, &mesh)?;
//!
//! let hit = scene.closest_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)).unwrap();
//! assert_eq!((hit.t, hit.primitive), (1.0, 0));
//! # Ok::<(), hitscan::Error>(())
//! ```
//!
//! # Which structure
//!
//! All give the same hits. Bytes per triangle are those of the preset `balanced` on meshes of a few thousand triangles;
//! `hitscan compare` measures yours.
//!
//! | structure | bytes | for |
//! |---|---|---|
//! | [`List`] | 0 | up to eight primitives, and as the oracle of all others |
//! | [`DualSplit`] | 5, in order | the least flash |
//! | [`Bvh`] | 11, in order | moving geometry ([`Bvh::refit`]), shapes of your own |
//! | [`Grid`] | 13 | the quickest to build; where triangles lie evenly, the fastest rays on chips |
//! | [`CompactKdTree`] | 18; 11 with `small` | a kD-tree in two thirds of the bytes |
//! | [`Octree`] | 23 | few, wide nodes |
//! | [`KdTree`] | 27 | fast rays over any scene |
//!
//! BVH and dual-split tree need no list of numbers if the primitives stand *in order*: that of their leaves
//! ([`Bvh::ordered`], [`primitives::Reordered`]). [`Instances`] place scenes many times, at any depth.
//! [`LatticeScene`] answers in whole numbers, for chips without an FPU; [`Soup`](primitives::Soup) and
//! [`Meshlets`](primitives::Meshlets) trade bytes of triangles for speed, or speed for bytes.
//! [`accel::Mailbox`], [`accel::Bounded`] and [`accel::Counted`] go around any structure; [`accel::Structure`] is any of them.
//!
//! # Example: the nearest point
//!
//! ```
//! # use hitscan::{List, Mesh, Scene, glam::Vec3};
//! # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
//! # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
//! # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
//! let nearest = scene.nearest_point(Vec3::new(0.2, 0.2, 3.0), 10.0).unwrap();
//! assert_eq!((nearest.distance, nearest.primitive), (3.0, 0));
//! # Ok::<(), hitscan::Error>(())
//! ```
//!
//! # Example: draw tile by tile
//!
//! ```
//! # use hitscan::{List, Mesh, Scene, glam::Vec3};
//! # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
//! # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
//! # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
//! use hitscan::render::{Camera, Light, Renderer};
//!
//! let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
//! let lights = [Light::directional(Vec3::new(-1.0, -2.0, -1.0), Vec3::ONE)];
//! let renderer = Renderer::new(&scene, camera, 320, 240).with_lights(&lights).with_bounces(2);
//! let mut strip = [0_u16; 320 * 8]; // RGB565
//! for tile in renderer.tiles(320, 8) {
//!     renderer.fill(tile, &mut strip)?;
//!     // hand `strip` to the display's DMA
//! }
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! With the feature `graphics`, `display::draw` does the same for any `embedded_graphics` target, and with `std`
//! `parallel::render` on all cores.
//!
//! # Example: your own shapes
//!
//! Implement [`Primitives`], whose documentation shows it, or use closures: [`from_fn`].
//!
//! # Why, and why not
//!
//! No other crate answers triangle ray queries without heap and from flash, and none promises the same bits from every
//! structure. On a desktop use `wide::WideBvh` (feature `std`), which takes eight boxes at a time. There are no curves, no motion blur and no path tracing here, and **no** `f64` scenes.
//!
//! Outside the promises: targets that flush denormals to zero, and bounds of your own shapes that do not contain them.
//!
//! # Features
//!
//! None by default; all are additive.
//!
//! | feature | adds |
//! |---|---|
//! | `alloc` | `bake`: assets from structures |
//! | `std` | `alloc`, `parallel`: all cores, and `wide`: SIMD |
//! | `graphics` | `display`: `embedded_graphics` targets |
//! | `defmt` | `defmt::Format` for errors and small types |
//!
//! The minimum supported Rust version is 1.95; raising it is a minor release.
#![no_std]
#![forbid(unsafe_code)]
// What panics on purpose. Whether an index can fail, clippy cannot tell; `examples/link` lets the linker prove it.
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable,
        clippy::todo,
        clippy::unimplemented
    )
)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

pub use accel::{
    Accelerator, Bvh, CompactKdTree, DualSplit, Grid, KdTree, List, Octree, Traversal, bvh, dualsplit, grid, kdtree,
    octree,
};
pub use arena::Arena;
pub use error::Error;
pub use geometry::{PreparedRay, Ray};
pub use glam;
pub use instances::{Instance, Instances};
pub use lattice_scene::LatticeScene;
pub use primitives::{Hit, LatticeMesh, Mesh, Primitives, Span, from_fn};
pub use scene::Scene;

mod math;

pub mod geometry;

#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod arena;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod asset;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod primitives;

pub mod accel;

#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod instances;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod lattice_scene;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod query;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod scene;

pub mod render;
#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod sensor;

#[cfg(feature = "alloc")]
pub mod bake;
#[cfg(feature = "graphics")]
pub mod display;
#[cfg(feature = "std")]
pub mod parallel;
#[cfg(feature = "std")]
pub mod wide;

#[cfg_attr(not(test), deny(clippy::indexing_slicing))]
pub mod error;

#[cfg(test)]
mod testing;
