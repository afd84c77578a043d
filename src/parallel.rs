//! All cores (feature `std`): the same bytes as on one.

use std::vec::Vec;

use rayon::prelude::*;

use crate::render::{Caster, Color, Renderer, Tile, TooShort};

/// Rows of pixels that a thread takes at a time: as many as a patch of a tile has.
const ROWS: u32 = 8;

/// Computes the whole picture, row by row, into the beginning of `pixels`, on the threads of the current `rayon` pool.
///
/// ```
/// use hitscan::{List, Mesh, Scene, glam::Vec3, parallel, render::{Camera, Renderer}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let renderer = Renderer::new(&scene, Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y), 32, 24);
/// let mut picture = vec![[0_u8; 3]; 32 * 24];
/// parallel::render(&renderer, &mut picture)?;
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`TooShort`] if the picture has more pixels than the slice.
pub fn render<S, C>(renderer: &Renderer<'_, S>, pixels: &mut [C]) -> Result<(), TooShort>
where
    S: Caster + Sync + ?Sized,
    C: Color + Send,
{
    render_with(renderer, pixels, |_| {})
}

/// As [`render`], and tells `done` of each tile when it is finished, from the thread that did it.
///
/// # Errors
///
/// [`TooShort`] if the picture has more pixels than the slice.
pub fn render_with<S, C>(
    renderer: &Renderer<'_, S>,
    pixels: &mut [C],
    done: impl Fn(Tile) + Sync,
) -> Result<(), TooShort>
where
    S: Caster + Sync + ?Sized,
    C: Color + Send,
{
    let (width, height) = (renderer.width(), renderer.height());
    let whole = Tile { x: 0, y: 0, width, height };
    let (needed, available) = (whole.area(), pixels.len());
    let Some(pixels) = pixels.get_mut(..needed) else { return Err(TooShort { needed, available }) };
    // Bands of whole rows are contiguous in the picture.
    let bands: Vec<Tile> = renderer.tiles(width, ROWS).collect();
    let rows = pixels.par_chunks_mut((width * ROWS).max(1) as usize);
    rows.zip(bands).try_for_each(|(rows, band)| renderer.fill(band, rows).map(|()| done(band)))
}
