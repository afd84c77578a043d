use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicU32, Ordering},
    vec,
    vec::Vec,
};

use glam::Vec3;

use super::{LEAF, MAX_DEPTH, Monitor, Options, Progress, build};
use crate::{
    accel::List,
    error::BuildError,
    geometry::{Aabb, PreparedRay, Ray},
    primitives::{Hit, Mesh, Primitives, Span, from_fn},
    scene::Scene,
    testing::Random,
    wide::binary::Binary,
};

/// Triangles with corners of their own.
struct Soup(Vec<Vec3>, Vec<[u32; 3]>);

impl Soup {
    fn new(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let corners: Vec<Vec3> = triangles.into_iter().flatten().collect();
        let numbers = (0..corners.len() as u32 / 3).map(|i| [0, 1, 2].map(|corner| i * 3 + corner)).collect();
        Self(corners, numbers)
    }

    /// `count` triangles in a cube, of edges up to `size`.
    fn random(count: usize, size: f32) -> Self {
        let mut random = Random::new(count as u64);
        let mut point = move || Vec3::new(random.unit(), random.unit(), random.unit());
        Self::new((0..count).map(|_| {
            let a = point();
            [a, a + (point() - 0.5) * size, a + (point() - 0.5) * size]
        }))
    }

    fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.0, &self.1[..]).unwrap()
    }
}

fn presets() -> [Options; 3] {
    [Options::fast(), Options::balanced(), Options::best()]
}

fn try_build<P: Primitives + Sync>(
    primitives: &P,
    options: &Options,
    tell: impl Fn(Progress) -> ControlFlow<()> + Sync,
) -> Result<ControlFlow<(), Binary>, BuildError> {
    build(primitives, options, &Monitor::new(&tell))
}

fn built<P: Primitives + Sync>(primitives: &P, options: &Options) -> Binary {
    try_build(primitives, options, |_| ControlFlow::Continue(())).unwrap().continue_value().unwrap()
}

/// What a walk over everything finds: the depth, and the sum over all divisions of the references divided.
#[derive(Debug)]
struct Shape {
    depth: u32,
    work: u64,
}

fn contains(outer: &Aabb, inner: &Aabb) -> bool {
    outer.contains(inner.min) && outer.contains(inner.max)
}

/// Demands what whoever collapses it relies on.
fn check<P: Primitives>(binary: &Binary, primitives: &P, options: &Options) -> Shape {
    let Binary { nodes, references } = binary;
    let mut shape = Shape { depth: 0, work: 0 };
    let mut depths = vec![0; nodes.len()];
    let (mut next_pair, mut next_reference) = (1, 0);
    let mut times = vec![0; primitives.len() as usize];
    let mut pending = vec![0; nodes.len().min(1)];
    while let Some(place) = pending.pop() {
        let node = &nodes[place];
        let first = node.first();
        shape.depth = shape.depth.max(depths[place]);
        if node.count() > 0 {
            assert!(node.count() <= LEAF as usize && first == next_reference, "{node:?}");
            next_reference += node.count();
            shape.work += node.count() as u64 * u64::from(depths[place]);
            for &number in &references[first..next_reference] {
                times[number as usize] += 1;
                let bounds = primitives.bounds(number);
                let is_cut = options.references > 1.0 && primitives.is_certified(number);
                let met = if is_cut {
                    primitives.clip(number, &node.hull().bounds()).is_some()
                } else {
                    contains(&node.hull().bounds(), &bounds)
                };
                assert!(met, "{number} in {node:?}");
            }
        } else {
            // Depth first, so that pairs come in order.
            assert_eq!(first, next_pair);
            next_pair += 2;
            for child in [first, first + 1] {
                assert!(contains(&node.hull().bounds(), &nodes[child].hull().bounds()));
                depths[child] = depths[place] + 1;
            }
            pending.extend([first + 1, first]);
        }
    }
    assert_eq!(nodes.len(), if primitives.is_empty() { 0 } else { next_pair });
    assert_eq!(references.len(), next_reference);
    let most = if options.references > 1.0 { u32::MAX } else { 1 };
    assert!(times.iter().all(|&times| 0 < times && times <= most));
    assert!(references.len() as f32 <= (primitives.len() as f32 * options.references).max(primitives.len() as f32));
    assert!(shape.depth <= MAX_DEPTH, "{shape:?}");
    shape
}

/// The closest hit, by a plain walk; and how many nodes and primitives it looked at.
fn closest<P: Primitives>(binary: &Binary, primitives: &P, ray: &PreparedRay, work: &mut [u64; 2]) -> Option<Hit> {
    let start = Hit { t: ray.ray().t_min, primitive: 0 };
    let mut end = Hit { t: ray.ray().t_max, primitive: u32::MAX };
    let mut best = None;
    let mut stack = vec![0];
    while let Some(place) = stack.pop() {
        let node = &binary.nodes[place];
        work[0] += 1;
        if !node.hull().bounds().interval(ray).is_some_and(|(enter, exit)| exit >= start.t && enter <= end.t) {
            continue;
        }
        let first = node.first();
        if node.count() == 0 {
            stack.extend([first, first + 1]);
            continue;
        }
        for &number in &binary.references[first..][..node.count()] {
            work[1] += 1;
            if let Some(hit) = primitives.intersect(number, ray, &Span::new(start, end)) {
                (end, best) = (hit, Some(hit));
            }
        }
    }
    best
}

