use std::{
    sync::atomic::{AtomicU64, Ordering::Relaxed},
    time::Instant,
};

use hitscan::{
    Hit, Ray,
    accel::Entries,
    geometry::{Aabb, Bundle, Pencil},
    primitives::Surface,
    query::ItemBuffer,
    render::{Caster, Material},
};

/// The most reflections that can be told apart, and one for the camera's own rays.
pub const DEPTHS: usize = 17;

/// Of so many queries of a thread one is timed. A prime, so that it does not fall into step with the samples of a pixel.
const SAMPLED: u64 = 61;

/// A scene that counts the rays cast at it and times some of them: a decorator, so that nobody else pays.
#[derive(Debug)]
pub struct Counted<'a, S: ?Sized> {
    scene: &'a S,
    /// One per thread of the pool, so that no thread waits for another's counts.
    counters: Vec<Counter>,
}

/// The counts of one thread, alone on its cache lines.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Counter {
    closest: [AtomicU64; DEPTHS],
    any: [AtomicU64; DEPTHS],
    queries: AtomicU64,
    sampled: AtomicU64,
    nanoseconds: AtomicU64,
    /// Queries for many rays at once, each of which is timed.
    pencils: AtomicU64,
    pencil_nanoseconds: AtomicU64,
}

/// What was counted, over all threads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Rays by depth: those of the camera, then those reflected so often.
    pub closest: [u64; DEPTHS],
    /// Shadow rays by depth.
    pub shadow: [u64; DEPTHS],
    /// Seconds spent in all queries, over all threads, estimated from the sampled ones.
    pub seconds: f64,
}

impl Tally {
    /// All rays.
    pub fn rays(&self) -> u64 {
        self.closest.iter().chain(&self.shadow).sum()
    }

    /// Adds what was counted elsewhere.
    pub fn add(&mut self, other: &Self) {
        for depth in 0..DEPTHS {
            self.closest[depth] += other.closest[depth];
            self.shadow[depth] += other.shadow[depth];
        }
        self.seconds += other.seconds;
    }
}

impl<'a, S: ?Sized> Counted<'a, S> {
    /// The scene, asked by `threads` threads of a rayon pool.
    pub fn new(scene: &'a S, threads: usize) -> Self {
        Self { scene, counters: (0..threads.max(1)).map(|_| Counter::default()).collect() }
    }

    /// What was counted so far.
    pub fn tally(&self) -> Tally {
        let mut tally = Tally::default();
        let clock = clock_nanoseconds();
        for counter in &self.counters {
            for depth in 0..DEPTHS {
                tally.closest[depth] += counter.closest[depth].load(Relaxed);
                tally.shadow[depth] += counter.any[depth].load(Relaxed);
            }
            let Counter { queries, sampled, nanoseconds, pencils, pencil_nanoseconds, .. } = counter;
            let [queries, sampled, nanoseconds, pencils, pencil_nanoseconds] =
                [queries, sampled, nanoseconds, pencils, pencil_nanoseconds].map(|cell| cell.load(Relaxed) as f64);
            if sampled > 0.0 {
                let mean = (nanoseconds / sampled - clock).max(0.0);
                tally.seconds += mean * queries * 1.0e-9;
            }
            tally.seconds += (pencil_nanoseconds - pencils * clock).max(0.0) * 1.0e-9;
        }
        tally
    }

    /// The counter of this thread.
    fn counter(&self) -> &Counter {
        &self.counters[rayon::current_thread_index().unwrap_or(0) % self.counters.len()]
    }

    fn counted<T>(&self, kind: impl Fn(&Counter) -> &[AtomicU64; DEPTHS], depth: u32, query: impl FnOnce() -> T) -> T {
        let counter = self.counter();
        add(&kind(counter)[(depth as usize).min(DEPTHS - 1)], 1);
        if !add(&counter.queries, 1).is_multiple_of(SAMPLED) {
            return query();
        }
        timed(&counter.sampled, &counter.nanoseconds, query)
    }
}

/// A query, one more whose time is taken.
fn timed<T>(count: &AtomicU64, nanoseconds: &AtomicU64, query: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let answer = query();
    let elapsed = begun.elapsed().as_nanos() as u64;
    add(count, 1);
    add(nanoseconds, elapsed);
    answer
}

