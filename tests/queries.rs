//! Every query, on every structure, against a gather of all hits that knows nothing of structures.
#![allow(missing_docs)]

mod common;

use std::cell::Cell;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, coordinate, noise, plans, point};
use hitscan::{
    Accelerator, Arena, Hit, KdTree, List, Mesh, PreparedRay, Primitives, Ray, Scene, Span,
    accel::{self, Mailbox},
    from_fn,
    geometry::{Aabb, Sphere, Triangle},
    glam::Vec3,
    kdtree::Options,
    primitives::{self, Sides, Spheres},
    query::{Progress, Wanted},
};

/// Horizontal layers in a box: a shape of our own with many hits and careless parameters.
#[derive(Clone, Copy, Debug)]
struct Stack {
    bounds: Aabb,
    layers: usize,
}

impl Stack {
    fn crossings(&self, ray: &Ray) -> Vec<f32> {
        let Aabb { min, max } = self.bounds;
        let layer = |i: usize| min.z + (max.z - min.z) * (i as f32 / self.layers as f32);
        let mut t: Vec<f32> = (0..=self.layers).map(|i| (layer(i) - ray.origin.z) / ray.direction.z).collect();
        t.retain(|&t| self.bounds.contains(ray.at(t).with_z(min.z)));
        t.sort_by(f32::total_cmp);
        t
    }
}

struct Stacks(Vec<Stack>);

impl Primitives for Stacks {
    fn len(&self) -> u32 {
        self.0.len() as u32
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.0[index as usize].bounds
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.0[index as usize].crossings(ray.ray()).into_iter().find_map(|t| span.accept(t, index))
    }

    fn mask(&self, index: u32) -> u32 {
        1 << (index % 3)
    }
}

/// What the gather knows of a primitive.
enum Shape {
    Triangle(Triangle, Sides),
    Sphere(Sphere),
    Stack(Stack),
}

impl Shape {
    /// All parameters at which the line of the ray meets it.
    fn crossings(&self, ray: &PreparedRay) -> Vec<f32> {
        let (t, bounds) = match self {
            Self::Triangle(triangle, sides) => {
                let crossing = triangle.intersect(ray, f32::MIN, f32::MAX);
                let seen = crossing.filter(|crossing| *sides == Sides::Both || crossing.front);
                return seen.map(|crossing| crossing.t).into_iter().collect();
            }
            Self::Sphere(sphere) => (sphere.intersect(ray).map_or(vec![], Vec::from), sphere.bounds()),
            Self::Stack(stack) => (stack.crossings(ray.ray()), stack.bounds),
        };
        let Some((enter, exit)) = bounds.interval(ray) else { return vec![] };
        t.into_iter().map(|t| if t < enter { enter } else { t }).map(|t| if t > exit { exit } else { t }).collect()
    }
}

/// All hits of a ray in order.
fn gather(shapes: &[(Shape, u32)], ray: &Ray) -> Vec<Hit> {
    let Some(ray) = ray.prepare() else { return vec![] };
    let Ray { t_min, t_max, mask, .. } = *ray.ray();
    let seen = (0..).zip(shapes).filter(|(_, (_, shape_mask))| shape_mask & mask != 0);
    let mut hits: Vec<Hit> = seen
        .flat_map(|(primitive, (shape, _))| shape.crossings(&ray).into_iter().map(move |t| Hit { t, primitive }))
        .filter(|hit| hit.t >= t_min && hit.t <= t_max)
        .collect();
    hits.sort_by(|a, b| a.t.partial_cmp(&b.t).unwrap().then(a.primitive.cmp(&b.primitive)));
    hits.dedup();
    hits
}

fn all_bits(hits: impl IntoIterator<Item = Hit>) -> Vec<Option<(u32, u32)>> {
    hits.into_iter().map(|hit| bits(Some(hit))).collect()
}

fn nearest<A: Accelerator, P: Primitives, const N: usize>(scene: &Scene<A, P>, ray: &Ray, expected: &[Hit]) {
    // What was there before is replaced.
    let mut hits: heapless::Vec<Hit, N> = heapless::Vec::new();
    let _ = hits.push(Hit { t: -1.0, primitive: 9 });
    scene.nearest_hits(ray, &mut hits);
    assert_eq!(all_bits(hits), all_bits(expected.iter().copied().take(N)), "{N} {ray:?}");
}

