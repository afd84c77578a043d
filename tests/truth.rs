//! Real meshes against the truth in double precision: no fault, no leak, no wrong primitive, whatever the structure.
//!
//! `HITSCAN_DATA` names a folder with, per mesh, `NAME.tri` (`u32` count, nine `f32` a triangle) and in `truth/` 20,000
//! rays `NAME.rays` (six `f32`), their answers `NAME.f64` (24 bytes: see [`Truth`]) and `NAME.json` with the tolerance
//! `delta`. Without it nothing is tested, and the test says so.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use std::{
    collections::HashMap,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use common::{bits, plans};
use hitscan::{
    Grid, Hit, List, Mesh, Ray, Scene,
    accel::{Plan, Structure},
    bake,
    glam::Vec3,
    grid,
    primitives::QuadMesh,
};

/// Meshes above this many triangles are tested with one preset of each structure only.
const LARGE: usize = 500_000;

/// What the reference says of a ray.
struct Truth {
    /// Infinite if it misses.
    t: f64,
    /// The range of defensible answers where the ray is not certain.
    range: [f64; 2],
    primitive: u32,
    ties: u16,
    flags: u16,
}

impl Truth {
    const HIT: u16 = 1;
    const AMBIGUOUS: u16 = 2;
    const CERTAIN: u16 = 64;

    fn read(record: &[u8]) -> Self {
        let word = |i: usize| u32::from_le_bytes(record[i..i + 4].try_into().unwrap());
        let range = [word(8), word(12)].map(|bits| f64::from(f32::from_bits(bits)));
        let t = f64::from_le_bytes(record[..8].try_into().unwrap());
        Self { t, range, primitive: word(16), ties: word(20) as u16, flags: (word(20) >> 16) as u16 }
    }

    fn is(&self, flag: u16) -> bool {
        self.flags & flag != 0
    }
}

/// How often an engine was wrong.
#[derive(Default)]
struct Verdict {
    certain: usize,
    faults: usize,
    leaks: usize,
    wrong_primitives: usize,
    /// Uncertain rays answered outside the range: counted, not failed.
    loose: usize,
    /// Differences between structures.
    structures: usize,
    /// Differences from the list.
    list: usize,
}

impl Verdict {
    fn judge(&mut self, truth: &Truth, ray: &Ray, hit: Option<Hit>, delta: f64) {
        let length = ray.direction.to_array().map(f64::from).iter().map(|x| x * x).sum::<f64>().sqrt();
        let expected = truth.is(Truth::HIT);
        let tolerance = 1.0e-4 * if expected { truth.t.abs() } else { 0.0 } + 8.0 * delta / length;
        let t = hit.map_or(f64::INFINITY, |hit| f64::from(hit.t));
        if truth.is(Truth::CERTAIN) {
            let wrong = hit.is_some() != expected || (expected && (t - truth.t).abs() > tolerance);
            self.certain += 1;
            self.faults += usize::from(wrong);
            self.leaks += usize::from(expected && t > truth.t + tolerance);
            let decided = truth.ties <= 1 && !truth.is(Truth::AMBIGUOUS);
            let other = hit.is_some_and(|hit| hit.primitive != truth.primitive);
            self.wrong_primitives += usize::from(!wrong && decided && other);
        } else {
            let [low, high] = truth.range;
            let within =
                if hit.is_some() { t >= low - tolerance && t <= high + tolerance } else { high == f64::INFINITY };
            self.loose += usize::from(!within);
        }
    }
}

fn floats(path: &Path) -> Vec<f32> {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    bytes.chunks_exact(4).map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect()
}

