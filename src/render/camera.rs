use glam::Vec3;

use super::Tile;
use crate::{
    geometry::{Aabb, Bundle, Pencil, Ray, Screen},
    math,
    primitives::unit,
};

/// A camera: which ray belongs to which point of the picture.
///
/// ```
/// use hitscan::{glam::Vec3, render::Camera};
/// let camera = Camera::pinhole(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 0.8);
/// let middle = camera.ray(160.0, 120.0, 320, 240);
/// assert!(middle.at(5.0).length() < 1.0e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Vec3,
    forward: Vec3,
    /// Half the picture's height at distance 1 (pinhole) or everywhere (orthographic), upwards.
    up: Vec3,
    /// As long as `up`.
    right: Vec3,
    parallel: bool,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `target`; `fov` is the vertical angle of view in radians.
    #[must_use]
    pub fn pinhole(eye: Vec3, target: Vec3, up: Vec3, fov: f32) -> Self {
        Self::looking(eye, target, up, math::tan(fov * 0.5), false)
    }

    /// A camera without perspective, `height` of which fits into the picture.
    #[must_use]
    pub fn orthographic(eye: Vec3, target: Vec3, up: Vec3, height: f32) -> Self {
        Self::looking(eye, target, up, height * 0.5, true)
    }

    /// A perspective camera that sees all of `bounds` in a picture of any shape, from the direction `from` of its middle.
    #[must_use]
    pub fn framing(bounds: &Aabb, from: Vec3, up: Vec3) -> Self {
        const HALF_HEIGHT: f32 = 0.36; // tan of 20 degrees
        let radius = math::sqrt(bounds.size().dot(bounds.size())) * 0.5;
        // A sphere of this radius touches the edges of the picture.
        let distance = radius * math::sqrt(1.0 + 1.0 / (HALF_HEIGHT * HALF_HEIGHT));
        let eye = bounds.center() + unit(from) * distance.max(f32::MIN_POSITIVE);
        Self::looking(eye, bounds.center(), up, HALF_HEIGHT, false)
    }

    fn looking(eye: Vec3, target: Vec3, up: Vec3, half_height: f32, parallel: bool) -> Self {
        let forward = unit(target - eye);
        let right = unit(forward.cross(up));
        let up = right.cross(forward);
        Self { eye, forward, up: up * half_height, right: right * half_height, parallel }
    }

    /// Where it stands.
    #[must_use]
    pub const fn eye(&self) -> Vec3 {
        self.eye
    }

    /// The direction it looks in, of length 1.
    #[must_use]
    pub const fn forward(&self) -> Vec3 {
        self.forward
    }

    /// The direction that is up in the picture, of length 1.
    #[must_use]
    pub fn up(&self) -> Vec3 {
        unit(self.up)
    }

    /// The ray through the point `(x, y)` of a picture, in pixels from its upper left corner.
    #[inline]
    #[must_use]
    pub fn ray(&self, x: f32, y: f32, width: u32, height: u32) -> Ray {
        let across = self.screen(width, height).across(x, y);
        if self.parallel {
            Ray::new(self.eye + across, self.forward)
        } else {
            Ray::new(self.eye, self.forward + across)
        }
    }

    /// A picture of this size.
    #[inline]
    fn screen(&self, width: u32, height: u32) -> Screen {
        let half = [width, height].map(|side| side as f32 * 0.5);
        Screen { forward: self.forward, up: self.up, right: self.right, half }
    }

    /// The rays through the middles of a tile's pixels; `None` if they do not begin at one point, or are more than 8 x 8.
    #[must_use]
    pub fn pencil(&self, tile: &Tile, width: u32, height: u32) -> Option<Pencil> {
        self.pencil_of(tile, width, height, 1)
    }

    /// The same of `samples` x `samples` rays a pixel.
    pub(super) fn pencil_of(&self, tile: &Tile, width: u32, height: u32, samples: u32) -> Option<Pencil> {
        if self.parallel {
            return None;
        }
        Pencil::new(self.eye, self.screen(width, height), [tile.x, tile.y], [tile.width, tile.height], samples)
    }

    /// All rays through the points of a tile of a picture; `None` if they are to be looked at one by one.
    ///
    /// Coordinate by coordinate, a ray's numbers rise or fall with `x` and with `y`, roundings included, so that those at the
    /// corners of the tile bound them all.
    #[must_use]
    pub fn bundle(&self, tile: &Tile, width: u32, height: u32) -> Option<Bundle> {
        let (left, right) = (tile.x as f32, tile.x.saturating_add(tile.width) as f32);
        let (top, bottom) = (tile.y as f32, tile.y.saturating_add(tile.height) as f32);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        Bundle::around(corners.map(|(x, y)| self.ray(x, y, width, height)))
    }
}