/// Asks in parts of `budget` nodes; the answer and how often it was paused.
fn in_parts<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, ray: &Ray, budget: u32) -> (Option<Hit>, u32) {
    let mut query = scene.begin(ray);
    for pauses in 0.. {
        if let Progress::Done(hit) = query.advance(budget) {
            assert_eq!(query.advance(budget), Progress::Done(hit));
            return (hit, pauses);
        }
    }
    unreachable!()
}

/// Compares all queries with the hits gathered.
fn compare<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, nodes: u32, ray: &Ray, expected: &[Hit]) {
    let first = bits(expected.first().copied());
    assert_eq!(bits(scene.closest_hit(ray)), first, "{ray:?}");
    assert_eq!(scene.any_hit(ray), first.is_some(), "{ray:?}");
    assert_eq!(bits(scene.hit(ray, Wanted::Closest)), first, "{ray:?}");
    let any = scene.hit(ray, Wanted::Any);
    assert!(any.is_some() == first.is_some() && any.is_none_or(|any| expected.contains(&any)), "{any:?} {ray:?}");
    assert_eq!(all_bits(scene.hits(ray)), all_bits(expected.to_vec()), "{ray:?}");
    nearest::<A, P, 0>(scene, ray, expected);
    nearest::<A, P, 1>(scene, ray, expected);
    nearest::<A, P, 2>(scene, ray, expected);
    nearest::<A, P, 3>(scene, ray, expected);
    nearest::<A, P, 4>(scene, ray, expected);
    nearest::<A, P, 5>(scene, ray, expected);
    let middle = expected.get(expected.len() / 2).map_or(0.0, |hit| hit.t);
    let keeps: [&dyn Fn(&Hit) -> bool; 3] =
        [&|hit| hit.primitive % 2 == 1, &|hit| hit.t > middle, &|hit| Some(hit) != expected.first()];
    for keep in keeps {
        let kept = bits(expected.iter().copied().find(keep));
        assert_eq!(bits(scene.closest_hit_where(ray, keep)), kept, "{ray:?}");
        assert_eq!(scene.any_hit_where(ray, keep), kept.is_some(), "{ray:?}");
    }
    for budget in 1..=7 {
        let (hit, pauses) = in_parts(scene, ray, budget);
        assert_eq!(bits(hit), first, "{budget} {ray:?}");
        assert!(pauses * budget <= nodes, "{pauses} pauses of {budget} among {nodes} nodes");
    }
}

fn ball(random: &mut Random, family: usize) -> Sphere {
    let own = coordinate(random, family).abs();
    let radius = random.pick(&[1.0, 0.25, own]);
    Sphere::new(point(random, family), radius.max(f32::from_bits(1)))
}

/// Casts `rays` at many scenes of triangles, spheres and stacks, and compares all queries.
fn cast(rays: usize, seed: u64, with_shapes: bool) {
    let mut random = Random::new(seed);
    let mut memory = vec![0; 1 << 15];
    let (mut count, mut several) = (0, 0);
    while count < rays {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 24);
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[u32::MAX, 1, 2, 6])).collect();
        let sides = random.pick(&[Sides::Both, Sides::Front]);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap().with_sides(sides).with_masks(&masks).unwrap();
        let number = if with_shapes { 1 + random.below(6) } else { 0 };
        let balls: Vec<Sphere> = (0..number).map(|_| ball(&mut random, family)).collect();
        let stacks: Vec<Stack> =
            (0..number).map(|_| Stack { bounds: boxed(&mut random, family), layers: 1 + random.below(9) }).collect();
        let shapes: Vec<(Shape, u32)> = (0..mesh.len())
            .map(|i| (Shape::Triangle(mesh.triangle(i), sides), masks[i as usize]))
            .chain(balls.iter().map(|&ball| (Shape::Sphere(ball), u32::MAX)))
            .chain(stacks.iter().enumerate().map(|(i, &stack)| (Shape::Stack(stack), 1 << (i % 3))))
            .collect();
        let all = ((mesh, Spheres::new(&balls).unwrap()), Stacks(stacks));
        let kind = random.below(plans::KINDS);
        let Some((_, built)) = plans::build(&mut random, kind, &all, &mut memory) else { continue };
        // Whatever a structure counts, there is no more of it than bits.
        let nodes = built.as_words().len() as u32 * 32;
        let list = Scene::new(List::new(&all).unwrap(), &all).unwrap();
        let (scene, mailbox) = (Scene::new(built, &all).unwrap(), Scene::new(Mailbox(built), &all).unwrap());
        for _ in 0..50 {
            let ray = adversarial_ray(&mut random, family, &vertices).seeing(random.pick(&[u32::MAX, 1, 4, 0]));
            let expected = gather(&shapes, &ray);
            compare(&list, all.len(), &ray, &expected);
            compare(&scene, nodes, &ray, &expected);
            compare(&mailbox, nodes, &ray, &expected);
            if !expected.is_empty() {
                // Both ends of the interval belong to it.
                let (first, last) = (random.pick(&expected).t, random.pick(&expected).t);
                for ends in [(first, first), (first, last), (first.next_up(), last), (first, last.next_down())] {
                    let ray = ray.starting_at(ends.0).up_to(ends.1);
                    let expected = gather(&shapes, &ray);
                    compare(&list, all.len(), &ray, &expected);
                    compare(&scene, nodes, &ray, &expected);
                    count += 1;
                }
            }
            count += 1;
            several += usize::from(expected.len() > 8);
        }
    }
    assert!(several * 100 > count || !with_shapes, "{several} of {count}");
}