/// Vertices welded by their bits, and triangles in the file's order.
fn load(path: &Path) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut numbers = HashMap::new();
    let mut vertices = Vec::new();
    let corners: Vec<u32> = floats(path)[1..]
        .chunks_exact(3)
        .map(|p| {
            *numbers.entry([p[0].to_bits(), p[1].to_bits(), p[2].to_bits()]).or_insert_with(|| {
                vertices.push(Vec3::from_slice(p));
                vertices.len() as u32 - 1
            })
        })
        .collect();
    (vertices, corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

fn delta(path: &Path) -> f64 {
    let text = fs::read_to_string(path).unwrap();
    let (_, number) = text.split_once("\"delta\":").expect("delta");
    number[..number.find([',', '}']).unwrap()].trim().parse().unwrap()
}

fn test(folder: &Path, name: &str) -> Verdict {
    let (vertices, triangles) = load(&folder.join(format!("{name}.tri")));
    let truth = |extension: &str| folder.join("truth").join(format!("{name}.{extension}"));
    let rays: Vec<Ray> = floats(&truth("rays"))
        .chunks_exact(6)
        // The reference counts hits at t > 0 only.
        .map(|r| Ray::new(Vec3::from_slice(r), Vec3::from_slice(&r[3..])).starting_at(f32::from_bits(1)))
        .collect();
    let answers: Vec<Truth> = fs::read(truth("f64")).unwrap().chunks_exact(24).map(Truth::read).collect();
    let delta = delta(&truth("json"));
    assert!(rays.len() == 20_000 && answers.len() == rays.len(), "{name}");

    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut verdict = Verdict::default();
    let mut expected = Vec::new();
    for (_, plan) in plans::presets().iter().filter(|(name, _)| triangles.len() <= LARGE || name.ends_with("balanced"))
    {
        let words = bake::build(&mesh, plan).unwrap();
        let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words).unwrap(), &mesh).unwrap();
        let hits: Vec<Option<Hit>> = rays.iter().map(|ray| scene.closest_hit(ray)).collect();
        if expected.is_empty() {
            rays.iter().zip(&answers).zip(&hits).for_each(|((ray, truth), hit)| {
                verdict.judge(truth, ray, *hit, delta);
                assert!(scene.any_hit(ray) == hit.is_some(), "{name} {ray:?}");
            });
            expected = hits;
        } else {
            verdict.structures += hits.iter().zip(&expected).filter(|(a, b)| bits(**a) != bits(**b)).count();
        }
    }
    #[cfg(feature = "std")]
    {
        verdict.structures += wide(&mesh, &rays, &expected);
    }
    let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let sample = rays.iter().zip(&expected).step_by(1 + triangles.len() / 1500);
    verdict.list = sample.filter(|(ray, hit)| bits(list.closest_hit(ray)) != bits(**hit)).count();
    in_pairs(&mesh, |scene, pairs| {
        for (ray, truth) in rays.iter().zip(&answers) {
            let hit = scene.closest_hit(ray);
            let numbered = hit.map(|hit| Hit { primitive: pairs.numbers[hit.primitive as usize], ..hit });
            verdict.judge(truth, ray, numbered, delta);
            assert!(scene.any_hit(ray) == hit.is_some(), "{name} {ray:?}");
        }
    });
    verdict
}

/// A grid over the same triangles two at a time.
fn in_pairs(mesh: &Mesh<'_>, ask: impl FnOnce(&Scene<Grid<'_>, QuadMesh<Mesh<'_>>>, &bake::Pairs)) {
    let pairs = bake::pairs(mesh);
    let quads = bake::quads(&pairs.corners[..]).unwrap();
    let vertices = quads.vertices(mesh.vertices());
    let mesh = QuadMesh::new(Mesh::new(&vertices, quads.indices()).unwrap()).unwrap();
    let words = bake::build(&mesh, &Plan::Grid(grid::Options::balanced())).unwrap();
    ask(&Scene::new(Grid::open(&words).unwrap(), mesh).unwrap(), &pairs);
}

