//! Placed scenes: whatever is placed how often, mirrored or skewed, and however deep, all queries answer as a gather of all
//! hits does, and as the triangles themselves would where they are placed.
#![allow(missing_docs)]

mod common;
#[path = "instances/deep.rs"]
mod deep;

use std::cell::Cell;

use common::{Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, point, rays, seed};
use hitscan::{
    Accelerator, Arena, Hit, Instance, Instances, KdTree, List, Mesh, PreparedRay, Primitives, Ray, Scene, Span,
    accel::{Plan, Structure},
    from_fn,
    geometry::{Aabb, Transform, Triangle},
    glam::{Mat3, Vec3},
    instances::InstanceError,
    kdtree::Options,
    primitives::Counted,
    query::Progress,
};

/// A linear part: turned, mirrored, stretched, skewed, or as it was.
fn linear(random: &mut Random) -> Mat3 {
    let turn = Mat3::from_rotation_z(random.unit() * 6.0) * Mat3::from_rotation_x(random.unit() * 6.0);
    match random.below(6) {
        0 => Mat3::IDENTITY,
        1 => Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 2.0)),
        2 => Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X),
        3 => turn,
        4 => turn * Mat3::from_diagonal(Vec3::new(0.1, -3.0, 1.0)),
        _ => Mat3::from_cols(Vec3::X, Vec3::new(random.unit() * 4.0, 1.0, 0.0), Vec3::new(0.0, -2.0, 1.0)),
    }
}

fn transform(random: &mut Random, family: usize) -> Transform {
    loop {
        let translation = if random.one_in(3) { Vec3::ZERO } else { point(random, family) };
        if let Ok(transform) = Transform::new(linear(random), translation) {
            return transform;
        }
    }
}

/// What is in a scene, for who gathers: shapes, or placed scenes.
enum Content<'a> {
    Shapes(&'a dyn Fn(u32, &Ray) -> Vec<f32>, u32),
    Placed(Vec<(Instance, Aabb, &'a Content<'a>)>),
}

impl Content<'_> {
    fn numbers(&self) -> u32 {
        match self {
            Self::Shapes(_, count) => *count,
            Self::Placed(placed) => placed.iter().map(|(_, _, content)| content.numbers()).sum(),
        }
    }

    /// All hits of the line; where reciprocals overflow, bounds are looser for rays that may reach back.
    fn gather(&self, line: &Ray) -> Vec<Hit> {
        match self {
            Self::Shapes(crossings, count) => (0..*count)
                .flat_map(|primitive| crossings(primitive, line).into_iter().map(move |t| Hit { t, primitive }))
                .collect(),
            Self::Placed(placed) => {
                let (mut hits, mut first) = (vec![], 0);
                for (instance, bounds, content) in placed {
                    let local = instance.transform().ray_back(line).starting_at(f32::NEG_INFINITY).up_to(f32::INFINITY);
                    let interval = line.prepare().and_then(|ray| bounds.interval(&ray));
                    if let (Some((enter, exit)), true) = (interval, local.prepare().is_some()) {
                        hits.extend(content.gather(&local).into_iter().map(|hit| {
                            let t = if hit.t < enter { enter } else { hit.t };
                            Hit { t: if t > exit { exit } else { t }, primitive: hit.primitive + first }
                        }));
                    }
                    first += content.numbers();
                }
                hits
            }
        }
    }
}

/// The hits of a ray in order.
fn expected(content: &Content, ray: &Ray) -> Vec<Hit> {
    let Some(prepared) = ray.prepare() else { return vec![] };
    let Ray { t_min, t_max, .. } = *prepared.ray();
    let mut hits = content.gather(ray);
    hits.retain(|hit| hit.t >= t_min && hit.t <= t_max);
    hits.sort_by(|a, b| a.t.partial_cmp(&b.t).unwrap().then(a.primitive.cmp(&b.primitive)));
    hits.dedup();
    hits
}

fn bits_of(hits: &[Hit]) -> Vec<Option<(u32, u32)>> {
    hits.iter().map(|&hit| bits(Some(hit))).collect()
}

