//! The fastest structure on hosts (feature `std`): eight boxes or triangles at a time.

mod batch;
mod binary;
mod build;
mod collapse;
mod node;
mod permute;
mod simd;
mod slabs;
mod stack;
mod tree;
mod walk;

use std::ops::ControlFlow;

use fearless_simd::{Level, dispatch};

pub use self::{
    build::{Options, Progress},
    simd::Simd,
};
use self::{node::Child, tree::Tree};

use crate::{
    error::BuildError,
    geometry::{Aabb, Ray},
    primitives::{Hit, Surface, Triangles},
    render::Caster,
};

/// So many that twice as many references can be numbered.
const MAX_TRIANGLES: u32 = Child::MAX_TRIANGLES / 2;

/// A BVH of eight boxes a node and up to eight triangles a block, for hosts.
#[derive(Clone, Debug)]
pub struct WideBvh<P> {
    tree: Tree,
    level: Level,
    triangles: P,
}

impl<P: Triangles + Sync> WideBvh<P> {
    /// Builds it over `triangles`, on the threads of the current `rayon` pool.
    ///
    /// # Errors
    ///
    /// [`BuildError::Bounds`] names the first triangle that is not finite or beyond 2^126, and [`BuildError::TooMany`] says
    /// that there are more than 2^27.
    pub fn new(triangles: P, options: &Options) -> Result<Self, BuildError> {
        let built = Self::new_with(triangles, options, |_| ControlFlow::Continue(()))?;
        // Only who listens can break it off.
        built.ok_or(BuildError::TooMany { limit: MAX_TRIANGLES })
    }

    fn new_with(
        triangles: P,
        options: &Options,
        tell: impl Fn(Progress) -> ControlFlow<()> + Sync,
    ) -> Result<Option<Self>, BuildError> {
        let count = triangles.len();
        if count > MAX_TRIANGLES {
            return Err(BuildError::TooMany { limit: MAX_TRIANGLES });
        }
        let Some(binary) = build::build(&triangles, options, &tell)? else { return Ok(None) };
        let mut tree = collapse::collapse(&binary, |number| triangles.triangle(number));
        tree.sides = triangles.sides();
        if (0..count).any(|index| triangles.mask(index) != u32::MAX) {
            tree.masks = (0..count).map(|index| triangles.mask(index)).collect();
        }
        Ok(Some(Self { tree, level: Level::new(), triangles }))
    }
}

impl<P: Triangles> WideBvh<P> {
    /// The same, asked by these instructions; as before, if this machine does not have them.
    #[must_use]
    pub fn with_simd(self, simd: Simd) -> Self {
        Self { level: simd.level().unwrap_or(self.level), ..self }
    }

    /// The triangles.
    #[must_use]
    pub const fn triangles(&self) -> &P {
        &self.triangles
    }

    /// The box around everything.
    #[must_use]
    pub const fn bounds(&self) -> Aabb {
        self.tree.bounds
    }

    /// The bytes that rays walk through: all besides the triangles given.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
    }

    /// The first hit of the ray.
    #[must_use]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        dispatch!(self.level, simd => walk::closest(simd, &self.tree, ray))
    }

    /// Whether the ray hits anything.
    #[must_use]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        dispatch!(self.level, simd => walk::any(simd, &self.tree, ray))
    }

    /// The first hits of all rays, as far as there is room for them.
    pub fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        dispatch!(self.level, simd => batch::closest(simd, &self.tree, rays, hits));
    }

    /// Whether the rays hit anything, as far as there is room for it.
    pub fn any_hits(&self, rays: &[Ray], hits: &mut [bool]) {
        dispatch!(self.level, simd => batch::any(simd, &self.tree, rays, hits));
    }
}

impl<P: Triangles> Caster for WideBvh<P> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        Self::closest_hit(self, ray)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        Self::any_hit(self, ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.triangles.surface(ray, hit)
    }

    fn bounds(&self) -> Aabb {
        Self::bounds(self)
    }
}
