//! Against the library: on every scene and every ray, shaders and library together answer bit for bit as the library alone.
//!
//! Without a GPU nothing of that is tested, and the tests say so; `HITSCAN_GPU_REQUIRED=1`, which `./check` sets, makes
//! that a failure. lavapipe, a driver for any processor, is a GPU here.
#![allow(missing_docs)]

#[path = "../../../../tests/common/mod.rs"]
mod common;

mod adversarial;
mod bindings;
mod damage;
mod instances;
mod nasty;
mod picture;
mod program;
mod scene;
mod truth;