#[test]
fn queries_of_triangles_agree_with_a_gather() {
    cast(100_000, 1, false);
}

#[test]
fn queries_of_mixed_shapes_agree_with_a_gather() {
    cast(100_000, 2, true);
}

/// Capsules with a careless `f32` test, after Quilez.
#[derive(Clone, Copy)]
struct Capsule {
    a: Vec3,
    b: Vec3,
    radius: f32,
}

impl Capsule {
    fn bounds(&self) -> Aabb {
        Sphere::new(self.a, self.radius).bounds().union(&Sphere::new(self.b, self.radius).bounds())
    }

    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let (ba, oa, d) = (self.b - self.a, ray.origin - self.a, ray.direction);
        let (baba, bard, baoa) = (ba.dot(ba), ba.dot(d), ba.dot(oa));
        let (rdoa, oaoa, dd) = (d.dot(oa), oa.dot(oa), d.dot(d));
        let a = baba * dd - bard * bard;
        let b = baba * rdoa - baoa * bard;
        let c = baba * oaoa - baoa * baoa - self.radius * self.radius * baba;
        let h = b * b - a * c;
        if h >= 0.0 {
            let t = (-b - h.sqrt()) / a;
            let y = baoa + t * bard;
            if y > 0.0 && y < baba {
                return Some(t);
            }
            let o = if y <= 0.0 { oa } else { ray.origin - self.b };
            let (b, c) = (d.dot(o), o.dot(o) - self.radius * self.radius);
            let h = b * b - dd * c;
            return (h > 0.0).then(|| (-b - h.sqrt()) / dd);
        }
        None
    }
}

/// Compares a structure with the list on rays at the corners of the primitives' boxes.
fn structure_is_list<P: Primitives>(
    random: &mut Random,
    family: usize,
    primitives: &P,
    memory: &mut [u32],
    rays: usize,
) {
    let kind = random.below(plans::KINDS);
    let Some((plan, built)) = plans::build(random, kind, primitives, memory) else { return };
    let corners: Vec<Vec3> = (0..primitives.len())
        .map(|i| primitives.bounds(i))
        .flat_map(|b| [b.min, b.max, Vec3::new(b.min.x, b.max.y, b.min.z)])
        .collect();
    let list = Scene::new(List::new(primitives).unwrap(), primitives).unwrap();
    let scene = Scene::new(built, primitives).unwrap();
    for _ in 0..rays {
        let ray = adversarial_ray(random, family, &corners);
        let expected = list.closest_hit(&ray);
        assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{ray:?} {plan:?} {corners:?}");
        assert_eq!(scene.any_hit(&ray), expected.is_some(), "{ray:?}");
    }
}

#[test]
fn own_shapes_in_trees_are_hit_as_in_the_list() {
    let mut random = Random::new(4);
    let mut memory = vec![0; 1 << 15];
    for round in 0..1000 {
        let family = round % FAMILIES;
        let number = 1 + random.below(24) as u32;
        let capsules: Vec<Capsule> = (0..number)
            .map(|_| Capsule {
                a: point(&mut random, family),
                b: point(&mut random, family),
                radius: ball(&mut random, family).radius,
            })
            .collect();
        let capsule = |i: u32| &capsules[i as usize];
        let shapes = from_fn(number, |i| capsule(i).bounds(), |i, ray| capsule(i).intersect(ray));
        structure_is_list(&mut random, family, &shapes, &mut memory, 100);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let shapes = from_fn(number, |i| boxes[i as usize], |i, ray| Some(noise(i, ray)));
        structure_is_list(&mut random, family, &shapes, &mut memory, 100);
    }
}