/// Random rays get the list's answers; what they looked at.
fn answer_alike(binary: &Binary, mesh: &Mesh<'_>, rays: u32) -> [u64; 2] {
    let scene = Scene::new(List::new(mesh).unwrap(), mesh).unwrap();
    let bounds = binary.nodes[0].hull().bounds();
    let mut random = Random::new(5);
    let mut work = [0; 2];
    for _ in 0..rays {
        let mut point = || bounds.min + bounds.size() * Vec3::new(random.unit(), random.unit(), random.unit());
        let ray = Ray::between(point(), point());
        let Some(prepared) = ray.prepare() else { continue };
        assert_eq!(closest(binary, mesh, &prepared, &mut work), scene.closest_hit(&ray), "{ray:?}");
    }
    work
}

/// Sets that lead builders astray.
fn hostile(count: usize) -> Vec<(&'static str, Soup)> {
    let mut random = Random::new(3);
    let mut unit = move || Vec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
    let identical = Soup::new((0..count).map(|_| [Vec3::X, Vec3::Y, Vec3::Z]));
    let through_one = Soup::new((0..count).map(|_| [unit(), unit()]).map(|[a, b]| [a, b, -(a + b)]));
    let series = Soup::new((0..count).map(|i| {
        let scale = f32::from_bits((254 - (i % 250) as u32).min(252) << 23);
        [Vec3::X * scale, Vec3::Y * scale, Vec3::Z * scale]
    }));
    let slivers = Soup::new((0..count).map(|_| [unit(), unit()]).map(|[a, b]| [a, b, b]));
    let Soup(mut corners, numbers) = Soup::random(count, 0.01);
    corners[..3].copy_from_slice(&[Vec3::splat(-1000.0), Vec3::new(1000.0, -1000.0, 0.5), Vec3::splat(1000.0)]);
    let stack = Soup::new((0..count).map(|i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|v| v + Vec3::Z * i as f32)));
    vec![
        ("identical", identical),
        ("through one point", through_one),
        ("series", series),
        ("slivers", slivers),
        ("giant", Soup(corners, numbers)),
        ("stack", stack),
    ]
}

#[test]
fn a_series_deeper_than_the_rules_stays_within_them() {
    // Each division leaves out one of them.
    let size = |i: i32| (2.0_f64.powi(125) / 14.2_f64.powi(i)) as f32;
    for count in [64, 66, 68] {
        let soup = Soup::new((0..count).map(|i| [Vec3::X * size(i); 3]));
        for options in presets().into_iter().chain([Options { few: 6, ..Options::balanced() }]) {
            check(&built(&soup.mesh(), &options), &soup.mesh(), &options);
        }
    }
}

#[test]
fn a_few_primitives() {
    for options in presets() {
        for count in 0..40 {
            let soup = Soup::random(count, 0.5);
            check(&built(&soup.mesh(), &options), &soup.mesh(), &options);
        }
    }
}

#[test]
fn every_knob() {
    let soup = Soup::random(3000, 0.1);
    for few in 0..8 {
        for options in presets() {
            let options = Options { few, ..options };
            check(&built(&soup.mesh(), &options), &soup.mesh(), &options);
        }
    }
    for (bins, few, reinsertions, reinserted, references) in
        [(0, 0, 1, 1.0, 0.0), (99, 99, 1, 99.0, 2.0), (2, 64, 0, -1.0, f32::NAN)]
    {
        let options = Options { bins, few, reinsertions, reinserted, references, ..Options::fast() };
        let binary = built(&soup.mesh(), &options);
        answer_alike(&binary, &soup.mesh(), 20);
    }
}

#[test]
fn answers_are_the_lists() {
    let cuts = Options { reinsertions: 0, references: 2.0, ..Options::best() };
    let soups = [(700, 0.3), (700, 1.5), (3000, 0.02)].map(|(count, size)| Soup::random(count, size));
    for soup in soups.into_iter().chain([slivers(2000)]) {
        for options in presets().into_iter().chain([cuts]) {
            let binary = built(&soup.mesh(), &options);
            check(&binary, &soup.mesh(), &options);
            answer_alike(&binary, &soup.mesh(), 2000);
        }
    }
    let binary = built(&slivers(2000).mesh(), &cuts);
    assert!(binary.references.len() > 2200, "{}", binary.references.len());
}

#[test]
fn rays_look_at_little() {
    let soup = Soup::random(20_000, 0.03);
    let work = presets().map(|options| answer_alike(&built(&soup.mesh(), &options), &soup.mesh(), 300));
    for [nodes, tests] in work {
        assert!(nodes < 300 * 250 && tests < 300 * 60, "{work:?}");
    }
}