/// Adds to a cell that only this thread writes, without the price of an atomic addition; what was there before.
fn add(cell: &AtomicU64, more: u64) -> u64 {
    let before = cell.load(Relaxed);
    cell.store(before + more, Relaxed);
    before
}

/// What reading the clock twice takes, which is not the queries' fault.
fn clock_nanoseconds() -> f64 {
    const READINGS: u32 = 1000;
    let total: u128 = (0..READINGS).map(|_| Instant::now().elapsed().as_nanos()).sum();
    total as f64 / f64::from(READINGS)
}

impl<S: Caster + ?Sized> Caster for Counted<'_, S> {
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit> {
        self.counted(|counter| &counter.closest, depth, || self.scene.closest_hit(ray, depth))
    }

    /// Looked for once a tile, and no ray: not counted.
    fn enter(&self, bundle: &Bundle) -> Entries {
        self.scene.enter(bundle)
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.counted(|counter| &counter.closest, 0, || self.scene.closest_hit_from(entries, ray))
    }

    /// Counted are rays that are answered; time passes in any case.
    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        let counter = self.counter();
        let query = || self.scene.closest_hits(pencil, hits);
        let is_done = timed(&counter.pencils, &counter.pencil_nanoseconds, query);
        if is_done {
            add(&counter.closest[0], u64::from(pencil.columns() * pencil.rows()));
        }
        is_done
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.counted(|counter| &counter.any, depth, || self.scene.any_hit(ray, depth))
    }

    fn any_hit_near(&self, ray: &Ray, depth: u32, last: &mut Option<u32>) -> bool {
        self.counted(|counter| &counter.any, depth, || self.scene.any_hit_near(ray, depth, last))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.scene.surface(ray, hit)
    }

    fn material(&self, hit: &Hit, surface: &Surface) -> Option<Material> {
        self.scene.material(hit, surface)
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }
}

#[cfg(test)]
mod tests {
    use hitscan::{
        glam::Vec3,
        render::{Camera, Renderer, Tile},
    };

    use super::*;

    struct Nothing;

    impl Caster for Nothing {
        fn closest_hit(&self, _: &Ray, _: u32) -> Option<Hit> {
            None
        }
        /// Tiles in the left half of a picture.
        fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
            *hits = ItemBuffer::new();
            pencil.ray(0, 0).direction.x < 0.0
        }
        fn any_hit(&self, _: &Ray, _: u32) -> bool {
            false
        }
        fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
            Surface::facing(ray, hit.t)
        }
        fn bounds(&self) -> Aabb {
            Aabb::EMPTY
        }
    }

    #[test]
    fn every_ray_is_counted_once() {
        let counted = Counted::new(&Nothing, 2);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        pool.broadcast(|_| {
            for depth in 0..3 {
                (0..100).for_each(|_| assert!(counted.closest_hit(&ray, depth).is_none()));
            }
            assert!(counted.closest_hit_from(&Entries::everything(Aabb::EMPTY), &ray).is_none());
            assert!(!counted.any_hit(&ray, 99));
            assert!(!counted.any_hit_near(&ray, 99, &mut None));
        });
        let tally = counted.tally();
        assert_eq!(tally.closest[..4], [202, 200, 200, 0]);
        assert_eq!((tally.shadow[DEPTHS - 1], tally.rays()), (4, 606));
    }

    /// Some are asked for at once, some by themselves: it is the same number.
    #[test]
    fn rays_of_tiles_are_counted_once() {
        let camera = Camera::pinhole(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0);
        for samples in [1, 2, 3] {
            let counted = Counted::new(&Nothing, 1);
            let renderer = Renderer::new(&counted, camera, 36, 20).with_samples(samples);
            renderer.fill(Tile { x: 0, y: 0, width: 36, height: 20 }, &mut [Vec3::ZERO; 36 * 20]).unwrap();
            let tally = counted.tally();
            assert_eq!(tally.rays(), u64::from(36 * 20 * samples * samples));
            let at_once = counted.counters[0].pencils.load(Relaxed);
            assert!(at_once > 0 && counted.counters[0].queries.load(Relaxed) < tally.rays());
        }
    }
}
