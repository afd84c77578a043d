use glam::Vec3;

use super::{Caster, Patch, Renderer, Tile, Tiles};

/// A picture that is rough at first: of blocks of 8 x 8, then 4 x 4, then 2 x 2 pixels, then of pixels.
///
/// An iterator of blocks and their linear colours, each to be drawn over what is there. It can be left and gone on with at
/// any time, and computes each pixel once: the first 64th of the work shows the whole picture, the last three quarters
/// complete it. Bayer, *An optimum method for two-level rendition of continuous-tone pictures*, 1973, orders its thresholds
/// in this way.
///
/// ```
/// use hitscan::{List, Mesh, Scene, glam::Vec3, render::{Camera, Color, Renderer}};
/// let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let renderer = Renderer::new(&scene, Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y), 64, 48);
///
/// let mut picture = renderer.progressive();
/// while picture.step(100, |block, light| {
///     let _ = (block, u16::from_linear(light)); // fill the block
/// }) {
///     // Read the buttons, serve the network, or `await`.
/// }
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Progressive<'a, S: ?Sized> {
    renderer: Renderer<'a, S>,
    /// Pixels from one to the next: 8, 4, 2, 1, and 0 at the end.
    stride: u32,
    /// The tiles that are left at this stride, each of [`SAMPLES`] x [`SAMPLES`] pixels that are computed or known.
    tiles: Tiles,
    /// The tile at hand.
    patch: Option<(Tile, Patch<'a, S>)>,
    /// The next pixel in it, in strides from its corner.
    next: (u32, u32),
}

/// Strides that a tile is wide and high.
const SAMPLES: u32 = 8;

/// Pixels that the first blocks are wide and high.
const COARSEST: u32 = 8;

impl<'a, S: Caster + ?Sized> Progressive<'a, S> {
    pub(super) fn new(renderer: Renderer<'a, S>) -> Self {
        let tiles = renderer.tiles(COARSEST * SAMPLES, COARSEST * SAMPLES);
        Self { renderer, stride: COARSEST, tiles, patch: None, next: (0, 0) }
    }

    /// Computes at most so many pixels and lets `draw` have their blocks; false at the end of the picture.
    ///
    /// True says that there may be more: where the budget ends with the last pixel, the next step computes none.
    pub fn step(&mut self, pixels: u32, mut draw: impl FnMut(Tile, Vec3)) -> bool {
        self.by_ref().take(pixels as usize).for_each(|(block, light)| draw(block, light));
        self.stride > 0
    }

    /// The next tile, if need be at the next stride.
    fn next_tile(&mut self) -> Option<()> {
        let tile = loop {
            match self.tiles.next() {
                Some(tile) => break tile,
                None => {
                    self.stride /= 2;
                    if self.stride == 0 {
                        return None;
                    }
                    self.tiles = self.renderer.tiles(self.stride * SAMPLES, self.stride * SAMPLES);
                }
            }
        };
        self.patch = Some((tile, self.renderer.patch(tile)));
        self.next = (0, 0);
        Some(())
    }
}

impl<S: Caster + ?Sized> Iterator for Progressive<'_, S> {
    type Item = (Tile, Vec3);

    fn next(&mut self) -> Option<(Tile, Vec3)> {
        loop {
            let stride = self.stride;
            let Some((tile, patch)) = &self.patch else {
                self.next_tile()?;
                continue;
            };
            let (column, row) = self.next;
            let (dx, dy) = (column * stride, row * stride);
            if dy >= tile.height {
                self.patch = None;
                continue;
            }
            if dx >= tile.width {
                self.next = (0, row + 1);
                continue;
            }
            self.next = (column + 1, row);
            // Every second one of every second row was there at the stride before.
            if stride < COARSEST && (column | row) & 1 == 0 {
                continue;
            }
            let (x, y) = (tile.x + dx, tile.y + dy);
            let block = Tile { x, y, width: stride.min(tile.width - dx), height: stride.min(tile.height - dy) };
            return Some((block, patch.pixel(x, y)));
        }
    }
}
