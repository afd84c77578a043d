//! What is near a point: every structure answers as a gather of all distances.
#![allow(missing_docs)]

mod common;

use std::cell::Cell as Counter;

use common::{FAMILIES, Random, adversarial_mesh, boxed, coordinate, noise, point, rays, seed};
use hitscan::{
    Accelerator, Arena, Hit, Instance, Instances, KdTree, List, Mesh, PreparedRay, Primitives, Ray, Scene, Span,
    accel::{Cell, Hierarchy, Inside, Plan, Structure},
    geometry::{Aabb, Sphere, Transform},
    glam::{Mat3, Vec3},
    kdtree,
    primitives::{Nearest, Order, Probe, Proximity, Renumbering, Reordered, Spheres},
};

type Key = (u32, u32);

fn key(nearest: Nearest) -> Key {
    (nearest.distance.to_bits(), nearest.primitive)
}

/// All structures, and kD-trees that divide down to the last.
fn plans(random: &mut Random) -> Vec<Plan> {
    let split = random.pick(&[kdtree::Split::Midpoint, kdtree::Split::Median, kdtree::Split::Sah]);
    let divided = kdtree::Options {
        split,
        leaf_size: random.pick(&[1, 1, 3]),
        intersection_cost: random.pick(&[2.0, 20.0]),
        clip: !random.one_in(4),
        ..kdtree::Options::fast()
    };
    Plan::all().chain([Plan::KdTree(divided)]).collect()
}

/// A point on, in, near or far from the shapes around `corners`.
fn place(random: &mut Random, family: usize, corners: &[Vec3]) -> Vec3 {
    let (a, b, c) = (random.pick(corners), random.pick(corners), random.pick(corners));
    let mut p = match random.below(7) {
        0 => a,
        1 => a * 0.5 + b * 0.5,
        2 => a + (b - a) * random.unit(),
        3 => Vec3::new(a.x, b.y, c.z),
        4 => (a + b + c) / 3.0,
        5 => point(random, family),
        _ => a * random.pick(&[-1.0, 2.0, 100.0, 1.0e6, 1.0e-6]),
    };
    if random.one_in(3) {
        // In a plane through a corner, where splits are.
        let axis = random.below(3);
        p[axis] = a[axis];
    }
    if random.one_in(4) {
        let axis = random.below(3);
        p[axis] = if random.one_in(2) { p[axis].next_up() } else { p[axis].next_down() };
    }
    p.clamp(Vec3::splat(-1.0e37), Vec3::splat(1.0e37))
}

/// Compares all queries at `p` with `expected`: every primitive's distance and number, in order.
fn compare<A: Hierarchy, P: Proximity>(scene: &Scene<A, P>, p: Vec3, expected: &[(f32, u32)], random: &mut Random) {
    let keys: Vec<Key> = expected.iter().map(|&(distance, primitive)| (distance.to_bits(), primitive)).collect();
    assert_eq!(scene.nearest_point(p, f32::INFINITY).map(key), keys.first().copied(), "{p:?}");
    let keep = |number: u32| number % 3 == 1;
    let kept = keys.iter().copied().find(|&(_, number)| keep(number));
    assert_eq!(scene.nearest_point_where(p, f32::INFINITY, keep).map(key), kept, "{p:?}");
    let Some(&(least, _)) = expected.first() else { return };
    // The limit belongs to what is near.
    assert_eq!(scene.nearest_point(p, least).map(key), keys.first().copied(), "{p:?}");
    if least > 0.0 {
        assert_eq!(scene.nearest_point(p, least.next_down()), None, "{p:?}");
    }
    let (some, _) = random.pick(expected);
    for radius in [least, some, some.next_down(), some * 0.5] {
        let touched: Vec<Key> = scene.overlaps(&Sphere::new(p, radius)).map(key).collect();
        let within = expected.iter().take_while(|(distance, _)| *distance <= radius).count();
        assert_eq!(touched, keys[..within], "{p:?} {radius}");
        assert_eq!(scene.any_overlap(&Sphere::new(p, radius)), within > 0, "{p:?} {radius}");
    }
}

/// Holds every structure over `primitives` to `distances`: of each primitive, with its number.
fn hold<P: Proximity>(
    random: &mut Random,
    primitives: &P,
    memory: &mut [u32],
    points: &[Vec3],
    distances: impl Fn(Vec3) -> Vec<(f32, u32)>,
) {
    let mut gathered: Vec<(Vec3, Vec<(f32, u32)>)> = points.iter().map(|&p| (p, distances(p))).collect();
    for (_, list) in &mut gathered {
        list.retain(|(distance, _)| *distance <= f32::MAX);
        list.sort_by(|a, b| a.partial_cmp(b).unwrap());
    }
    for plan in plans(random) {
        let structure = Structure::build(primitives, &mut Arena::new(memory), &plan).unwrap();
        let scene = Scene::new(structure, primitives).unwrap();
        for (p, expected) in &gathered {
            compare(&scene, *p, expected, random);
        }
    }
}

