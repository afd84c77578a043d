//! The engines compared, behind one trait.

mod hitscan;
mod obvhs;

pub use self::{
    hitscan::{Kd, Preset},
    obvhs::{Bvh2Slow, CwBvhVerySlow, obvhs_triangles},
};
use ::hitscan::Ray;

/// An engine over one mesh. It is handed rays by the set, so that being a trait object costs nothing.
pub trait Engine {
    /// Name and preset.
    fn name(&self) -> String;

    /// What it traverses besides the caller's mesh.
    fn bytes(&self) -> usize;

    /// Writes the `t` of the first hit of each ray, infinite for a miss.
    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>);

    /// Writes 0 for each ray that hits something and infinity for the others.
    fn any(&self, rays: &[Ray], t: &mut Vec<f32>);
}

/// How a query for any hit is written down.
const fn shadow(hit: bool) -> f32 {
    if hit { 0.0 } else { f32::INFINITY }
}
