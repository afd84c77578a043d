//! Scenes that broke other engines, bit by bit, each with its exact answer, under every structure.
//!
//! `nasty_cases.txt` holds an item a line. `S id build` begins a scene. `T` and nine numbers are a triangle; `G kind count`
//! and nine numbers with an optional step are `count` triangles, each the one before moved by the step. `P` and four
//! numbers are a sphere; spheres are numbered after the triangles. `R` is a ray with origin, direction, interval, level,
//! whether it hits, where, the relative tolerance, how often to ask, and the primitives accepted there. `B` is a slab test
//! alone. Numbers are the bits of an `f32`.
//!
//! At the levels `must`, `closed` and `goal` an answer must be right; at all, `agree` included, all structures answer as
//! the list. A scene whose `build` is not `ok` may be refused, and so may one whose rays are all at the level `goal`.
#![allow(missing_docs)]

mod common;

use std::{collections::BTreeMap, fmt::Debug};

use common::{bits, plans};
use hitscan::{
    Accelerator, Arena, Error, Hit, List, Mesh, Primitives, Ray, Scene,
    accel::{Plan, Structure},
    error::BuildError,
    geometry::{Aabb, Sphere},
    glam::Vec3,
    kdtree,
    primitives::{MeshError, Spheres},
    query::Progress,
};

#[derive(Debug, Default)]
struct Case<'a> {
    id: &'a str,
    build: &'a str,
    vertices: Vec<Vec3>,
    spheres: Vec<Sphere>,
    rays: Vec<Question<'a>>,
}

#[derive(Debug)]
struct Question<'a> {
    ray: Ray,
    level: &'a str,
    hit: bool,
    t: f32,
    tolerance: f32,
    repeat: usize,
    primitives: &'a str,
}

fn numbers(words: &[&str]) -> Vec<f32> {
    words.iter().map(|word| f32::from_bits(u32::from_str_radix(word, 16).unwrap())).collect()
}

fn points(numbers: &[f32]) -> Vec<Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice).collect()
}

impl<'a> Question<'a> {
    fn read(words: &[&'a str]) -> Self {
        let f = numbers(&words[..8]);
        Self {
            ray: Ray::new(Vec3::from_slice(&f), Vec3::from_slice(&f[3..])).starting_at(f[6]).up_to(f[7]),
            level: words[8],
            hit: words[9] == "1",
            t: numbers(&words[10..11])[0],
            tolerance: words[11].parse::<f32>().unwrap().max(1.0e-5),
            repeat: words[12].parse::<usize>().unwrap(),
            primitives: words[13],
        }
    }

    fn accepts(&self, hit: Option<Hit>) -> bool {
        let Some(hit) = hit else { return !self.hit };
        let near = (f64::from(hit.t) - f64::from(self.t)).abs() <= f64::from(self.tolerance) * f64::from(self.t.abs());
        let accepted = self.primitives.split(',').any(|p| p == "*" || p.parse() == Ok(hit.primitive));
        self.hit && near && accepted
    }
}

fn cases() -> Vec<Case<'static>> {
    let mut cases: Vec<Case> = Vec::new();
    for line in include_str!("nasty_cases.txt").lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match (words.first(), cases.last_mut()) {
            (Some(&"S"), _) => cases.push(Case { id: words[1], build: words[2], ..Case::default() }),
            (Some(&"T"), Some(case)) => case.vertices.extend(points(&numbers(&words[1..10]))),
            (Some(&"G"), Some(case)) => {
                let mut corners = points(&numbers(&words[3..12]));
                let step = points(&numbers(&words[12..])).first().copied().unwrap_or_default();
                for _ in 0..words[2].parse().unwrap() {
                    case.vertices.extend(&corners);
                    corners.iter_mut().for_each(|v| *v += step);
                }
            }
            (Some(&"P"), Some(case)) => {
                let f = numbers(&words[1..5]);
                case.spheres.push(Sphere::new(Vec3::from_slice(&f), f[3]));
            }
            (Some(&"R"), Some(case)) => case.rays.push(Question::read(&words[1..])),
            _ => {}
        }
    }
    cases
}