fn rounds() -> usize {
    rays(60_000) / 100
}

fn ball(random: &mut Random, family: usize) -> Sphere {
    let own = coordinate(random, family).abs();
    let radius = random.pick(&[1.0, 0.25, own]);
    Sphere::new(point(random, family), radius.max(f32::from_bits(1)))
}

#[test]
fn triangles_are_found_as_in_a_gather() {
    let mut random = Random::new(1 + 100 * seed());
    let mut memory = vec![0; 1 << 16];
    for round in 0..rounds() {
        let family = round % FAMILIES;
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        // Some scenes are so small or so large that squares of lengths do not fit an `f32`.
        let scale = random.pick(&[1.0, 1.0, 2.0_f32.powi(70), 2.0_f32.powi(-120)]);
        vertices.iter_mut().for_each(|v| *v = (*v * scale).clamp(Vec3::splat(-1.0e37), Vec3::splat(1.0e37)));
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let points: Vec<Vec3> = (0..20).map(|_| place(&mut random, family, &vertices)).collect();
        let distances = |p: Vec3| (0..mesh.len()).map(|i| (mesh.triangle(i).distance(p), i)).collect();
        hold(&mut random, &mesh, &mut memory, &points, distances);
    }
}

/// Boxes whose distance is anything: what structures may rely on is that it is raised to that of the box.
struct Noise(Vec<Aabb>);

impl Noise {
    fn distance(&self, index: u32, p: Vec3) -> f32 {
        noise(index, &Ray::new(p, Vec3::X))
    }
}

impl Primitives for Noise {
    fn len(&self) -> u32 {
        self.0.len() as u32
    }
    fn bounds(&self, index: u32) -> Aabb {
        self.0[index as usize]
    }
    fn intersect(&self, _: u32, _: &PreparedRay, _: &Span) -> Option<Hit> {
        None
    }
}

impl Proximity for Noise {
    fn closest_point(&self, number: u32, _: Vec3) -> Option<Vec3> {
        Some(self.0[number as usize].center())
    }
    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        probe.accept(self.distance(index, probe.point()), index)
    }
}

#[test]
fn mixed_shapes_are_found_as_in_a_gather() {
    let mut random = Random::new(2 + 100 * seed());
    let mut memory = vec![0; 1 << 16];
    for round in 0..rounds() {
        let family = round % FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 12);
        let balls: Vec<Sphere> = (0..random.below(12)).map(|_| ball(&mut random, family)).collect();
        let noise = Noise((0..random.below(12)).map(|_| boxed(&mut random, family)).collect());
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        // The triangles backwards, under the numbers that they had.
        let backwards: Vec<[u32; 3]> = triangles.iter().rev().copied().collect();
        let order: Vec<u32> = (0..mesh.len()).rev().collect();
        let numbers = Renumbering::new(Order::Wide(&order), Order::Wide(&order)).unwrap();
        let reordered = Reordered::new(Mesh::new(&vertices, &backwards[..]).unwrap(), numbers).unwrap();

        let points: Vec<Vec3> = (0..20).map(|_| place(&mut random, family, &vertices)).collect();
        let spheres = balls.iter().map(|ball| (ball.bounds(), *ball));
        let distances = |p: Vec3| {
            let first = (0..mesh.len()).map(|i| mesh.triangle(i).distance(p));
            let second = spheres.clone().map(|(bounds, ball)| ball.distance(p).max(bounds.distance(p)));
            let third = noise.0.iter().enumerate().map(|(i, bounds)| {
                let distance = noise.distance(i as u32, p);
                if distance.is_nan() { f32::NAN } else { distance.max(bounds.distance(p)) }
            });
            first.chain(second).chain(third).zip(0..).filter(|(distance, _)| !distance.is_nan()).collect()
        };
        let all = ((reordered, Spheres::new(&balls).unwrap()), &noise);
        hold(&mut random, &all, &mut memory, &points, distances);
    }
}

