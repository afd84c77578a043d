//! The engines compared, behind one trait.

mod bvh;
mod embree;
mod hitscan;
mod obvhs;
mod parry;

use std::{fmt, time::Duration};

use ::hitscan::Ray;

use self::{bvh::bvh, obvhs::obvhs, parry::parry};
pub use self::{
    embree::{Libraries, embree},
    hitscan::{Memory, Preset, hitscan},
};
use crate::{mesh::Mesh, rays::Kind};

/// An engine over one mesh. It is handed rays by the set, so that being a trait object costs nothing.
pub trait Engine {
    /// All that its rays may read: tree, lists and triangles, the mesh too if it reads that.
    fn bytes(&self) -> usize;

    /// Writes the `t` of the first hit of each ray, infinite for a miss.
    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>);

    /// Writes 0 for each ray that hits something and infinity for the others.
    fn any(&self, rays: &[Ray], t: &mut Vec<f32>);

    /// Whether it has a way to cast such rays.
    fn casts(&self, _kind: Kind) -> bool {
        true
    }
}

/// What the others are measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Embree at its best, one ray at a time.
    High,
    /// Embree's mode in which fewer rays slip through.
    Robust,
    /// Embree's packets of 16 rays.
    Packets,
    /// obvhs, the fastest in Rust besides hitscan.
    Obvhs,
}

/// An engine in the ring.
pub struct Contender<'a> {
    /// Name, version where it matters, and preset.
    pub name: String,
    /// Whether others are measured by it.
    pub role: Option<Role>,
    /// CPU time of its build.
    pub build: Duration,
    /// The engine itself.
    pub engine: Box<dyn Engine + 'a>,
}

impl fmt::Debug for Contender<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Contender").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Which engines are wanted: those whose name contains one of these words, all if there is none.
#[derive(Clone, Debug, Default)]
pub struct Wanted(pub Vec<String>);

impl Wanted {
    /// Whether this one is.
    pub fn has(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        self.0.is_empty() || self.0.iter().any(|word| name.contains(&word.to_lowercase()))
    }
}

/// Builds every peer that is wanted.
pub fn peers(mesh: &Mesh, libraries: &Libraries, wanted: &Wanted) -> Vec<Contender<'static>> {
    let mut contenders = embree(mesh, libraries, wanted);
    contenders.extend(obvhs(mesh, wanted));
    contenders.extend(parry(mesh, wanted));
    contenders.extend(bvh(mesh, wanted));
    contenders
}

/// How a query for any hit is written down.
const fn shadow(hit: bool) -> f32 {
    if hit { 0.0 } else { f32::INFINITY }
}
