use super::{recent::Recent, start_of};
use crate::{
    accel::Accelerator,
    geometry::{Pencil, PreparedRay, beyond},
    math::greatest,
    primitives::{Hit, Primitives, Span},
    scene::Scene,
};

/// The first hits of a [`Pencil`]'s rays, in 512 bytes.
///
/// Weghorst, Hooper and Greenberg, *Improved computational methods for ray tracing*, 1984.
#[derive(Clone, Debug)]
pub struct ItemBuffer(pub(super) [Hit; RAYS]);

/// As many as a pencil has.
const RAYS: usize = (Pencil::SIDE * Pencil::SIDE) as usize;

/// What no primitive has as its number.
const NOTHING: Hit = Hit { t: f32::MAX, primitive: u32::MAX };

/// Triangles after which it is asked whether rays may hit half of them: where triangles are smaller than pixels, walks ray by
/// ray see fewer.
const PATIENCE: u32 = 128;

impl ItemBuffer {
    /// Of rays that hit nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self([NOTHING; RAYS])
    }

    /// The first hit of the ray in a column and a row.
    #[inline]
    #[must_use]
    pub fn get(&self, column: u32, row: u32) -> Option<Hit> {
        let hit = *self.0.chunks(Pencil::SIDE as usize).nth(row as usize)?.get(column as usize)?;
        (hit.primitive != u32::MAX).then_some(hit)
    }

    /// Gives the ray in a column and a row this hit if it comes before its own: one with something else than was asked.
    ///
    /// ```
    /// use hitscan::{Hit, query::ItemBuffer};
    /// let mut hits = ItemBuffer::new();
    /// hits.offer(3, 5, Hit { t: 2.0, primitive: 7 });
    /// hits.offer(3, 5, Hit { t: 2.0, primitive: 8 });
    /// assert_eq!(hits.get(3, 5), Some(Hit { t: 2.0, primitive: 7 }));
    /// ```
    pub fn offer(&mut self, column: u32, row: u32, hit: Hit) {
        let row = self.0.chunks_mut(Pencil::SIDE as usize).nth(row as usize);
        if let Some(own) = row.and_then(|row| row.get_mut(column as usize))
            && hit.precedes(own)
        {
            *own = hit;
        }
    }

    /// The parameter behind which nothing matters to any of these rays.
    fn end(&self, rays: u64) -> f32 {
        let hits = self.0.iter().enumerate().filter(|(ray, _)| rays >> ray & 1 != 0);
        hits.fold(0.0, |last, (_, hit)| greatest(hit.t, last))
    }
}

impl Default for ItemBuffer {
    fn default() -> Self {
        Self::new()
    }
}

impl<A: Accelerator, P: Primitives> Scene<A, P> {
    /// The first hits of all rays of a pencil, each that of [`closest_hit`](Self::closest_hit); false if they are to be asked
    /// for one by one, and what is in `hits` then means nothing.
    ///
    /// A tree is walked once for all of them, and of each triangle that is met there, the rays that may hit it are found at
    /// once. Grids, and shapes that are no triangles or smaller than pixels, are not asked so.
    ///
    /// ```
    /// # use hitscan::{Arena, KdTree, Mesh, Scene, glam::Vec3, kdtree::Options};
    /// # let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let mut memory = vec![0; KdTree::words(1, &Options::balanced())];
    /// # let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Options::balanced())?;
    /// # let scene = Scene::new(tree, &mesh)?;
    /// use hitscan::{query::ItemBuffer, render::{Camera, Tile}};
    /// let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
    /// let pencil = camera.pencil(&Tile { x: 28, y: 20, width: 8, height: 8 }, 64, 48).unwrap();
    /// let mut hits = ItemBuffer::new();
    /// assert!(scene.closest_hits(&pencil, &mut hits));
    /// assert_eq!(hits.get(3, 5), scene.closest_hit(&pencil.ray(3, 5)));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    // Not in the caller's frame, which is still there if the rays are then cast one by one.
    #[inline(never)]
    pub fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        let Some(bundle) = pencil.bundle() else { return false };
        *hits = ItemBuffer::new();
        let all = pencil.all();
        let (mut missing, mut end) = (all.count_ones(), f32::INFINITY);
        let (mut met, mut tests, mut is_done) = (0, 0, true);
        let mut recent = Recent::default();
        let walked = self.accelerator().sweep(&bundle, |leaf| {
            let mut is_changed = false;
            for index in leaf {
                if recent.knows(index) {
                    continue;
                }
                let Some(outline) = self.primitives().outline(index) else {
                    is_done = false;
                    return f32::NEG_INFINITY;
                };
                let mut begin = None;
                let mut rays = pencil.candidates(&outline);
                (met, tests) = (met + 1, tests + rays.count_ones());
                if met > PATIENCE && tests < met / 2 {
                    is_done = false;
                    return f32::NEG_INFINITY;
                }
                while rays != 0 {
                    let number = rays.trailing_zeros();
                    rays &= rays - 1;
                    let Some(best) = hits.0.get_mut(number as usize % RAYS) else { continue };
                    // What is hit of the triangle is hit within its bounds.
                    if best.primitive != u32::MAX
                        && *begin.get_or_insert_with(|| bundle.entry(&outline.bounds()).unwrap_or(f32::INFINITY))
                            > beyond(best.t)
                    {
                        continue;
                    }
                    let prepared = PreparedRay::here(&pencil.numbered(number));
                    let Some(ray) = prepared.as_ref() else { continue };
                    if let Some(hit) = self.intersect(index, ray, Span::new(start_of(ray), *best)) {
                        missing -= u32::from(best.primitive == u32::MAX);
                        *best = hit;
                        is_changed = true;
                    }
                }
            }
            if is_changed && missing == 0 {
                end = beyond(hits.end(all));
            }
            end
        });
        walked && is_done
    }
}
