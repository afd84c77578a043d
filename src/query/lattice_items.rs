use super::ItemBuffer;
use crate::{
    accel::{LatticeAccelerator, LatticeWalk},
    geometry::{Depth, LatticePath, LatticePencil, Pencil},
    lattice_scene::LatticeScene,
    primitives::{Hit, LatticeTriangles},
};

/// How many of the triangles tested last are remembered.
const RECENT: usize = 32;

/// Triangles after which it is asked whether rays may hit half of them: where triangles are smaller than pixels, walks ray by
/// ray see fewer.
const PATIENCE: u32 = 48;

impl<A: LatticeAccelerator, P: LatticeTriangles> LatticeScene<A, P> {
    /// The first hits of all rays of a pencil, each that of [`closest_hit`](Self::closest_hit); false if they are to be asked
    /// for one by one.
    ///
    /// The structure is walked once for all of them, and of each triangle that is met there, the rays that may hit it are found at
    /// once, all in whole numbers. Where triangles are smaller than pixels, or the rays have not one major axis, it is not.
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
    pub fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        *hits = ItemBuffer::new();
        let rays = self.space().pencil(pencil);
        let Some(rays) = &rays else { return false };
        self.sweep(pencil, rays, hits) && {
            for (ray, hit) in (0..).zip(&mut hits.0) {
                if hit.primitive != u32::MAX {
                    hit.t = self.space().parameter(rays, &ray_of(pencil, ray), hit.t.to_bits() as i32);
                }
            }
            true
        }
    }

    /// The first hits, each with its depth as the bits of `t`; whether they are found.
    #[inline(never)]
    fn sweep(&self, pencil: &Pencil, rays: &LatticePencil, hits: &mut ItemBuffer) -> bool {
        let (first, last) = rays.inside();
        if first > last {
            return true;
        }
        let all = pencil.all();
        let (mut missing, mut end) = (all, i32::from(last));
        let (mut met, mut tests) = (0, 0);
        let mut recent = [u32::MAX; RECENT];
        let mut walk = self.accelerator().walk();
        while let Some(leaf) = walk.next_leaf(rays, end) {
            let mut is_changed = false;
            for index in leaf {
                match recent.get_mut(index as usize % RECENT) {
                    Some(place) if *place != index => *place = index,
                    _ => continue,
                }
                let Some(corners) = self.visible(index, u32::MAX) else { continue };
                let mut candidates = rays.projection.candidates(corners) & all;
                (met, tests) = (met + 1, tests + candidates.count_ones());
                if met > PATIENCE && tests < met / 2 {
                    return false;
                }
                let nearest = rays.nearest(corners);
                while candidates != 0 {
                    let number = candidates.trailing_zeros();
                    candidates &= candidates - 1;
                    let Some(best) = hits.0.get_mut(number as usize) else { continue };
                    let (from, until) = rays.depths();
                    let until = if best.primitive == u32::MAX { until } else { best.t.to_bits() as i32 };
                    if nearest > until {
                        continue;
                    }
                    let sight = self.space().sight(rays, &ray_of(pencil, number));
                    let Some(sight) = &sight else { continue };
                    if !rays.is_along(sight) {
                        return false;
                    }
                    if let Some(Depth { depth, front }) = sight.crossing(corners)
                        && self.shows(front)
                        && from <= depth
                        && depth <= until
                    {
                        let primitive = self.triangles().number(index);
                        if depth < until || primitive < best.primitive {
                            missing &= !(1 << number);
                            *best = Hit { t: f32::from_bits(depth as u32), primitive };
                            is_changed = true;
                        }
                    }
                }
            }
            if is_changed && missing == 0 {
                let deepest = hits.0.iter().filter(|hit| hit.primitive != u32::MAX).map(|hit| hit.t.to_bits());
                end = deepest.fold(0, u32::max) as i32 >> 8;
            }
        }
        true
    }
}

/// The ray of a bit.
fn ray_of(pencil: &Pencil, number: u32) -> crate::geometry::Ray {
    pencil.ray(number % Pencil::SIDE, number / Pencil::SIDE)
}
