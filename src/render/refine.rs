use glam::Vec3;

use super::{Caster, Renderer, Tile, renderer::PATCH};

/// Many samples where they are seen.
impl<S: Caster + ?Sized> Renderer<'_, S> {
    /// The pixels of a tile whose colours in `rough`, row by row, differ from one beside, above or below, and their light:
    /// that of all [samples](Self::with_samples), which others need not.
    ///
    /// A picture of one sample a pixel becomes nearly as smooth as one of many, for few rays more; the caller says what
    /// differs enough to be seen. Pixels that `rough` does not hold differ from none, so that a tile should be the picture or
    /// whole rows of it.
    ///
    /// ```
    /// use hitscan::{List, Mesh, Scene, glam::Vec3, render::{Camera, Color, Renderer, Tile}};
    /// let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
    /// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let renderer = Renderer::new(&scene, Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y), 64, 48);
    ///
    /// let picture = Tile { x: 0, y: 0, width: 64, height: 48 };
    /// let mut pixels = [0_u8; 64 * 48];
    /// renderer.fill(picture, &mut pixels)?;
    /// let rough = pixels;
    /// let mut edges = 0;
    /// for ((x, y), light) in renderer.with_samples(4).refined(picture, &rough, |a, b| a.abs_diff(*b) > 16) {
    ///     pixels[(y * 64 + x) as usize] = u8::from_linear(light);
    ///     edges += 1;
    /// }
    /// assert!(edges < 64 * 48 / 10);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn refined<C>(
        &self,
        tile: Tile,
        rough: &[C],
        differ: impl Fn(&C, &C) -> bool,
    ) -> impl Iterator<Item = ((u32, u32), Vec3)> {
        let color = move |x: u32, y: u32| {
            let (column, row) = (x.checked_sub(tile.x)?, y.checked_sub(tile.y)?);
            if column >= tile.width {
                return None;
            }
            rough.get((row as usize).checked_mul(tile.width as usize)?.checked_add(column as usize)?)
        };
        let is_edge = move |x: u32, y: u32| {
            let Some(own) = color(x, y) else { return false };
            let beside =
                [(x.wrapping_sub(1), y), (x.wrapping_add(1), y), (x, y.wrapping_sub(1)), (x, y.wrapping_add(1))];
            beside.into_iter().any(|(x, y)| color(x, y).is_some_and(|other| differ(own, other)))
        };
        // The patch at hand, and the pixels left in it.
        let mut parts = tile.parts(PATCH, PATCH).map(|part| (part, part.pixels()));
        let (mut at, mut patch) = (parts.next(), None);
        core::iter::from_fn(move || {
            loop {
                let (part, pixels) = at.as_mut()?;
                if let Some((x, y)) = pixels.find(|&(x, y)| is_edge(x, y)) {
                    let patch = patch.get_or_insert_with(|| self.patch(*part));
                    return Some(((x, y), patch.pixel(x, y)));
                }
                (at, patch) = (parts.next(), None);
            }
        })
    }
}