/// Rays and failures per level.
#[derive(Default)]
struct Tally {
    levels: BTreeMap<&'static str, [usize; 3]>,
    refused: Vec<String>,
    failures: Vec<String>,
}

impl Tally {
    /// Asks all of a case under one structure; `expected` are the list's answers.
    fn ask<A: Accelerator, P: Primitives>(
        &mut self,
        case: &Case<'static>,
        scene: &Scene<A, P>,
        name: &dyn Debug,
        expected: Option<&[Option<Hit>]>,
    ) -> Vec<Option<Hit>> {
        let mut answers = Vec::new();
        for (index, question) in case.rays.iter().enumerate() {
            let hit = scene.closest_hit(&question.ray);
            let right = question.level == "agree" || question.accepts(hit);
            let same = expected.is_none_or(|list| bits(list[index]) == bits(hit))
                && scene.any_hit(&question.ray) == hit.is_some()
                && bits(scene.hits(&question.ray).next()) == bits(hit)
                && (0..question.repeat).all(|_| bits(scene.closest_hit(&question.ray)) == bits(hit));
            // Invalid rays visit nothing.
            let invalid = question.ray.prepare().is_none();
            let brief = !invalid || scene.begin(&question.ray).advance(1) == Progress::Done(None);
            let level = self.levels.entry(question.level).or_default();
            level[0] += 1;
            level[1] += usize::from(!right);
            level[2] += usize::from(!same);
            if !(right && same && brief) {
                self.failures.push(format!("{} {name:?}: {hit:?} brief {brief} for {question:?}", case.id));
            }
            assert!(case.id != "N44" || invalid, "{question:?}");
            answers.push(hit);
        }
        answers
    }

    fn ask_all<P: Primitives>(&mut self, case: &Case<'static>, primitives: &P) {
        let list = Scene::new(List::new(primitives).unwrap(), primitives).unwrap();
        let expected = self.ask(case, &list, &"list", None);
        let fine = Plan::KdTree(kdtree::Options { leaf_size: 4, ..kdtree::Options::fast() });
        for (name, plan) in plans::presets().into_iter().chain([("kD-tree with leaves of 4", fine)]) {
            let mut memory = vec![0; plan.words(primitives.len() as usize)];
            match Structure::build(primitives, &mut Arena::new(&mut memory), &plan) {
                Ok(built) => {
                    let opened = Structure::open(plan.kind().unwrap(), built.as_words()).unwrap();
                    let scene = Scene::new(opened, primitives).unwrap();
                    self.ask(case, &scene, &name, Some(&expected));
                }
                Err(BuildError::Full(_)) if case.build == "ok_or_capacity_err" => {
                    self.refused.push(format!("{} {name}", case.id));
                }
                Err(error) => self.failures.push(format!("{}: {error}: {plan:?}", case.id)),
            }
        }
    }

    /// Whether the wide tree answers as the list, with any instructions.
    #[cfg(feature = "std")]
    fn ask_wide(&mut self, case: &Case<'static>, mesh: &Mesh<'_>) {
        use hitscan::wide::{Options, Simd, WideBvh};
        let list = Scene::new(List::new(mesh).unwrap(), mesh).unwrap();
        let rays: Vec<Ray> = case.rays.iter().map(|question| question.ray).collect();
        for options in [Options::fast(), Options::best()] {
            let mut wide = WideBvh::new(mesh, &options).unwrap();
            for simd in Simd::available() {
                wide = wide.with_simd(simd);
                // So many that they walk in turns.
                let many: Vec<Ray> = rays.iter().cycle().take(if rays.is_empty() { 0 } else { 100 }).copied().collect();
                let mut hits = vec![None; many.len()];
                wide.closest_hits(&many, &mut hits);
                for (ray, hit) in many.iter().zip(hits) {
                    let expected = bits(list.closest_hit(ray));
                    let same = [bits(hit), bits(wide.closest_hit(ray))] == [expected; 2];
                    if !(same && wide.any_hit(ray) == expected.is_some()) {
                        self.failures.push(format!("{} wide {simd:?}: {hit:?} for {ray:?}", case.id));
                    }
                }
            }
        }
    }