#[test]
fn shapes_at_the_least_parameters_are_hit_as_in_the_list() {
    // The boxes' widened exits are just above 0, and the exit from the cell around the first must be so too.
    let boxes =
        [Aabb::new(Vec3::X * f32::MIN_POSITIVE, Vec3::ONE), Aabb::new(Vec3::X * -2.0, Vec3::new(-1.0, 1.0, 1.0))];
    let shapes = from_fn(2, |i| boxes[i as usize], |i, _| (i == 0).then_some(0.0));
    let mut memory = vec![0; KdTree::words(2, &Options::fast())];
    let tree = KdTree::build(&shapes, &mut Arena::new(&mut memory), &Options::fast()).unwrap();
    let (list, tree) = (Scene::new(List::new(&shapes).unwrap(), &shapes), Scene::new(tree, &shapes));
    let ray = Ray::new(Vec3::new(0.0, 0.5, 0.5), Vec3::NEG_X);
    assert_eq!(list.unwrap().closest_hit(&ray), Some(Hit { t: 0.0, primitive: 0 }));
    assert_eq!(tree.unwrap().closest_hit(&ray), Some(Hit { t: 0.0, primitive: 0 }));
}

#[test]
fn mixed_scenes_in_trees_are_hit_as_in_the_list() {
    let mut random = Random::new(6);
    let mut memory = vec![0; 1 << 15];
    for round in 0..1000 {
        let family = round % FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 16);
        let balls: Vec<Sphere> = (0..1 + random.below(16)).map(|_| ball(&mut random, family)).collect();
        let both = (Mesh::new(&vertices, &triangles[..]).unwrap(), Spheres::new(&balls).unwrap());
        structure_is_list(&mut random, family, &both, &mut memory, 200);
    }
}

/// How many primitives a query with this budget tests at a row of unit boxes.
fn tests_within<A: Accelerator>(budget: u32, build: impl FnOnce(&dyn Primitives) -> A) -> (u32, Progress) {
    let tests = Cell::new(0);
    let unit = |i: u32| Aabb::new(Vec3::X * i as f32, Vec3::X * i as f32 + 1.0);
    let row = from_fn(20, unit, |_, _| {
        tests.set(tests.get() + 1);
        None
    });
    let scene = Scene::new(build(&row), &row).unwrap();
    let progress = scene.begin(&Ray::new(Vec3::splat(0.5), Vec3::X)).advance(budget);
    (tests.get(), progress)
}

#[test]
fn budgets_bound_the_work() {
    for budget in 0..10 {
        // Each primitive of a list counts as a node.
        let (tests, progress) = tests_within(budget, |row| List::new(row).unwrap());
        assert!(tests <= budget && progress == Progress::Paused, "{tests} tests for {budget} nodes of a list");
        let mut memory = vec![0; KdTree::words(20, &Options::fast())];
        let options = Options { intersection_cost: 100.0, ..Options::fast() };
        let (tests, progress) =
            tests_within(budget, |row| KdTree::build(row, &mut Arena::new(&mut memory), &options).unwrap());
        assert!(tests <= budget && progress == Progress::Paused, "{tests} tests for {budget} nodes of a tree");
    }
}

#[test]
fn pauses_change_neither_counts_nor_hits() {
    let mut random = Random::new(6);
    let mut memory = vec![0; 1 << 15];
    for kind in 0..plans::KINDS {
        let (vertices, triangles) = adversarial_mesh(&mut random, 2, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let Some((plan, built)) = plans::build(&mut random, kind, &mesh, &mut memory) else { continue };
        let (nodes, tests) = (Cell::new(0), Cell::new(0));
        let plain = Scene::new(built, &mesh).unwrap();
        let counted = Scene::new(accel::Counted::new(built, &nodes), primitives::Counted::new(&mesh, &tests)).unwrap();
        let taken = || (nodes.take(), tests.take());
        for _ in 0..50 {
            let ray = adversarial_ray(&mut random, 2, &vertices);
            let hit = counted.closest_hit(&ray);
            assert_eq!(bits(hit), bits(plain.closest_hit(&ray)), "{plan:?}");
            let whole = taken();
            assert!(whole.0 > 0 || hit.is_none());
            let (paused, _) = in_parts(&counted, &ray, 1);
            // Asked once more at its end.
            assert_eq!((bits(paused), taken()), (bits(hit), whole), "{plan:?}");
        }
    }
}