/// A rotation, often with a mirror, and a scale.
fn similar(random: &mut Random, family: usize) -> Transform {
    let mirror = Mat3::from_diagonal(Vec3::new(random.pick(&[1.0, -1.0]), 1.0, 1.0));
    let turn = random.pick(&[0.0, 0.7, std::f32::consts::FRAC_PI_2]);
    let linear = Mat3::from_rotation_y(turn) * Mat3::from_rotation_x(turn * 3.0) * mirror;
    let scale = random.pick(&[1.0, 1.0, 0.01, 3.0, 1.0e-9]);
    Transform::new(linear * scale, point(random, family)).unwrap()
}

#[test]
fn placed_scenes_are_found_as_in_lists_of_lists() {
    let mut random = Random::new(3 + 100 * seed());
    let (mut memory, mut upper) = (vec![0; 1 << 18], vec![0; 1 << 16]);
    let (mut asked, mut near) = (0, 0);
    for round in 0..rounds() / 6 {
        let family = round % FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 24);
        let balls: Vec<Sphere> = (0..1 + random.below(8)).map(|_| ball(&mut random, family)).collect();
        let shapes = (Mesh::new(&vertices, &triangles[..]).unwrap(), Spheres::new(&balls).unwrap());
        let transforms: Vec<Transform> = (0..1 + random.below(8)).map(|_| similar(&mut random, family)).collect();
        let place_all = || -> Vec<Instance> { transforms.iter().map(|&t| Instance::new(0, t)).collect() };

        let lists = [Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap()];
        let mut placed = place_all();
        let Ok(instances) = Instances::place(&lists, &mut placed) else { continue };
        let instances = instances.similar().unwrap();
        let oracle = Scene::new(List::new(&instances).unwrap(), &instances).unwrap();
        let corners: Vec<Vec3> = transforms.iter().flat_map(|t| vertices.iter().map(|&v| t.point(v))).collect();
        let points: Vec<Vec3> = (0..10).map(|_| place(&mut random, family, &corners)).collect();

        for plan in plans(&mut random) {
            let structure = Structure::build(&shapes, &mut Arena::new(&mut memory), &plan).unwrap();
            let scenes = [Scene::new(structure, &shapes).unwrap()];
            let mut placed = place_all();
            let instances = Instances::place(&scenes, &mut placed).unwrap().similar().unwrap();
            let structure = Structure::build(&instances, &mut Arena::new(&mut upper), &plan).unwrap();
            let scene = Scene::new(structure, &instances).unwrap();
            for &p in &points {
                let all: Vec<(f32, u32)> =
                    oracle.overlaps(&Sphere::new(p, f32::INFINITY)).map(|n| (n.distance, n.primitive)).collect();
                assert!(all.is_sorted());
                compare(&scene, p, &all, &mut random);
                asked += 1;
                near += usize::from(!all.is_empty());
            }
        }
    }
    assert!(near * 10 > asked * 9, "{near} of {asked}");
}

#[test]
fn placed_scenes_are_as_far_as_their_images() {
    let mut random = Random::new(4);
    let mut memory = vec![0; 1 << 14];
    for _ in 0..300 {
        let vertices: Vec<Vec3> = (0..90).map(|_| point(&mut random, 2)).collect();
        let triangles: Vec<[u16; 3]> = (0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &kdtree::Options::fast()).unwrap();
        let scenes = [Scene::new(tree, &mesh).unwrap()];
        let turn = Mat3::from_rotation_y(random.unit()) * Mat3::from_rotation_z(random.unit());
        // A radius in the world is a larger one in a small scene, and a smaller one in a large scene.
        let scale = random.pick(&[2.5, 1.0, 0.05]);
        let transform = Transform::new(turn * scale, point(&mut random, 2)).unwrap();
        let mut placed = [Instance::new(0, transform)];
        let instances = Instances::place(&scenes, &mut placed).unwrap().similar().unwrap();
        let world = Scene::new(List::new(&instances).unwrap(), &instances).unwrap();
        let moved: Vec<Vec3> = vertices.iter().map(|&v| transform.point(v)).collect();
        let images = Mesh::new(&moved, &triangles[..]).unwrap();
        let images = Scene::new(List::new(&images).unwrap(), &images).unwrap();
        let p = point(&mut random, 2) * 3.0;
        let (a, b) = (world.nearest_point(p, 99.0).unwrap(), images.nearest_point(p, 99.0).unwrap());
        assert!((a.distance - b.distance).abs() < 4.0e-6 && a.point.distance(p) - a.distance < 4.0e-6, "{a:?} {b:?}");
    }
}

