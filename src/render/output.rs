use super::{Caster, Channels, Dither, Renderer, Tile, TooShort};

/// Pictures for displays of few colours, and two buffers by turns.
impl<S: Caster + ?Sized> Renderer<'_, S> {
    /// The colours of a tile, row by row, dithered and computed as they are taken.
    pub fn dithered<C: Channels>(&self, tile: Tile, mut dither: impl Dither) -> impl Iterator<Item = C> {
        tile.pixels().zip(self.colors(tile)).map(move |(pixel, light)| dither.color(pixel, light))
    }

    /// Computes the dithered colours of a tile, row by row, into the beginning of `pixels`.
    ///
    /// # Errors
    ///
    /// [`TooShort`] if the tile has more pixels than the slice.
    pub fn fill_dithered<C: Channels>(
        &self,
        tile: Tile,
        pixels: &mut [C],
        dither: impl Dither,
    ) -> Result<(), TooShort> {
        let (needed, available) = (tile.area(), pixels.len());
        if needed > available {
            return Err(TooShort { needed, available });
        }
        for (pixel, color) in pixels.iter_mut().zip(self.dithered(tile, dither)) {
            *pixel = color;
        }
        Ok(())
    }

    /// Draws the picture in tiles of at most `tile` pixels, each into the buffer that `swap` gave for the one before.
    ///
    /// `swap` takes a full buffer and gives one to draw into. With two buffers one is on its way to the display while the
    /// other is drawn; with one, `swap` gives it back when it has been sent. Tiles of one row make it a line callback.
    /// Returns the buffer that it has in the end, or the error with which `swap` ended the picture.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Scene, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// use hitscan::render::{Camera, Ordered, Renderer};
    ///
    /// /// Sends a buffer in the background: what a DMA channel does.
    /// struct Transfer<'a>(&'a mut [[u8; 2]]);
    ///
    /// impl<'a> Transfer<'a> {
    ///     fn start(buffer: &'a mut [[u8; 2]]) -> Self {
    ///         let _big_endian_rgb565: &[u8] = buffer.as_flattened();
    ///         Self(buffer)
    ///     }
    ///     fn wait(self) -> &'a mut [[u8; 2]] {
    ///         self.0
    ///     }
    /// }
    ///
    /// let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
    /// let renderer = Renderer::new(&scene, camera, 240, 240);
    /// let (mut first, mut second) = ([[0; 2]; 240 * 4], [[0; 2]; 240 * 4]);
    /// let mut transfer = Some(Transfer::start(&mut second));
    /// renderer.stream((240, 4), Ordered, first.as_mut_slice(), |_tile, full| {
    ///     let free = transfer.take().map(Transfer::wait);
    ///     transfer = Some(Transfer::start(full));
    ///     free.ok_or("the other buffer is lost")
    /// })??;
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`TooShort`] if a tile has more pixels than the buffer.
    pub fn stream<C, B, E>(
        &self,
        tile: (u32, u32),
        mut dither: impl Dither,
        mut buffer: B,
        mut swap: impl FnMut(Tile, B) -> Result<B, E>,
    ) -> Result<Result<B, E>, TooShort>
    where
        C: Channels,
        B: AsMut<[C]>,
    {
        for tile in self.tiles(tile.0, tile.1) {
            self.fill_dithered(tile, buffer.as_mut(), &mut dither)?;
            buffer = match swap(tile, buffer) {
                Ok(free) => free,
                Err(error) => return Ok(Err(error)),
            };
        }
        Ok(Ok(buffer))
    }
}
