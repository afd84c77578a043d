use core::fmt;

use glam::Vec3;

use super::{Camera, Caster, Color, Light, Materials, Patch, Progressive, Terms, Tile, Tiles, shade::mirror};
use crate::{
    accel::Entries,
    geometry::{Aabb, Bundle, Pencil, Ray, place},
    primitives::{Hit, unit},
    query::ItemBuffer,
};

/// The slice for a tile's pixels has no room for all of them; it is untouched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TooShort {
    /// Pixels of the tile.
    pub needed: usize,
    /// Pixels of the slice.
    pub available: usize,
}

impl fmt::Display for TooShort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the tile has {} pixels, there is room for {}", self.needed, self.available)
    }
}

impl core::error::Error for TooShort {}

/// Pixels that a patch is wide and high.
pub(super) const PATCH: u32 = Pencil::SIDE;

/// What a camera's ray hits first.
#[derive(Clone, Copy)]
pub(super) enum First<'p> {
    /// To be looked for from the beginning.
    Unknown,
    /// From where those of a tile begin.
    From(&'p Entries),
    /// Known.
    Known(Option<Hit>),
}

/// A picture of a scene, computed where it is looked at.
///
/// ```
/// use hitscan::{List, Mesh, Scene, glam::Vec3, render::{Camera, Light, Renderer}};
/// let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
/// let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
/// let lights = [Light::directional(Vec3::NEG_Z, Vec3::ONE)];
/// let renderer = Renderer::new(&scene, camera, 64, 48).with_lights(&lights).with_bounces(1);
///
/// let mut pixels = [0_u16; 16 * 16];
/// for tile in renderer.tiles(16, 16) {
///     renderer.fill(tile, &mut pixels)?; // RGB565; now hand `pixels` to the display
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Renderer<'a, S: ?Sized> {
    pub(super) scene: &'a S,
    camera: Camera,
    width: u32,
    height: u32,
    pub(super) lights: &'a [Light],
    materials: Materials<'a>,
    pub(super) ambient: Vec3,
    background: [Vec3; 2],
    pub(super) terms: Terms,
    bounces: u32,
    samples: u32,
}

impl<S: ?Sized> Clone for Renderer<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: ?Sized> Copy for Renderer<'_, S> {}

impl<'a, S: Caster + ?Sized> Renderer<'a, S> {
    /// A picture of `width` x `height` pixels without lights or bounces, all primitives of the default material.
    #[must_use]
    pub fn new(scene: &'a S, camera: Camera, width: u32, height: u32) -> Self {
        Self {
            scene,
            camera,
            width,
            height,
            lights: &[],
            materials: Materials::default(),
            ambient: Vec3::splat(0.15),
            background: [Vec3::splat(0.8), Vec3::new(0.25, 0.4, 0.7)],
            terms: Terms::ALL,
            bounces: 0,
            samples: 1,
        }
    }

    /// The same with these lights.
    #[must_use]
    pub const fn with_lights(self, lights: &'a [Light]) -> Self {
        Self { lights, ..self }
    }

    /// The same with these materials.
    #[must_use]
    pub const fn with_materials(self, materials: Materials<'a>) -> Self {
        Self { materials, ..self }
    }

    /// The same with light from everywhere, linear red, green, blue.
    #[must_use]
    pub const fn with_ambient(self, ambient: Vec3) -> Self {
        Self { ambient, ..self }
    }

    /// The same where nothing is hit: one colour below, one above, blended between.
    #[must_use]
    pub const fn with_background(self, below: Vec3, above: Vec3) -> Self {
        Self { background: [below, above], ..self }
    }

    /// The same with these terms of light.
    #[must_use]
    pub const fn with_terms(self, terms: Terms) -> Self {
        Self { terms, ..self }
    }

    /// The same with mirror images in mirror images up to this depth.
    #[must_use]
    pub const fn with_bounces(self, bounces: u32) -> Self {
        Self { bounces, ..self }
    }

    /// The same with `samples` x `samples` rays a pixel, at least one.
    #[must_use]
    pub const fn with_samples(self, samples: u32) -> Self {
        Self { samples: if samples > 0 { samples } else { 1 }, ..self }
    }

    /// Pixels in a row.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Rays along a side of a pixel.
    #[must_use]
    pub const fn samples(&self) -> u32 {
        self.samples
    }

    /// The picture in tiles of at most this size.
    #[must_use]
    pub fn tiles(&self, width: u32, height: u32) -> Tiles {
        Tiles::new(self.width, self.height, width, height)
    }

    /// The picture in tiles of one row, for displays with a line buffer.
    #[must_use]
    pub fn scanlines(&self) -> Tiles {
        self.tiles(self.width, 1)
    }