#[test]
fn invalid_questions_have_no_answer() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        assert_eq!(scene.nearest_point(Vec3::new(0.0, bad, 0.0), 1.0), None);
        assert!(!scene.any_overlap(&Sphere::new(Vec3::splat(bad), 1.0)));
    }
    for bad in [f32::NAN, f32::NEG_INFINITY, -1.0, -1.0e-45] {
        assert_eq!(scene.nearest_point(Vec3::ZERO, bad), None);
        assert_eq!(scene.overlaps(&Sphere::new(Vec3::ZERO, bad)).count(), 0);
    }
    assert_eq!(scene.nearest_point(Vec3::ZERO, -0.0).map(key), Some((0, 0)));
    let nothing = Mesh::new(&vertices, &[[0_u16; 3]; 0]).unwrap();
    for plan in Plan::all() {
        let mut memory = vec![0; plan.words(0)];
        let structure = Structure::build(&nothing, &mut Arena::new(&mut memory), &plan).unwrap();
        let scene = Scene::new(structure, &nothing).unwrap();
        assert_eq!(scene.nearest_point(Vec3::ZERO, f32::INFINITY), None);
        assert!(!scene.any_overlap(&Sphere::new(Vec3::ZERO, f32::INFINITY)));
    }
}

/// Counts the cells opened.
struct Counted<'a, A>(A, &'a Counter<usize>);

impl<A: Accelerator> Accelerator for Counted<'_, A> {
    type Traversal = A::Traversal;
    fn primitives(&self) -> u32 {
        self.0.primitives()
    }
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }
    fn traverse(&self, ray: &PreparedRay) -> A::Traversal {
        self.0.traverse(ray)
    }
}

impl<A: Hierarchy> Hierarchy for Counted<'_, A> {
    type Node = A::Node;
    type Leaf = A::Leaf;
    fn root(&self) -> Option<Cell<A::Node>> {
        self.0.root()
    }
    fn open(&self, cell: &Cell<A::Node>) -> Inside<A::Node, A::Leaf> {
        self.1.set(self.1.get() + 1);
        self.0.open(cell)
    }
}

/// Counts the triangles looked at.
struct Looked<'a>(Mesh<'a>, &'a Counter<usize>);

impl Primitives for Looked<'_> {
    fn len(&self) -> u32 {
        self.0.len()
    }
    fn bounds(&self, index: u32) -> Aabb {
        self.1.set(self.1.get() + 1);
        self.0.bounds(index)
    }
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.0.intersect(index, ray, span)
    }
    fn is_certified(&self, index: u32) -> bool {
        self.0.is_certified(index)
    }
}

impl Proximity for Looked<'_> {
    fn closest_point(&self, number: u32, point: Vec3) -> Option<Vec3> {
        self.0.closest_point(number, point)
    }
    fn approach(&self, index: u32, probe: &Probe) -> Option<Hit> {
        self.0.approach(index, probe)
    }
}

/// Hills of 2 * 64 * 64 triangles.
fn hills() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |i: u32| {
        Vec3::new((i % 65) as f32, ((i % 65) as f32 * 0.3).sin() * ((i / 65) as f32 * 0.2).cos(), (i / 65) as f32)
    };
    let corner = |i: u32| i / 64 * 65 + i % 64;
    let triangles = (0..64 * 64).map(corner).flat_map(|c| [[c, c + 1, c + 65], [c + 1, c + 66, c + 65]]).collect();
    ((0..65 * 65).map(at).collect(), triangles)
}

#[test]
fn few_cells_are_opened() {
    let (vertices, triangles) = hills();
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut memory = vec![0; Plan::all().map(|plan| plan.words(triangles.len())).max().unwrap()];
    for plan in Plan::all().skip(1) {
        let structure = Structure::build(&mesh, &mut Arena::new(&mut memory), &plan).unwrap();
        let (cells, looks) = (Counter::new(0), Counter::new(0));
        let scene = Scene::new(Counted(structure, &cells), Looked(mesh, &looks)).unwrap();
        let mut random = Random::new(5);
        for _ in 0..200 {
            let p = Vec3::new(random.unit(), 0.0, random.unit()) * 64.0 + Vec3::Y * (random.unit() * 3.0 - 1.5);
            assert!(scene.nearest_point(p, f32::INFINITY).is_some());
        }
        let (opened, looked) = (cells.get() / 200, looks.get() / 200);
        assert!(opened < 200 && looked < 100, "{opened} cells and {looked} triangles a query: {plan:?}");
        cells.set(0);
        assert_eq!(scene.nearest_point(Vec3::splat(500.0), 300.0), None);
        assert_eq!(cells.get(), 1, "{plan:?}");
    }
}
