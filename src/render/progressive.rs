use glam::Vec3;

use super::{Caster, Interlaced, Patch, Renderer, Tile};

/// A picture that is rough at first: of blocks of 8 x 8 pixels, of which each pass computes as many as all before it.
///
/// An iterator of blocks and their linear colours [interlaced](Interlaced) by Bayer's matrix, each to be drawn over what is there. It
/// can be left and gone on with at any time, and computes each pixel once: the first 64th of the work shows the whole
/// picture, the second half completes it.
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
    pixels: Interlaced,
    /// The tile at hand, with where its rays may begin.
    patch: Option<(Tile, Patch<'a, S>)>,
}

impl<'a, S: Caster + ?Sized> Progressive<'a, S> {
    pub(super) fn new(renderer: Renderer<'a, S>) -> Self {
        Self { renderer, pixels: Interlaced::new(renderer.width(), renderer.height()), patch: None }
    }

    /// Computes at most so many pixels and lets `draw` have their blocks; false at the end of the picture.
    ///
    /// True says that there may be more: where the budget ends with the last pixel, the next step computes none.
    pub fn step(&mut self, pixels: u32, mut draw: impl FnMut(Tile, Vec3)) -> bool {
        for _ in 0..pixels {
            let Some((block, light)) = self.next() else { return false };
            draw(block, light);
        }
        true
    }
}

impl<S: Caster + ?Sized> Iterator for Progressive<'_, S> {
    type Item = (Tile, Vec3);

    fn next(&mut self) -> Option<(Tile, Vec3)> {
        let block = self.pixels.next()?;
        let tile = self.pixels.tile();
        if self.patch.as_ref().is_none_or(|(at_hand, _)| *at_hand != tile) {
            self.patch = Some((tile, self.renderer.patch(tile)));
        }
        let (_, patch) = self.patch.as_ref()?;
        Some((block, patch.pixel(block.x, block.y)))
    }
}
