//! Each rule of exactness is needed: broken alone, the tree answers other than the list, and the fuzz sees it.
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;
mod walk;
mod walks;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, plans};
use hitscan::{
    Arena, Hit, KdTree, List, Mesh, PreparedRay, Primitives, Ray, Scene, Span,
    accel::Structure,
    asset::Kind,
    from_fn,
    geometry::{Aabb, Triangle},
    glam::Vec3,
    kdtree::{Options, Split},
};
use walk::{Mutant, Shape, Walker};
use walks::Shortcut;

/// A hit, or none, as bits.
type Answer = Option<(u32, u32)>;

/// What the list and the tree of the library say.
type Library<'a> = &'a dyn Fn(&Ray) -> [Answer; 2];

fn answers(mutant: Mutant, shapes: &[Shape], tree: &KdTree, ray: &Ray) -> [Answer; 2] {
    let walker = || Walker::new(mutant, shapes, ray);
    [walker().and_then(Walker::list), walker().and_then(|walker| walker.tree(tree.as_words()))].map(bits)
}

fn options(random: &mut Random) -> Options {
    Options {
        split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah]),
        intersection_cost: random.pick(&[1.0, 20.0]),
        clip: !random.one_in(4),
        ..Options::fast()
    }
}

/// Shapes to cast rays at.
struct Case<'a> {
    /// How many there were before.
    number: usize,
    shapes: &'a [Shape],
    primitives: &'a dyn Primitives,
    tree: &'a KdTree<'a>,
    library: Library<'a>,
}

/// Calls `check` with scenes and rays until it is content or `rays` were cast; how many were.
fn fuzz(rays: usize, mut check: impl FnMut(&Case, &Ray) -> bool) -> usize {
    let mut random = Random::new(8);
    let mut memory = vec![0; 1 << 15];
    let mut cast = 0;
    loop {
        let family = random.below(FAMILIES);
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 16);
        let number = random.pick(&[0, 12]);
        let mut boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let corners: Vec<Vec3> =
            boxes.iter().flat_map(|b| [b.min, b.max, b.center()]).chain(vertices.iter().copied()).collect();
        // Some scenes are so small, and their rays so fast, that parameters underflow.
        let (small, fast) = random.pick(&[(1.0, 1.0), (1.0, 1.0), (2.0_f32.powi(-60), 2.0_f32.powi(85))]);
        vertices.iter_mut().for_each(|v| *v *= small);
        boxes.iter_mut().for_each(|b| *b = Aabb::new(b.min * small, b.max * small));

        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let first = mesh.len();
        let shapes: Vec<Shape> = (0..first)
            .map(|i| Shape::Triangle(mesh.triangle(i)))
            .chain(boxes.iter().map(|&aabb| Shape::Noise(aabb)))
            .collect();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i + first, ray)));
        let both = (mesh, others);
        let tree = KdTree::build(&both, &mut Arena::new(&mut memory), &options(&mut random)).unwrap();
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let scene = Scene::new(tree, &both).unwrap();
        let library = |ray: &Ray| [bits(list.closest_hit(ray)), bits(scene.closest_hit(ray))];
        let case = Case { number: cast / 100, shapes: &shapes, primitives: &both, tree: &tree, library: &library };
        for _ in 0..100 {
            let mut ray = adversarial_ray(&mut random, family, &corners);
            ray.origin *= small;
            ray.direction *= fast;
            // Some intervals begin at a hit.
            if random.one_in(4)
                && let Some(hit) = list.closest_hit(&ray)
            {
                ray.t_min = hit.t;
            }
            cast += 1;
            if check(&case, &ray) || cast >= rays {
                return cast;
            }
        }
    }
}

#[test]
fn the_right_rules_answer_as_the_library() {
    fuzz(300_000, |Case { shapes, tree, library, .. }, ray| {
        assert_eq!(library(ray), answers(Mutant::Right, shapes, tree, ray), "{ray:?} {shapes:?}");
        false
    });
}

#[test]
fn every_mutant_is_caught() {
    let mut survivors = vec![];
    for mutant in Mutant::ALL {
        const ENOUGH: usize = 3_000_000;
        let caught = fuzz(ENOUGH, |Case { shapes, tree, .. }, ray| {
            let [list, walked] = answers(mutant, shapes, tree, ray);
            list != walked
        });
        println!("{mutant:?} is caught by ray {caught}");
        if caught == ENOUGH {
            survivors.push(mutant);
        }
    }
    assert!(survivors.is_empty(), "{survivors:?}");
}

/// A structure of one kind over the shapes of a case, built once for all rays at them.
struct Boxes {
    random: Random,
    kind: usize,
    /// The number of the case, the structure's kind and its words.
    built: Option<(usize, Kind, Vec<u32>)>,
}