/// Asks in every way.
fn compare<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, ray: &Ray, expected: &[Hit]) {
    let first = expected.first().copied();
    assert_eq!(bits(scene.closest_hit(ray)), bits(first), "{ray:?}");
    assert_eq!(scene.any_hit(ray), first.is_some(), "{ray:?}");
    let all: Vec<Hit> = scene.hits(ray).take(30).collect();
    assert_eq!(bits_of(&all), bits_of(&expected[..expected.len().min(30)]), "{ray:?}");
    let keep = |hit: &Hit| hit.primitive % 2 == 1;
    assert_eq!(bits(scene.closest_hit_where(ray, keep)), bits(expected.iter().copied().find(keep)), "{ray:?}");
    assert_eq!(scene.any_hit_where(ray, keep), expected.iter().any(keep), "{ray:?}");
    let mut three: heapless::Vec<Hit, 3> = heapless::Vec::new();
    scene.nearest_hits(ray, &mut three);
    assert_eq!(bits_of(&three), bits_of(&expected[..expected.len().min(3)]), "{ray:?}");
    for budget in [1, 2, 5] {
        let mut query = scene.begin(ray);
        let paused = loop {
            if let Progress::Done(hit) = query.advance(budget) {
                break hit;
            }
        };
        assert_eq!(bits(paused), bits(first), "{budget} {ray:?}");
    }
}

fn place<'a, A: Accelerator, P: Primitives>(
    random: &mut Random,
    family: usize,
    scenes: &'a [Scene<A, P>],
    placed: &'a mut Vec<Instance>,
) -> Instances<'a, A, P> {
    let count = random.below(6);
    placed.extend((0..count).map(|_| Instance::new(random.below(scenes.len()) as u32, transform(random, family))));
    Instances::place(scenes, placed).unwrap()
}

fn content<'a, A: Accelerator, P: Primitives>(
    instances: &Instances<'_, A, P>,
    contents: &[&'a Content<'a>],
) -> Content<'a> {
    let bounds = |i| instances.bounds(i);
    let placed = instances.placed().iter().zip(0..).map(|(&p, i)| (p, bounds(i), contents[p.scene() as usize]));
    Content::Placed(placed.collect())
}

#[test]
fn every_query_at_every_depth_answers_as_a_gather() {
    let rays = rays(60_000);
    let mut random = Random::new(11 + 100 * seed());
    let mut memories: [Vec<u32>; 4] = [(); 4].map(|()| vec![0; 1 << 15]);
    let (mut cast, mut hits) = (0, 0);
    while cast < rays {
        let family = random.pick(&[0, 1, 2, 3, 4, 5, 6, 10]);
        let random = &mut random;
        let [a, b, c, d] = memories.each_mut();
        let (vertices, triangles) = adversarial_mesh(random, family, 12);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let boxes: Vec<Aabb> = (0..random.below(4)).map(|_| boxed(random, family)).collect();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i, ray)));
        let both = (mesh, others);
        let crossings = |primitive: u32, line: &Ray| -> Vec<f32> {
            let ray = line.prepare().unwrap();
            if primitive < mesh.len() {
                return mesh.triangle(primitive).intersect(&ray, f32::MIN, f32::MAX).map(|c| c.t).into_iter().collect();
            }
            let index = primitive - mesh.len();
            let Some((enter, exit)) = boxes[index as usize].interval(&ray) else { return vec![] };
            // NaN is no hit, wherever it is clamped to.
            let t = noise(index, line);
            let t = if t < enter { enter } else { t };
            if t.is_nan() { vec![] } else { vec![if t > exit { exit } else { t }] }
        };
        let shapes = Content::Shapes(&crossings, both.numbers());

        let tree = KdTree::build(&both, &mut Arena::new(a), &Options::fast()).unwrap();
        let scenes = [Scene::new(tree, &both).unwrap()];
        let (mut lower, mut upper) = (vec![], vec![]);
        let once = place(random, family, &scenes, &mut lower);
        let once_content = content(&once, &[&shapes]);
        let once_tree = KdTree::build(&once, &mut Arena::new(b), &Options::fast()).unwrap();
        let once_scenes = [Scene::new(once_tree, once).unwrap()];
        let twice = place(random, family, &once_scenes, &mut upper);
        let twice_content = content(&twice, &[&once_content]);
        let twice_tree = KdTree::build(&twice, &mut Arena::new(c), &Options::fast()).unwrap();
        let twice_scene = Scene::new(twice_tree, twice).unwrap();
        let twice_list = Scene::new(List::new(&twice).unwrap(), twice).unwrap();

        // Beside shapes that are not placed.
        let mixed = (&both, once);
        let mixed_tree = KdTree::build(&mixed, &mut Arena::new(d), &Options::fast()).unwrap();
        let mixed_scene = Scene::new(mixed_tree, &mixed).unwrap();
        for _ in 0..60 {
            let ray = adversarial_ray(random, family, &vertices);
            let [one, two] = [&once_content, &twice_content].map(|content| expected(content, &ray));
            compare(&once_scenes[0], &ray, &one);
            compare(&twice_scene, &ray, &two);
            compare(&twice_list, &ray, &two);
            let first = bits(mixed_scene.closest_hit(&ray));
            let offset = one.first().map(|hit| Hit { primitive: hit.primitive + both.numbers(), ..*hit });
            let direct = expected(&shapes, &ray).first().copied();
            let best = match (direct, offset) {
                (Some(a), Some(b)) => Some(if b.precedes(&a) { b } else { a }),
                (a, b) => a.or(b),
            };
            assert_eq!(first, bits(best), "{ray:?}");
            cast += 1;
            hits += usize::from(!two.is_empty());
        }
    }
    assert!(hits * 20 > cast, "{hits} of {cast}");
}

