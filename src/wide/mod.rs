//! The fastest structure on hosts (feature `std`): a BVH whose nodes hold eight boxes and whose leaves up to eight triangles,
//! tested at a time.
//!
//! It returns what the others return, bit for bit: boxes are met by the rules R1, R2 and R4 of ARCHITECTURE.md, in `f32`
//! without fused products; triangles are tested by the first tier of the certified test in eight lanes, and what that leaves
//! open by the others. Nodes are 256 bytes, the boxes by coordinate (Ernst and Greiner, *Multi bounding volume hierarchies*,
//! 2008; Wald, Benthin and Boulos, *Getting rid of packets*, 2008); blocks keep the corners that their triangles share once.
//!
//! Which instructions are used is found out when a structure is built; all give the same bits.

mod batch;
mod binary;
mod block;
mod build;
mod coherence;
mod collapse;
mod gait;
mod hull;
mod node;
mod packet;
mod permute;
mod simd;
mod slabs;
mod stack;
mod tree;
mod walk;

#[cfg(test)]
mod tests;

use std::{convert::Infallible, ops::ControlFlow};

use fearless_simd::{Level, dispatch};

use self::{build::Monitor, node::Child, tree::Tree};
pub use self::{
    build::{Options, Progress},
    coherence::Coherence,
    simd::Simd,
};

use crate::{
    error::BuildError,
    geometry::{Aabb, Ray},
    primitives::{Hit, Surface, Triangles},
    render::Caster,
};

/// The most triangles.
const MAX_TRIANGLES: u32 = 1 << 26;

/// So many always have room, even if there are two references to each and no corner is shared.
const SURE_TRIANGLES: u32 = 1 << 24;

const _: () = assert!(2 * SURE_TRIANGLES as usize * block::words(3, 1) <= Child::MAX_WORDS);

/// A BVH of eight boxes a node and up to eight triangles a block, over a copy of the triangles: about 35 bytes each where they share corners.
///
/// ```
/// use hitscan::{Mesh, Ray, glam::Vec3, wide::{Options, WideBvh}};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let wide = WideBvh::new(&mesh, &Options::balanced())?;
/// let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
/// assert_eq!(wide.closest_hit(&ray).unwrap().t, 1.0);
///
/// // Many rays are faster together.
/// let mut hits = [None; 2];
/// wide.closest_hits(&[ray, ray.up_to(0.5)], &mut hits);
/// assert!(hits[0].is_some() && hits[1].is_none());
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct WideBvh<P> {
    tree: Tree,
    level: Level,
    coherence: Coherence,
    triangles: P,
}

impl<P: Triangles + Sync> WideBvh<P> {
    /// Builds it over `triangles`, on the threads of the current `rayon` pool.
    ///
    /// # Errors
    ///
    /// [`BuildError::Bounds`] names the first triangle that is not finite or beyond 2^126, and [`BuildError::TooMany`] says
    /// that there are more than 2^26, or more than 2^24 that share too few corners.
    pub fn new(triangles: P, options: &Options) -> Result<Self, BuildError> {
        let ControlFlow::Continue(built) =
            Self::new_with(triangles, options, |_| ControlFlow::<Infallible>::Continue(()))?;
        Ok(built)
    }

    /// As [`new`](Self::new); `tell` hears of progress, from any thread, and may break it off: then its reason comes back.
    ///
    /// ```
    /// use std::{convert::Infallible, ops::ControlFlow};
    /// use hitscan::{Mesh, glam::Vec3, wide::{Options, WideBvh}};
    /// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// let built = WideBvh::new_with(&mesh, &Options::best(), |progress| {
    ///     if progress.total > 1_000_000 { ControlFlow::Break("too much work") } else { ControlFlow::Continue(()) }
    /// })?;
    /// assert!(built.is_continue());
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn new_with<B: Send>(
        triangles: P,
        options: &Options,
        tell: impl Fn(Progress) -> ControlFlow<B> + Sync,
    ) -> Result<ControlFlow<B, Self>, BuildError> {
        let count = triangles.len();
        if count > MAX_TRIANGLES {
            return Err(BuildError::TooMany { limit: MAX_TRIANGLES });
        }
        let monitor = Monitor::new(&tell);
        // Packing comes last.
        monitor.expect(count);
        let tree = match build::build(&triangles, options, &monitor)? {
            ControlFlow::Continue(binary) => {
                collapse::collapse(&binary, options.byte_price, count, |number| triangles.triangle(number), &monitor)
            }
            ControlFlow::Break(reason) => ControlFlow::Break(reason),
        };
        let mut tree = match tree {
            ControlFlow::Continue(tree) => tree.ok_or(BuildError::TooMany { limit: SURE_TRIANGLES })?,
            ControlFlow::Break(reason) => return Ok(ControlFlow::Break(reason)),
        };
        tree.sides = triangles.sides();
        if (0..count).any(|index| triangles.mask(index) != u32::MAX) {
            tree.masks = (0..count).map(|index| triangles.mask(index)).collect();
        }
        Ok(ControlFlow::Continue(Self { tree, level: Level::new(), coherence: Coherence::Measured, triangles }))
    }
}

impl<P: Triangles> WideBvh<P> {
    /// The same, asked by these instructions; as before, if this machine does not have them.
    #[must_use]
    pub fn with_simd(self, simd: Simd) -> Self {
        Self { level: simd.level().unwrap_or(self.level), ..self }
    }

    /// The same, whose batches are of such rays.
    #[must_use]
    pub fn with_coherence(self, coherence: Coherence) -> Self {
        Self { coherence, ..self }
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

    /// The first hits of all rays, as far as there is room for them: what [`closest_hit`](Self::closest_hit) says of each.
    ///
    /// Rays whose neighbours go the same way, as a camera's do tile by tile, walk in packets of up to 64; others in turns, so that
    /// while one waits for memory the others do not. Hand over some hundreds or thousands at a time, nearest neighbours next to
    /// each other: tiles of 8 by 8 rather than rows.
    pub fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        dispatch!(self.level, simd => gait::closest(simd, &self.tree, self.coherence, rays, hits));
    }

    /// Whether the rays hit anything, as far as there is room for it; see [`closest_hits`](Self::closest_hits).
    pub fn any_hits(&self, rays: &[Ray], hits: &mut [bool]) {
        dispatch!(self.level, simd => gait::any(simd, &self.tree, self.coherence, rays, hits));
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
