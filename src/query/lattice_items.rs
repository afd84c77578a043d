use super::{ItemBuffer, recent::Recent};
use crate::{
    accel::{LatticeAccelerator, LatticeWalk},
    geometry::{Depth, LatticePath, LatticePencil, Pencil, Sight},
    lattice_scene::LatticeScene,
    primitives::{Hit, LatticeTriangles},
};

/// Triangles after which it is asked whether rays may hit a quarter of them: where triangles are much smaller than pixels, walks
/// ray by ray see fewer.
const PATIENCE: u32 = 256;

impl<A: LatticeAccelerator, P: LatticeTriangles> LatticeScene<A, P> {
    /// The first hits of all rays of a pencil, each that of [`closest_hit`](Self::closest_hit); false if they are to be asked
    /// for one by one, and what is in `hits` then means nothing.
    ///
    /// The structure is walked once for all of them, and of each triangle that is met there, the rays that may hit it are found at
    /// once, all in whole numbers. Where triangles are much smaller than pixels, or the rays have not one major axis, it is not.
    ///
    /// ```
    /// # use hitscan::{LatticeMesh, LatticeScene, List, geometry::Aabb, glam::Vec3};
    /// # let frame = Aabb::new(Vec3::ZERO, Vec3::ONE);
    /// # let vertices = [[0, 0, 30_000], [60_000, 0, 30_000], [0, 60_000, 30_000]];
    /// # let mesh = LatticeMesh::new(&frame, &vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = LatticeScene::new(List::new(&mesh)?, &mesh)?;
    /// use hitscan::{query::ItemBuffer, render::{Camera, Tile}};
    /// let camera = Camera::framing(&frame, Vec3::Z, Vec3::Y);
    /// let pencil = camera.pencil(&Tile { x: 24, y: 16, width: 8, height: 8 }, 64, 48).unwrap();
    /// let mut hits = ItemBuffer::new();
    /// assert!(scene.closest_hits(&pencil, &mut hits));
    /// assert_eq!(hits.get(3, 5), scene.closest_hit(&pencil.ray(3, 5)));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[inline(never)] // What it takes is given back before rays go one by one.
    pub fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        *hits = ItemBuffer::new();
        let rays = self.space().pencil(pencil);
        let Some(rays) = &rays else { return false };
        let is_found = self.sweep(pencil, rays, hits);
        if is_found {
            self.finish(pencil, rays, hits);
        }
        is_found
    }

    /// Puts parameters in place of depths.
    #[inline(never)]
    fn finish(&self, pencil: &Pencil, rays: &LatticePencil, hits: &mut ItemBuffer) {
        for (ray, hit) in (0..).zip(&mut hits.0) {
            if hit.primitive != u32::MAX {
                hit.t = self.space().parameter(rays, &pencil.numbered(ray), hit.t.to_bits() as i32);
            }
        }
    }

    /// The first hits, each with its depth as the bits of `t`; whether they are found.
    #[inline(never)]
    fn sweep(&self, pencil: &Pencil, rays: &LatticePencil, hits: &mut ItemBuffer) -> bool {
        let (first, last) = rays.inside();
        if first > last {
            return true;
        }
        let (mut end, mut met, mut tests) = (i32::from(last), 0, 0);
        let mut recent = Recent::default();
        let mut walk = self.accelerator().walk();
        while let Some(leaf) = walk.next_leaf(rays, end) {
            let mut is_changed = false;
            for index in leaf {
                if recent.knows(index) {
                    continue;
                }
                let Some(corners) = self.visible(index, u32::MAX) else { continue };
                let candidates = rays.projection.candidates(corners) & pencil.all();
                (met, tests) = (met + 1, tests + candidates.count_ones());
                if met > PATIENCE && tests < met / 4 {
                    return false;
                }
                if candidates != 0 {
                    let Some(changes) = self.offer(pencil, rays, (index, candidates), hits) else { return false };
                    is_changed |= changes;
                }
            }
            if is_changed {
                end = hits.deepest(pencil.all()).map_or(end, |depth| depth >> 8);
            }
        }
        true
    }

    /// Tests a triangle for the rays that may hit it; whether it is the first hit of any, or none if that cannot be told.
    #[inline(never)] // Not within the walk: each would keep the other's numbers on the stack.
    fn offer(
        &self,
        pencil: &Pencil,
        rays: &LatticePencil,
        (index, mut candidates): (u32, u64),
        hits: &mut ItemBuffer,
    ) -> Option<bool> {
        let nearest = rays.nearest(self.visible(index, u32::MAX)?);
        let (number, mut is_changed) = (self.triangles().number(index), false);
        while candidates != 0 {
            let ray = candidates.trailing_zeros();
            candidates &= candidates - 1;
            let Some(best) = hits.0.get_mut(ray as usize) else { continue };
            let (from, until) = rays.depths();
            let until = if best.primitive == u32::MAX { until } else { best.t.to_bits() as i32 };
            if nearest > until {
                continue;
            }
            let sight = self.space().sight(rays, pencil, ray);
            let Some(sight) = &sight else { continue };
            if !rays.is_along(sight) {
                return None;
            }
            if let Some(Depth { depth, front }) = self.seen(index, sight)
                && self.shows(front)
                && from <= depth
                && (depth < until || (depth == until && number < best.primitive))
            {
                *best = Hit { t: f32::from_bits(depth as u32), primitive: number };
                is_changed = true;
            }
        }
        Some(is_changed)
    }

    /// Where a ray crosses a triangle.
    #[inline(never)]
    fn seen(&self, index: u32, sight: &Sight) -> Option<Depth> {
        sight.crossing(self.visible(index, u32::MAX)?)
    }
}

impl ItemBuffer {
    /// The greatest depth of any of these rays' hits; none if not all of them hit something.
    fn deepest(&self, rays: u64) -> Option<i32> {
        let mut deepest = 0;
        for (ray, hit) in self.0.iter().enumerate() {
            if rays >> ray & 1 != 0 {
                if hit.primitive == u32::MAX {
                    return None;
                }
                deepest = deepest.max(hit.t.to_bits() as i32);
            }
        }
        Some(deepest)
    }
}