/// What is farther away than a parameter can say is missed, placed or not: there is no telling on which side of it a ray passes.
#[test]
fn shapes_beyond_all_parameters_are_missed_at_any_depth() {
    const FAR: f32 = 3.0e15;
    let near = Aabb::new(Vec3::new(-0.1, -0.1, -0.2), Vec3::new(0.2, 0.1, 0.2));
    // Makes the bounds of all so loose that the ray meets them where it passes far from the other.
    let far = Aabb::new(Vec3::new(-FAR, FAR, -FAR), Vec3::new(-FAR, FAR, -FAR));
    let shapes = || from_fn(2, |i| [near, far][i as usize], |_, _| Some(0.0));
    let tree = |memory| KdTree::build(&shapes(), &mut Arena::new(memory), &Options::fast()).unwrap();
    let mut memory = [0; 4096];
    let linear = Mat3::from_cols(Vec3::X, Vec3::new(1.5202489, 1.0, 0.0), Vec3::new(0.0, -2.0, 1.0));
    let transform = Transform::new(linear, Vec3::new(0.0, 0.1, 0.2)).unwrap();
    let scenes = [Scene::new(tree(&mut memory), shapes()).unwrap()];
    let mut placed = [Instance::new(0, transform)];
    let instances = Instances::place(&scenes, &mut placed).unwrap();
    let scene = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
    let origin = Vec3::new(-FAR, FAR, -FAR);
    for sign in [1.0, -1.0] {
        let ray = Ray::new(origin, Vec3::new(8.077936e-28, 0.0, -8.077936e-28) * sign).starting_at(f32::NEG_INFINITY);
        assert!(instances.bounds(0).interval(&ray.prepare().unwrap()).is_some());
        assert_eq!((scene.closest_hit(&ray), scene.any_hit(&ray)), (None, false));
        assert_eq!(scene.hits(&ray).count(), 0);
        let local = transform.ray(&ray);
        assert_eq!(scenes[0].closest_hit(&local), None);
    }
}

/// A shape that takes itself for certified and is hit far behind its bounds; it spares itself what is too far away.
struct Distant(Aabb);

impl Primitives for Distant {
    fn len(&self) -> u32 {
        1
    }

    fn bounds(&self, _index: u32) -> Aabb {
        self.0
    }

    fn intersect(&self, index: u32, _ray: &PreparedRay, span: &Span) -> Option<Hit> {
        const T: f32 = 9.0;
        if T > span.t_max() { None } else { span.accept(T, index) }
    }

    fn is_certified(&self, _index: u32) -> bool {
        true
    }
}

/// What is hit behind the end of an instance counts where that ends: it must be looked for behind the best hit (rule R6).
#[test]
fn the_best_hit_is_passed_down_only_before_the_end_of_an_instance() {
    let slab = |z: f32| Aabb::new(Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, 1.0, z));
    let scenes = [Scene::new(List::new(&Distant(slab(1.0))).unwrap(), Distant(slab(1.0))).unwrap()];
    let mut placed = [Instance::new(0, Transform::IDENTITY)];
    let both = (from_fn(1, |_| slab(1.5), |_, _| Some(1.5)), Instances::place(&scenes, &mut placed).unwrap());
    let hit =
        Scene::new(List::new(&both).unwrap(), &both).unwrap().closest_hit(&Ray::new(Vec3::ZERO, Vec3::Z)).unwrap();
    assert!(hit.primitive == 1 && (1.0..1.001).contains(&hit.t), "{hit:?}");
}