    fn run(&mut self, case: &Case<'static>) {
        let triangles: Vec<[u32; 3]> =
            (0..case.vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let both = Mesh::new(&case.vertices, &triangles[..])
            .map_err(Error::from)
            .and_then(|mesh| Ok((mesh, Spheres::new(&case.spheres)?)));
        match both {
            Ok(both) => {
                self.ask_all(case, &both);
                if case.spheres.is_empty() {
                    self.ask_all(case, &both.0);
                    #[cfg(feature = "std")]
                    self.ask_wide(case, &both.0);
                }
            }
            Err(error) => {
                let optional = case.build == "ok_or_err" || case.rays.iter().all(|ray| ray.level == "goal");
                // It must name the first that is bad.
                let bad = |corners: &[Vec3]| !corners.iter().all(|v| v.is_finite());
                let named = match error {
                    Error::Mesh(MeshError::Vertex { triangle, .. }) => {
                        case.vertices.chunks(3).position(bad) == Some(triangle as usize)
                    }
                    Error::Sphere(error) => error.sphere == 0,
                    _ => false,
                };
                self.refused.push(case.id.to_owned());
                if !(optional && named) {
                    self.failures.push(format!("{}: {error}", case.id));
                }
            }
        }
    }
}

#[test]
fn nasty_scenes_are_answered_right_by_every_structure() {
    let cases = cases();
    let rays: usize = cases.iter().map(|case| case.rays.len()).sum();
    assert_eq!((cases.len(), rays), (55, 409));
    let mut tally = Tally::default();
    cases.iter().for_each(|case| tally.run(case));
    println!("level: rays, wrong, differing: {:?}; refused: {:?}", tally.levels, tally.refused);
    assert!(
        tally.failures.is_empty(),
        "{} failures, the first {:#?}",
        tally.failures.len(),
        &tally.failures[..8.min(tally.failures.len())]
    );
}

/// Whether the slab test may report this: it is conservative, but by no more than a few of its widenings of 2^-16.
fn plausible(interval: Option<(f32, f32)>, ray: &Ray) -> bool {
    interval.is_some_and(|(enter, exit)| {
        let exit = f64::from(exit) - f64::from(exit).abs() * 2.0_f64.powi(-14);
        exit >= f64::from(enter.max(ray.t_min)) && enter <= ray.t_max
    })
}

#[test]
fn boxes_that_are_hit_are_reported() {
    let (mut count, mut refused) = (0, Vec::new());
    for line in include_str!("nasty_cases.txt").lines().filter(|line| line.starts_with('B')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let f = numbers(&words[2..16]);
        let p = points(&f);
        let aabb = Aabb::new(p[0], p[1]);
        let ray = Ray::new(p[2], p[3]).starting_at(f[12]).up_to(f[13]);
        count += 1;
        match ray.prepare().filter(|_| aabb.is_valid()) {
            Some(prepared) if words[16] == "1" => {
                let (enter, exit) = aabb.interval(&prepared).unwrap_or_else(|| panic!("{line}"));
                assert!(exit >= ray.t_min && enter <= ray.t_max, "{line}");
            }
            Some(prepared) => assert!(!plausible(aabb.interval(&prepared), &ray), "{line}"),
            // No such ray is cast, or nothing can be built over such a box.
            None => {
                let shape = hitscan::from_fn(1, |_| aabb, |_, _| Some(1.0));
                assert!(ray.prepare().is_none() || List::new(&shape).is_err(), "{line}");
                refused.push(words[1]);
            }
        }
    }
    assert_eq!(refused, ["B10", "B15", "B21", "B22"]);
    assert_eq!(count, 22);
}
