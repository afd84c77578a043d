use super::start_of;
use crate::{
    accel::{Accelerator, Entries},
    geometry::{Pencil, PreparedRay, Ray, beyond},
    math::greatest,
    primitives::{Hit, Primitives, Span},
    scene::Scene,
};

/// The first hits of a [`Pencil`]'s rays, in 512 bytes.
///
/// Weghorst, Hooper and Greenberg, *Improved computational methods for ray tracing*, 1984.
#[derive(Clone, Debug)]
pub struct ItemBuffer([Hit; RAYS]);

/// As many as a pencil has.
const RAYS: usize = (Pencil::SIDE * Pencil::SIDE) as usize;

/// What no primitive has as its number.
const NOTHING: Hit = Hit { t: f32::MAX, primitive: u32::MAX };

/// How many of the triangles tested last are remembered.
const RECENT: usize = 32;

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

    /// Asks for the first hit of each ray by itself.
    pub fn fill(&mut self, pencil: &Pencil, closest_hit: impl Fn(&Ray) -> Option<Hit>) {
        for (row, hits) in (0..pencil.rows()).zip(self.0.chunks_mut(Pencil::SIDE as usize)) {
            for (column, hit) in (0..pencil.columns()).zip(hits) {
                *hit = closest_hit(&pencil.ray(column, row)).unwrap_or(NOTHING);
            }
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
    /// The first hits of all rays of a pencil, each that of [`closest_hit`](Self::closest_hit).
    ///
    /// A kD-tree is walked once for all of them, and of each triangle that is met there, the rays that may hit it are found at
    /// once. Other structures, and shapes that are no triangles, are asked ray by ray.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Scene, glam::Vec3};
    /// # let vertices = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// use hitscan::{query::ItemBuffer, render::{Camera, Tile}};
    /// let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
    /// let pencil = camera.pencil(&Tile { x: 28, y: 20, width: 8, height: 8 }, 64, 48).unwrap();
    /// let mut hits = ItemBuffer::new();
    /// scene.closest_hits(&pencil, &mut hits);
    /// assert_eq!(hits.get(3, 5), scene.closest_hit(&pencil.ray(3, 5)));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    pub fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) {
        if !self.sweep(pencil, hits) {
            self.one_by_one(pencil, hits);
        }
    }

    /// Ray by ray, from where they may begin.
    #[inline(never)] // What one way keeps on the stack is not there in the other.
    fn one_by_one(&self, pencil: &Pencil, hits: &mut ItemBuffer) {
        let bundle = pencil.bundle();
        let entries = bundle.map_or_else(|| Entries::everything(self.bounds()), |bundle| self.enter(&bundle));
        hits.fill(pencil, |ray| self.closest_hit_from(&entries, ray));
    }

    /// All rays at once; false if that cannot be done.
    #[inline(never)]
    fn sweep(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        let Some(bundle) = pencil.bundle() else { return false };
        *hits = ItemBuffer::new();
        let all = pencil.all();
        let (mut missing, mut end) = (all.count_ones(), f32::INFINITY);
        let (mut recent, mut are_triangles) = ([u32::MAX; RECENT], true);
        let walked = self.accelerator().sweep(&bundle, |leaf| {
            let mut is_changed = false;
            for index in leaf {
                match recent.get_mut(index as usize % RECENT) {
                    Some(place) if *place != index => *place = index,
                    _ => continue,
                }
                let Some(outline) = self.primitives().outline(index) else {
                    are_triangles = false;
                    return f32::NEG_INFINITY;
                };
                let mut begin = None;
                let mut rays = pencil.candidates(&outline);
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
                    let prepared = PreparedRay::here(&pencil.ray(number % Pencil::SIDE, number / Pencil::SIDE));
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
        walked && are_triangles
    }
}