#[test]
fn hits_and_surfaces_are_those_of_the_triangles_where_they_are_placed() {
    let mut random = Random::new(12);
    let (mut agreed, mut all) = (0, 0);
    for _ in 0..300 {
        let (vertices, triangles) = adversarial_mesh(&mut random, 2, 10);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let scenes = [Scene::new(List::new(&mesh).unwrap(), mesh).unwrap()];
        let place = Transform::new(linear(&mut random), point(&mut random, 2) * 3.0).unwrap();
        let mut placed = [Instance::new(0, place)];
        let instances = Instances::place(&scenes, &mut placed).unwrap();
        let scene = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
        let corners: Vec<Vec3> = vertices.iter().map(|&v| place.point(v)).collect();
        let flat = Mesh::new(&corners, &triangles[..]).unwrap();
        let flat_scene = Scene::new(List::new(&flat).unwrap(), flat).unwrap();
        for _ in 0..40 {
            let origin = point(&mut random, 2) * 5.0;
            let target = flat.triangle(random.below(triangles.len()) as u32);
            let Triangle { a, b, c } = target;
            let ray = Ray::new(origin, a * 0.25 + b * 0.25 + c * 0.5 - origin);
            let (Some(one), Some(other)) = (scene.closest_hit(&ray), flat_scene.closest_hit(&ray)) else { continue };
            all += 1;
            let Triangle { a, b, c } = flat.triangle(other.primitive);
            let longest = (b - a).length().max((c - a).length()).max((c - b).length());
            if (b - a).cross(c - a).length() < 0.01 * longest * longest {
                // Where a ray crosses a sliver is anyone's guess.
                all -= 1;
                continue;
            }
            if one.primitive != other.primitive {
                continue;
            }
            agreed += 1;
            let (placed, flat) = (scene.surface(&ray, &one), flat_scene.surface(&ray, &other));
            // In the triangle's plane and on the ray; along a ray that grazes the plane no more can be said.
            let size = placed.point.abs().max_element() + ray.origin.abs().max_element();
            let off_plane = (placed.point - a).dot(flat.geometric_normal).abs();
            let off_ray = (placed.point - ray.at(one.t)).length();
            assert!(off_plane < 1.0e-5 * size && off_ray < 1.0e-4 * size, "{placed:?} {flat:?}");
            let slope = ray.direction.normalize().dot(flat.geometric_normal).abs();
            assert!((one.t - other.t).abs() * slope < 1.0e-5 * other.t.abs().max(1.0), "{one:?} {other:?}");
            // Mirrored corners run the other way round, but the front stays the front.
            let normals = placed.geometric_normal.dot(flat.geometric_normal).abs();
            assert!(normals > 0.99, "{placed:?} {flat:?}");
            assert_eq!(placed.front, ray.direction.dot(placed.geometric_normal) < 0.0);
        }
    }
    assert!(agreed * 100 > all * 95 && all > 1000, "{agreed} of {all}");
}

#[test]
fn rays_that_leave_a_placed_surface_do_not_meet_it_again() {
    let mut random = Random::new(13);
    let vertices = [Vec3::new(-1.0, -1.0, 0.1), Vec3::new(2.0, -0.7, -0.3), Vec3::new(0.1, 1.5, 0.4)];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
    let scenes = [Scene::new(List::new(&mesh).unwrap(), mesh).unwrap()];
    for _ in 0..20_000 {
        let far = if random.one_in(2) { 1.0e5 } else { 1.0 };
        let place = Transform::new(linear(&mut random), point(&mut random, 2) * far).unwrap();
        let mut placed = [Instance::new(0, place)];
        let instances = Instances::place(&scenes, &mut placed).unwrap();
        let scene = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
        let target = place.point(vertices[0] * 0.3 + vertices[1] * 0.3 + vertices[2] * 0.4);
        let origin = target + (point(&mut random, 2)) * 20.0;
        let ray = Ray::new(origin, target - origin);
        let Some(hit) = scene.closest_hit(&ray) else { continue };
        let surface = scene.surface(&ray, &hit);
        let normal = surface.normal_towards_ray();
        let away = (normal + point(&mut random, 2) * 0.5).normalize_or(normal);
        if away.dot(normal) > 0.1 {
            let next = Ray::new(surface.start_towards(away), away);
            assert!(!scene.any_hit(&next), "{place:?} {ray:?} {surface:?} {next:?}");
        }
    }
}

#[test]
fn masks_are_those_of_the_instance_and_of_the_primitive() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 2]]).unwrap().with_masks(&[0b01, 0b10]).unwrap();
    let scenes = [Scene::new(List::new(&mesh).unwrap(), mesh).unwrap()];
    let at = |z: f32| Transform::new(Mat3::IDENTITY, Vec3::Z * z).unwrap();
    let mut placed = [Instance::new(0, at(1.0)).with_mask(0b10), Instance::new(0, at(2.0)).with_mask(0b01)];
    let instances = Instances::place(&scenes, &mut placed).unwrap();
    let scene = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
    let ray = Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z);
    let seen = |mask| scene.hits(&ray.seeing(mask)).map(|hit| hit.primitive).collect::<Vec<_>>();
    assert_eq!([seen(0b01), seen(0b10), seen(0b11), seen(0)], [vec![2], vec![1], vec![0, 1, 2, 3], vec![]]);
}