/// The work that the surface area heuristic expects of a ray: the surface of all nodes, relative to that of the root.
fn expected_work(binary: &Binary) -> f32 {
    let areas: f32 = binary.nodes.iter().map(|node| node.hull().bounds().half_area()).sum();
    areas / binary.nodes[0].hull().bounds().half_area()
}

/// Long slivers in all directions, whose boxes are mostly empty, among small triangles.
fn slivers(count: usize) -> Soup {
    let Soup(mut corners, numbers) = Soup::random(count, 0.01);
    let mut random = Random::new(9);
    for sliver in corners.chunks_exact_mut(60) {
        let end = Vec3::new(random.unit(), random.unit(), random.unit());
        sliver[1] = end;
        sliver[2] = end + 0.001;
    }
    Soup(corners, numbers)
}

#[test]
fn more_effort_saves_work() {
    let soup = slivers(20_000);
    let works = |options: [Options; 3]| options.map(|options| expected_work(&built(&soup.mesh(), &options)));
    // The same leaves, so that only the way there counts.
    let plain = Options { reinsertions: 0, ..Options::balanced() };
    let [binned, reinserted, cut] = works([plain, Options::balanced(), Options::best()]);
    assert!(reinserted < binned * 0.97, "{binned} {reinserted}");
    assert!(cut < reinserted * 0.9, "{reinserted} {cut}");
}

#[test]
fn cuts_that_do_not_pay_are_not_made() {
    // Small triangles in rows: nothing to cut.
    let soup = Soup::new((0..4000).map(|i| {
        let at = Vec3::new((i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32);
        [at, at + Vec3::X * 0.5, at + Vec3::Y * 0.5]
    }));
    let binary = built(&soup.mesh(), &Options::best());
    assert_eq!(binary.references.len(), 4000);
    assert_eq!(
        expected_work(&binary),
        expected_work(&built(&soup.mesh(), &Options { references: 1.0, ..Options::best() }))
    );
}

#[test]
fn hostile_sets_stay_shallow_and_cheap() {
    for options in presets() {
        let [small, large] = [10_000, 40_000].map(|count| {
            hostile(count).into_iter().map(move |(name, soup)| {
                let binary = built(&soup.mesh(), &options);
                (name, check(&binary, &soup.mesh(), &options))
            })
        });
        for ((name, small), (_, large)) in small.zip(large) {
            assert!(large.work * 10 <= small.work * 56, "{name}: {small:?} {large:?}");
        }
    }
}

#[test]
fn hostile_sets_are_answered() {
    for options in presets() {
        for (name, soup) in hostile(300) {
            if name != "series" {
                answer_alike(&built(&soup.mesh(), &options), &soup.mesh(), 200);
            }
        }
    }
}

#[test]
fn any_number_of_threads_builds_the_same() {
    // Enough for the passes of all threads together.
    let soup = Soup::random(80_000, 0.05);
    for options in presets() {
        let binaries = [1, 2, 3, 7, 64].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| built(&soup.mesh(), &options))
        });
        check(&binaries[0], &soup.mesh(), &options);
        let bits = |binary: &Binary| -> Vec<u32> {
            bytemuck::cast_slice(&binary.nodes).iter().chain(&binary.references).copied().collect()
        };
        let first = bits(&binaries[0]);
        assert!(binaries.iter().all(|binary| bits(binary) == first));
    }
}

#[test]
fn shapes_of_ones_own_are_not_cut() {
    let boxes = |i: u32| {
        let at = Vec3::new((i % 40) as f32, (i / 40) as f32, 0.0);
        Aabb::new(at, at + Vec3::new(30.0, 2.0, (i % 7) as f32))
    };
    let shapes = from_fn(1600, boxes, |_, _| None);
    for options in presets() {
        let binary = built(&shapes, &options);
        check(&binary, &shapes, &options);
        assert_eq!(binary.references.len(), 1600);
    }
}

#[test]
fn bad_bounds_are_named() {
    let boxes = |i: u32| Aabb::new(Vec3::ZERO, Vec3::splat(if i % 60_000 == 50_000 { f32::NAN } else { 1.0 }));
    let shapes = from_fn(200_000, boxes, |_, _| None);
    let error = try_build(&shapes, &Options::fast(), |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(error, BuildError::Bounds { primitive: 50_000 });
}

#[test]
fn progress_is_told_and_stops() {
    let soup = Soup::random(20_000, 0.01);
    for options in presets() {
        let (greatest, total) = (AtomicU32::new(0), AtomicU32::new(0));
        let binary = try_build(&soup.mesh(), &options, |progress| {
            assert!(progress.done <= progress.total);
            greatest.fetch_max(progress.done, Ordering::Relaxed);
            total.store(progress.total, Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        assert!(binary.unwrap().is_continue());
        assert_eq!(greatest.into_inner(), total.into_inner());
        assert!(try_build(&soup.mesh(), &options, |_| ControlFlow::Break(())).unwrap().is_break());
    }
}