    /// The colours of a tile, row by row, computed as they are taken.
    pub fn colors<C: Color>(&self, tile: Tile) -> impl Iterator<Item = C> + use<'a, C, S> {
        let patch = self.patch(tile);
        tile.pixels().map(move |(x, y)| C::from_linear(patch.pixel(x, y)))
    }

    /// Computes the colours of a tile, row by row, into the beginning of `pixels`.
    ///
    /// # Errors
    ///
    /// [`TooShort`] if the tile has more pixels than the slice.
    pub fn fill<C: Color>(&self, tile: Tile, pixels: &mut [C]) -> Result<(), TooShort> {
        let (needed, available) = (tile.area(), pixels.len());
        if needed > available {
            return Err(TooShort { needed, available });
        }
        let mut hits = ItemBuffer::new();
        // After parts whose hits are not found at once, fewer and fewer are tried so.
        let (mut pause, mut left) = (0, 0);
        let side = self.part();
        for part in tile.parts(side, side) {
            // Borrowed: moved, a pencil takes 120 bytes of stack more.
            let pencil = if left == 0 { self.pencil(&part) } else { None };
            let at_once = pencil.as_ref().is_some_and(|pencil| self.scene.closest_hits(pencil, &mut hits));
            if at_once {
                pause = 0;
            } else if left > 0 {
                left -= 1;
            } else {
                pause = (2 * pause + 1) % 16;
                left = pause;
            }
            let patch = if at_once { Patch::begun(*self) } else { self.patch(part) };
            for (x, y) in part.pixels() {
                let index = (y - tile.y) as usize * tile.width as usize + (x - tile.x) as usize;
                if let Some(pixel) = pixels.get_mut(index) {
                    let light = if at_once {
                        let [column, row] = [x - part.x, y - part.y].map(|pixels| pixels * self.samples);
                        self.pixel_from(Some(&patch), |i, j| First::Known(hits.get(column + i, row + j)), x, y)
                    } else {
                        patch.pixel(x, y)
                    };
                    *pixel = C::from_linear(light);
                }
            }
        }
        Ok(())
    }

    /// A tile, with where in the scene its rays may begin.
    #[must_use]
    pub fn patch(&self, tile: Tile) -> Patch<'a, S> {
        Patch::new(*self, &tile)
    }

    /// The picture, rough at first, as much of it at a time as there is time for.
    #[must_use]
    pub fn progressive(&self) -> Progressive<'a, S> {
        Progressive::new(*self)
    }

    /// Whether the camera may see something of a box through a tile: where nothing is in it before or after a change, the
    /// tile need not be computed again, shadows and mirror images aside.
    ///
    /// ```
    /// use hitscan::{List, Mesh, Scene, geometry::Aabb, glam::Vec3, render::{Camera, Renderer}};
    /// let mesh = Mesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0_u16, 1, 2]])?;
    /// let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let camera = Camera::pinhole(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 0.8);
    /// let renderer = Renderer::new(&scene, camera, 64, 64);
    /// let moved = Aabb::new(Vec3::splat(0.1), Vec3::splat(0.5));
    /// assert_eq!(renderer.tiles(8, 8).filter(|tile| renderer.may_show(tile, &moved)).count(), 4);
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn may_show(&self, tile: &Tile, bounds: &Aabb) -> bool {
        self.bundle(tile).is_none_or(|bundle| bundle.entry(bounds).is_some())
    }

    /// Pixels along a side of what has as many rays as a pencil, if one has not more.
    fn part(&self) -> u32 {
        match PATCH.checked_div(self.samples) {
            Some(side) if side > 0 => side,
            _ => PATCH,
        }
    }

    /// The rays of a tile; none if they are more than 8 x 8.
    fn pencil(&self, tile: &Tile) -> Option<Pencil> {
        self.camera.pencil_of(tile, self.width, self.height, self.samples)
    }

    /// All rays of a tile.
    pub(super) fn bundle(&self, tile: &Tile) -> Option<Bundle> {
        self.camera.bundle(tile, self.width, self.height)
    }

    /// The linear colour of a pixel, the mean of its samples.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Vec3 {
        self.pixel_from(None, |_, _| First::Unknown, x, y)
    }

    /// The colour of a pixel, of a patch or by itself, with what is known of the first hit of each of its rays.
    pub(super) fn pixel_from<'p>(
        &self,
        patch: Option<&Patch<'_, S>>,
        first: impl Fn(u32, u32) -> First<'p>,
        x: u32,
        y: u32,
    ) -> Vec3 {
        let step = 1.0 / self.samples as f32;
        let mut sum = Vec3::ZERO;
        for j in 0..self.samples {
            for i in 0..self.samples {
                let ray = self.camera.ray(place(x, i, step), place(y, j, step), self.width, self.height);
                sum += self.light_along(patch, first(i, j), ray);
            }
        }
        sum * (step * step)
    }

    /// The light that arrives against `ray`: Whitted, *An improved illumination model for shaded display*, 1980, as a loop.
    fn light_along(&self, patch: Option<&Patch<'_, S>>, mut first: First<'_>, mut ray: Ray) -> Vec3 {
        let (mut light, mut share) = (Vec3::ZERO, 1.0);
        for depth in 0..=self.bounces {
            let hit = match first {
                First::Unknown => self.scene.closest_hit(&ray, depth),
                First::From(entries) => self.scene.closest_hit_from(entries, &ray),
                First::Known(hit) => hit,
            };
            // Only of the camera's own ray anything is known.
            first = First::Unknown;
            let Some(hit) = hit else {
                return light + self.sky(ray.direction) * share;
            };
            let surface = self.scene.surface(&ray, &hit);
            let material = self.scene.material(&hit, &surface).unwrap_or_else(|| self.materials.of(hit.primitive));
            let direction = unit(ray.direction);
            let mirrored = if self.terms.reflections && depth < self.bounces { material.reflectivity } else { 0.0 };
            let own = self.phong(&surface, &material, -direction, (depth, patch));
            light += own * (share * (1.0 - mirrored));
            share *= mirrored;
            if !(share > 0.0) {
                break;
            }
            let reflected = mirror(direction, surface.shading_normal);
            ray = Ray::new(surface.start_towards(reflected), reflected);
        }
        light
    }

    fn sky(&self, direction: Vec3) -> Vec3 {
        let [below, above] = self.background;
        below + (above - below) * (unit(direction).dot(self.camera.up()) * 0.5 + 0.5)
    }
}