/// Rays that the wide tree answers otherwise than `expected`, with any instructions, one by one or in batches.
#[cfg(feature = "std")]
fn wide(mesh: &Mesh<'_>, rays: &[Ray], expected: &[Option<Hit>]) -> usize {
    use hitscan::wide::{Options, Simd, WideBvh};
    let mut differ = 0;
    let mut tree = WideBvh::new(mesh, &Options::best()).unwrap();
    for simd in Simd::available() {
        tree = tree.with_simd(simd);
        let (mut closest, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
        tree.closest_hits(rays, &mut closest);
        tree.any_hits(rays, &mut any);
        for (((ray, closest), any), expected) in rays.iter().zip(closest).zip(any).zip(expected) {
            let same = bits(closest) == bits(*expected) && any == expected.is_some();
            let single = bits(tree.closest_hit(ray)) == bits(*expected) && tree.any_hit(ray) == expected.is_some();
            differ += usize::from(!(same && single));
        }
    }
    differ
}

#[test]
fn the_judge_convicts() {
    let hit = |t, primitive| Some(Hit { t, primitive });
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let judge = |flags, hit| {
        let truth = Truth { t: 2.0, range: [2.0, 2.5], primitive: 7, ties: 1, flags };
        let mut v = Verdict::default();
        v.judge(&truth, &ray, hit, 1.0e-7);
        [v.certain, v.faults, v.leaks, v.wrong_primitives, v.loose]
    };
    let certain = Truth::HIT | Truth::CERTAIN;
    assert_eq!(judge(certain, hit(2.0001, 7)), [1, 0, 0, 0, 0]);
    assert_eq!(judge(certain, hit(2.0, 8)), [1, 0, 0, 1, 0]);
    assert_eq!(judge(certain, hit(2.001, 7)), [1, 1, 1, 0, 0]);
    assert_eq!(judge(certain, hit(1.999, 7)), [1, 1, 0, 0, 0]);
    assert_eq!(judge(certain, None), [1, 1, 1, 0, 0]);
    assert_eq!(judge(Truth::CERTAIN, hit(2.0, 7)), [1, 1, 0, 0, 0]);
    assert_eq!(judge(Truth::HIT, hit(2.25, 8)), [0; 5]);
    assert_eq!(judge(Truth::HIT, hit(2.6, 7)), [0, 0, 0, 0, 1]);
    assert_eq!(judge(Truth::HIT, None), [0, 0, 0, 0, 1]);
}

/// The names of all meshes, the largest first.
fn meshes(folder: &Path) -> Vec<String> {
    let mut files: Vec<(u64, PathBuf)> = fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("HITSCAN_DATA: {}: {error}", folder.display()))
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.path().extension().is_some_and(|extension| extension == "tri"))
        .map(|entry| (entry.metadata().unwrap().len(), entry.path()))
        .collect();
    files.sort();
    files.iter().rev().map(|(_, path)| path.file_stem().unwrap().to_string_lossy().into_owned()).collect()
}

#[test]
fn real_meshes_are_answered_as_in_double_precision() {
    // Past the test harness, which keeps what `eprintln` says of tests that pass.
    let say = |text: &str| io::stderr().lock().write_all(text.as_bytes()).unwrap();
    let Some(folder) = std::env::var_os("HITSCAN_DATA").map(PathBuf::from) else {
        say("\n*** SKIPPED: the truth test. HITSCAN_DATA names no folder of meshes, so NOTHING WAS COMPARED. ***\n\n");
        return;
    };
    let names = meshes(&folder);
    assert!(!names.is_empty(), "no meshes in {}", folder.display());
    let (next, bad) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                while let Some(name) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let v = test(&folder, name);
                    let line = format!(
                        "{name}: certain {} faults {} leaks {} wrong-primitive {} loose {} | structures differ {} list differs {}\n",
                        v.certain, v.faults, v.leaks, v.wrong_primitives, v.loose, v.structures, v.list
                    );
                    say(&line);
                    if v.faults + v.wrong_primitives + v.structures + v.list > 0 {
                        bad.lock().unwrap().push(line);
                    }
                }
            });
        }
    });
    let bad = bad.into_inner().unwrap();
    assert!(bad.is_empty(), "{bad:#?}");
}
