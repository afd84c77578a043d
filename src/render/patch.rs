use core::cell::Cell;

use glam::Vec3;

use super::{Caster, Renderer, Tile, renderer::First};
use crate::{accel::Entries, geometry::Ray};

/// A tile of a picture, with where in the scene its rays may begin.
///
/// Looked for once, for all rays of the tile; where they meet nothing, none of them is walked. The smaller the tile, the
/// nearer to its end a walk begins: 8 x 8 pixels are a good size. Of each light, the last thing that cast a shadow is tried
/// first for the next.
///
/// ```
/// use hitscan::{List, Mesh, Scene, glam::Vec3, render::{Camera, Renderer, Tile}};
/// let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let renderer = Renderer::new(&scene, Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y), 64, 48);
/// let patch = renderer.patch(Tile { x: 24, y: 16, width: 8, height: 8 });
/// assert_eq!(patch.pixel(25, 17), renderer.pixel(25, 17));
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Patch<'a, S: ?Sized> {
    renderer: Renderer<'a, S>,
    /// None if each ray begins with everything.
    entries: Option<Entries>,
    /// What last kept the light of each of the first lights from a point.
    occluders: [Cell<Option<u32>>; LIGHTS],
}

/// Lights whose last occluder is remembered.
const LIGHTS: usize = 4;

impl<'a, S: Caster + ?Sized> Patch<'a, S> {
    pub(super) fn new(renderer: Renderer<'a, S>, tile: &Tile) -> Self {
        let entries = renderer.bundle(tile).map(|bundle| renderer.scene.enter(&bundle));
        let entries = entries.filter(|entries| !entries.is_everything());
        Self { renderer, entries, occluders: Default::default() }
    }

    /// A tile whose first hits are known.
    pub(super) fn begun(renderer: Renderer<'a, S>) -> Self {
        Self { renderer, entries: None, occluders: Default::default() }
    }

    /// The linear colour of a pixel of the tile, as [`Renderer::pixel`].
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Vec3 {
        let first = self.entries.as_ref().map_or(First::Unknown, First::From);
        self.renderer.pixel_from(Some(self), |_, _| first, x, y)
    }

    /// Whether something keeps the light of this number from where a shadow ray begins.
    pub(super) fn shades(&self, light: usize, ray: &Ray, depth: u32) -> bool {
        let occluder = self.occluders.get(light);
        let mut last = occluder.and_then(Cell::get);
        let shades = self.renderer.scene.any_hit_near(ray, depth, &mut last);
        if let Some(occluder) = occluder {
            occluder.set(last);
        }
        shades
    }
}