impl Boxes {
    /// Whether the list and a walk through the boxes differ.
    fn differ(&mut self, mutant: Mutant, case: &Case, ray: &Ray) -> bool {
        if self.built.as_ref().is_none_or(|(number, ..)| *number != case.number) {
            let mut memory = vec![0; 1 << 15];
            let built = plans::build(&mut self.random, self.kind, &case.primitives, &mut memory);
            self.built = built.map(|(_, it)| (case.number, it.kind().unwrap(), it.as_words().to_vec()));
        }
        let Some((_, kind, words)) = &self.built else { return false };
        let structure = Structure::open(*kind, words).unwrap();
        let walker = || Walker::new(mutant, case.shapes, ray);
        bits(walker().and_then(Walker::list)) != bits(walker().and_then(|walker| walker.boxes(&structure)))
    }
}

#[test]
fn the_rules_of_boxes_are_needed_in_every_structure() {
    use Mutant::*;
    for kind in 0..plans::KINDS {
        let boxes = || Boxes { random: Random::new(12), kind, built: None };
        let mut right = boxes();
        assert_eq!(fuzz(50_000, |case, ray| right.differ(Right, case, ray)), 50_000, "structure {kind}");
        for mutant in
            [ContainmentForOverflow, CutExitsForOverflow, NoWidening, FactorOnly, PruneAtBest, NoClamp, RejectAtBest]
        {
            const ENOUGH: usize = 500_000;
            let mut broken = boxes();
            let caught = fuzz(ENOUGH, |case, ray| broken.differ(mutant, case, ray));
            println!("{mutant:?} in structure {kind} is caught by ray {caught}");
            assert!(caught < ENOUGH, "{mutant:?} in structure {kind}");
        }
    }
}

#[test]
fn every_shortcut_is_caught() {
    for shortcut in Shortcut::ALL {
        let answer = |taken: bool, case: &Case, ray: &Ray, before: &Ray| {
            let walker = |ray| Walker::new(Mutant::Right, case.shapes, ray);
            bits(walker(ray).and_then(|it| it.shortcut(shortcut, taken, walker(before))))
        };
        let mut before = Ray::new(Vec3::ZERO, Vec3::X);
        fuzz(30_000, |case, ray| {
            if shortcut != Shortcut::BestPassedDown {
                assert_eq!(answer(false, case, ray, &before), (case.library)(ray)[0], "{shortcut:?} {ray:?}");
            }
            false
        });
        const ENOUGH: usize = 3_000_000;
        let caught = fuzz(ENOUGH, |case, ray| {
            let differs = answer(true, case, ray, &before) != answer(false, case, ray, &before);
            before = *ray;
            differs
        });
        println!("{shortcut:?} is caught by ray {caught}");
        assert!(caught < ENOUGH, "{shortcut:?}");
    }
}

/// Triangles by the plain test of Möller and Trumbore (1997), whose `t` may be far off.
struct Careless<'a> {
    mesh: Mesh<'a>,
    certified: bool,
}

impl Primitives for Careless<'_> {
    fn len(&self) -> u32 {
        self.mesh.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.mesh.bounds(index)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let (Triangle { a, b, c }, ray) = (self.mesh.triangle(index), ray.ray());
        let (u, v, s) = (b - a, c - a, ray.origin - a);
        let (p, q) = (ray.direction.cross(v), s.cross(u));
        let inverse = 1.0 / u.dot(p);
        let (x, y) = (s.dot(p) * inverse, ray.direction.dot(q) * inverse);
        if x >= 0.0 && y >= 0.0 && x + y <= 1.0 { span.accept(v.dot(q) * inverse, index) } else { None }
    }

    fn is_certified(&self, _index: u32) -> bool {
        self.certified
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.mesh.clip(index, cell)
    }
}

/// The first of many rays for which the tree of careless triangles answers other than their list.
fn careless(certified: bool) -> Option<usize> {
    let mut random = Random::new(10);
    let mut memory = vec![0; 1 << 15];
    let mut scene = |random: &mut Random| {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(random, family, 16);
        let shapes = Careless { mesh: Mesh::new(&vertices, &triangles[..]).unwrap(), certified };
        let tree = KdTree::build(&shapes, &mut Arena::new(&mut memory), &options(random)).unwrap();
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        let tree = Scene::new(tree, &shapes).unwrap();
        (0..100).any(|_| {
            let ray = adversarial_ray(random, family, &vertices);
            bits(list.closest_hit(&ray)) != bits(tree.closest_hit(&ray))
        })
    };
    (1..=3000).find(|_| scene(&mut random)).map(|scenes| scenes * 100)
}

#[test]
fn shapes_that_are_not_certified_must_not_claim_to_be() {
    assert_eq!(careless(false), None);
    let caught = careless(true);
    println!("careless triangles are caught by ray {caught:?}");
    assert!(caught.is_some());
}
