use core::cell::Cell;

use glam::Vec3;

use super::{Caster, Renderer, Tile};
use crate::{accel::Entries, geometry::Ray, primitives::Hit, query::ItemBuffer};

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
    pub(super) entries: Option<Entries>,
    /// What the rays of its pixels hit first, if that is known: from this corner on.
    hits: Option<(&'a ItemBuffer, [u32; 2])>,
    /// What last kept the light of each of the first lights from a point.
    occluders: [Cell<Option<u32>>; LIGHTS],
}

/// Lights whose last occluder is remembered.
const LIGHTS: usize = 4;

impl<'a, S: Caster + ?Sized> Patch<'a, S> {
    pub(super) fn new(renderer: Renderer<'a, S>, tile: &Tile) -> Self {
        let entries = renderer.bundle(tile).map(|bundle| renderer.scene.enter(&bundle));
        Self { renderer, entries, hits: None, occluders: Default::default() }
    }

    /// The tile whose rays hit this.
    pub(super) fn of_hits(renderer: Renderer<'a, S>, tile: &Tile, hits: &'a ItemBuffer) -> Self {
        Self { renderer, entries: None, hits: Some((hits, [tile.x, tile.y])), occluders: Default::default() }
    }

    /// What the ray of a pixel hits first, if that is known.
    pub(super) fn first_hit(&self, x: u32, y: u32) -> Option<Option<Hit>> {
        self.hits.map(|(hits, corner)| hits.get(x.wrapping_sub(corner[0]), y.wrapping_sub(corner[1])))
    }

    /// The linear colour of a pixel of the tile, as [`Renderer::pixel`].
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Vec3 {
        self.renderer.pixel_from(Some(self), x, y)
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