#[test]
fn what_cannot_be_placed_is_named() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
    let scenes = [Scene::new(List::new(&mesh).unwrap(), mesh).unwrap()];
    let at = |x: f32| Transform::new(Mat3::IDENTITY, Vec3::X * x).unwrap();
    let place = |placed: &mut [Instance]| Instances::place(&scenes, placed).map(|_| ());
    assert_eq!(place(&mut []), Ok(()));
    let missing = InstanceError::Scene { instance: 1, scene: 7, scenes: 1 };
    assert_eq!(place(&mut [Instance::new(0, at(0.0)), Instance::new(7, at(0.0))]), Err(missing));
    assert_eq!(place(&mut [Instance::new(0, at(2.0e38))]), Err(InstanceError::Place { instance: 0 }));
    assert!(Transform::new(Mat3::from_cols(Vec3::X, Vec3::X, Vec3::Z), Vec3::ZERO).is_err());
    assert!(Transform::new(Mat3::IDENTITY, Vec3::NAN).is_err());
    let numbered = [Instance::new(0, at(0.0)), Instance::new(0, at(0.0))];
    assert_eq!(Instances::new(&scenes, &numbered).map(|_| ()), Err(InstanceError::Number { instance: 1 }));
}

#[test]
fn an_empty_scene_can_be_placed_and_is_never_hit() {
    let nothing = from_fn(0, |_| Aabb::EMPTY, |_, _| None);
    let scenes = [Scene::new(List::new(&nothing).unwrap(), &nothing).unwrap()];
    let mut placed = [Instance::new(0, Transform::IDENTITY); 3];
    let instances = Instances::place(&scenes, &mut placed).unwrap();
    let mut memory = vec![0; 4096];
    let tree = KdTree::build(&instances, &mut Arena::new(&mut memory), &Options::fast()).unwrap();
    let scene = Scene::new(tree, instances).unwrap();
    assert!(!scene.any_hit(&Ray::new(Vec3::NEG_Z, Vec3::Z)));
    assert_eq!(instances.locate(0), None);
}

#[test]
fn a_placed_scene_takes_about_as_many_tests_as_by_itself() {
    let side = 40_u16;
    let height = |x: u16, y: u16| (f32::from(x) * 0.4).sin() + (f32::from(y) * 0.3).cos();
    let vertices: Vec<Vec3> =
        (0..=side).flat_map(|y| (0..=side).map(move |x| Vec3::new(f32::from(x), f32::from(y), height(x, y)))).collect();
    let corners: Vec<[u16; 3]> = (0..side * side)
        .flat_map(|n| {
            let a = n / side * (side + 1) + n % side;
            [[a, a + 1, a + side + 1], [a + side + 2, a + side + 1, a + 1]]
        })
        .collect();
    let mesh = Mesh::new(&vertices, &*corners).unwrap();
    let place = Transform::new(linear(&mut Random::new(3)), Vec3::new(70.0, -40.0, 9.0)).unwrap();
    let mut random = Random::new(21);
    let rays: Vec<Ray> = (0..200)
        .map(|_| {
            let target = Vec3::new(random.unit(), random.unit(), 0.5) * f32::from(side);
            let origin = target + Vec3::new(random.unit() * 80.0 - 40.0, 30.0, 60.0);
            Ray::new(origin, target - origin)
        })
        .collect();
    let mut memory = vec![0; 1 << 18];
    for plan in Plan::all() {
        let tests = Cell::new(0);
        let counted = Counted::new(&mesh, &tests);
        let structure = Structure::build(&counted, &mut Arena::new(&mut memory), &plan).unwrap();
        let scenes = [Scene::new(structure, counted).unwrap()];
        let hits = rays.iter().filter(|ray| scenes[0].closest_hit(ray).is_some()).count();
        let alone = tests.replace(0);
        let mut placed = [Instance::new(0, place)];
        let instances = Instances::place(&scenes, &mut placed).unwrap();
        let scene = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
        let there = rays.iter().filter(|ray| scene.closest_hit(&place.ray(ray)).is_some()).count();
        assert!(hits > 50 && there.abs_diff(hits) < 3, "{plan:?}: {there} of {hits}");
        assert!(tests.get() < alone * 11 / 10, "{plan:?}: {} tests in place of {alone}", tests.get());
    }
}
