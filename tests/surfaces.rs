//! What is known of a hit beyond where it is, and decorators that must not change it.
#![cfg(feature = "std")]
#![allow(missing_docs)]

mod common;

use std::cell::Cell;

use common::{Random, adversarial_mesh, adversarial_ray, bits, meshes, plans};
use hitscan::{
    Arena, Grid, Hit, KdTree, List, Mesh, Octree, Primitives, Ray, Scene,
    accel::{self, Plan, Structure},
    asset::{Asset, Kind},
    bake::{self, Baker},
    from_fn,
    geometry::Aabb,
    glam::{Vec2, Vec3},
    grid, kdtree, octree,
    primitives::{self, Order, Renumbering, Reordered, Smooth},
};

fn direction(random: &mut Random) -> Vec3 {
    loop {
        let v = Vec3::new(random.unit(), random.unit(), random.unit()) * 2.0 - 1.0;
        if (0.1..1.0).contains(&v.length()) {
            return v.normalize();
        }
    }
}

#[test]
fn smooth_surfaces_mirror_nothing_into_themselves() {
    let mut random = Random::new(3);
    let (mut blended, mut bent) = (0, 0);
    for _ in 0..4000 {
        let up = direction(&mut random);
        let (x, y) = up.any_orthonormal_pair();
        let vertices = [-x - y, x * 2.0 - y, y * 2.0];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let normals = [0; 3].map(|_| (up + direction(&mut random) * 0.5).normalize());
        let scene = Scene::new(List::new(&mesh).unwrap(), Smooth::new(mesh, &normals)).unwrap();
        // From both sides, and often along the surface.
        let slant = random.pick(&[1.0, 0.1, 0.01]) * random.pick(&[1.0, -1.0]);
        let turn = random.unit() * 6.3;
        let from = up * slant + x * turn.cos() + y * turn.sin();
        let ray = Ray::new(from * 3.0, -from);
        let hit = scene.closest_hit(&ray).unwrap();
        let surface = scene.surface(&ray, &hit);
        assert_eq!(surface.front, slant > 0.0);
        assert!((surface.geometric_normal - up).length() < 1.0e-5);

        let weights = [1.0 - surface.uv.x - surface.uv.y, surface.uv.x, surface.uv.y];
        let blend = (normals[0] * weights[0] + normals[1] * weights[1] + normals[2] * weights[2]).normalize();
        let towards = surface.normal_towards_ray();
        let mirrored = |normal: Vec3| {
            let d = ray.direction.normalize();
            (d - normal * (2.0 * d.dot(normal))).dot(towards)
        };
        let flat = normals.iter().any(|normal| normal.dot(up) < 0.82);
        let expected = if flat { up } else { blend };
        assert!((surface.shading_normal.length() - 1.0).abs() < 1.0e-5);
        assert!(surface.shading_normal.dot(up) > 0.0);
        if flat || mirrored(expected) >= 0.021 {
            assert!((surface.shading_normal - expected).length() < 1.0e-5, "{surface:?} {expected}");
            blended += u32::from(!flat);
        } else if mirrored(expected) < 0.019 {
            // Just above the surface, in the plane of the ray's way and of what it would have been.
            let height = mirrored(surface.shading_normal);
            assert!((0.0199..0.1).contains(&height), "{height} {surface:?}");
            let way = ray.direction.normalize() - expected * (2.0 * ray.direction.normalize().dot(expected));
            let lifted = (way + towards * (0.02 - way.dot(towards))).normalize();
            let half = (lifted - ray.direction.normalize()).normalize() * if surface.front { 1.0 } else { -1.0 };
            assert!((surface.shading_normal - half).length() < 1.0e-4, "{surface:?} {half}");
            bent += 1;
        }
    }
    assert!(blended > 500 && bent > 500, "{blended} {bent}");
}

#[test]
fn shapes_of_which_nothing_is_known_face_the_ray() {
    let bounds = Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0));
    let wall = from_fn(3, |_| bounds, |i, ray: &Ray| Some((i as f32 - ray.origin.z) / ray.direction.z));
    assert_eq!((wall.len(), format!("{wall:?}").as_str()), (3, "FromFn { len: 3, .. }"));
    let scene = Scene::new(List::new(&wall).unwrap(), &wall).unwrap();
    let ray = Ray::new(Vec3::new(0.25, -0.5, 6.0), Vec3::new(0.0, 0.0, -2.0));
    let surface = scene.surface(&ray, &Hit { t: 2.5, primitive: 1 });
    assert_eq!(surface.point, Vec3::new(0.25, -0.5, 1.0));
    assert_eq!((surface.geometric_normal, surface.shading_normal), (Vec3::Z, Vec3::Z));
    assert_eq!((surface.uv, surface.front), (Vec2::ZERO, true));
    // 2^-16 of the coordinates on the way, which are up to 6 + 5.
    assert_eq!(surface.error, 11.0 / 65_536.0);
}

#[test]
fn structures_know_what_they_consist_of() {
    let (vertices, triangles) = meshes::sheet(12);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let words = bake::build(&mesh, &Plan::KdTree(kdtree::Options::balanced())).unwrap();
    let tree = KdTree::open(&words).unwrap();
    assert!((50..words.len()).contains(&tree.node_count()), "{}", tree.node_count());
    let words = bake::build(&mesh, &Plan::Grid(grid::Options::balanced())).unwrap();
    let grid = Grid::open(&words).unwrap();
    assert!((288..words.len() * 4).contains(&grid.reference_count()), "{}", grid.reference_count());
    assert!(grid.resolution().iter().all(|&cells| (1..300).contains(&cells)));
    let words = bake::build(&mesh, &Plan::Octree(octree::Options::balanced())).unwrap();
    let (steps, tests) = Octree::open(&words).unwrap().expected_work();
    assert!(steps > 1.0 && tests > 1.0 && steps < 300.0 && tests < 288.0, "{steps} {tests}");
}

/// All that can be asked of primitives.
fn said(primitives: &impl Primitives, ray: &Ray, hit: Option<Hit>) -> Vec<String> {
    let cell = Aabb::new(Vec3::splat(-0.5), Vec3::splat(0.5));
    let of_one = |i| (primitives.bounds(i), primitives.mask(i), primitives.is_certified(i), primitives.clip(i, &cell));
    let mut said: Vec<String> = (0..primitives.len()).map(|i| format!("{:?}", of_one(i))).collect();
    said.push(format!("{} {} {:?}", primitives.len(), primitives.numbers(), primitives.frame()));
    said.extend(hit.map(|hit| format!("{:?}", primitives.surface(ray, &hit))));
    said
}

#[test]
fn who_counts_changes_nothing() {
    let mut random = Random::new(8);
    let (mut memory, mut again) = (vec![0; 1 << 15], vec![0; 1 << 15]);
    let (nodes, tests) = (Cell::new(0), Cell::new(0));
    let mut surfaces = 0;
    for round in 0..20 * plans::KINDS {
        let (vertices, triangles) = adversarial_mesh(&mut random, 2, 20);
        let masks: Vec<u32> = triangles.iter().map(|_| random.next()).collect();
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap().with_masks(&masks).unwrap();
        let order: Vec<u32> = (0..mesh.len()).rev().collect();
        let renumbering = Renumbering::new(Order::Wide(&order), Order::Wide(&order)).unwrap();
        let reordered = Reordered::new(mesh, renumbering).unwrap();
        let counted = primitives::Counted::new(&reordered, &tests);
        let plan = plans::random(&mut random, round % plans::KINDS);
        let Ok(plain) = Structure::build(&reordered, &mut Arena::new(&mut memory), &plan) else { continue };
        let built = Structure::build(&counted, &mut Arena::new(&mut again), &plan).unwrap();
        assert_eq!(plain.as_words(), built.as_words(), "{plan:?}");

        let expected = Scene::new(plain, &reordered).unwrap();
        let scene = Scene::new(accel::Counted::new(built, &nodes), &counted).unwrap();
        let near = Scene::new(plain, &mesh).unwrap();
        let near_counted = Scene::new(accel::Counted::new(built, &nodes), &mesh).unwrap();
        assert_eq!(bounds(scene.bounds()), bounds(expected.bounds()));
        for _ in 0..10 {
            let mut ray = adversarial_ray(&mut random, 2, &vertices);
            ray.mask = random.next() & random.next();
            let hit = expected.closest_hit(&ray);
            assert_eq!(bits(scene.closest_hit(&ray)), bits(hit));
            surfaces += usize::from(hit.is_some());
            assert_eq!(said(&counted, &ray, hit), said(&reordered, &ray, hit));
            assert_eq!(near_counted.nearest_point(ray.origin, 9.0), near.nearest_point(ray.origin, 9.0));
        }
    }
    assert!(surfaces > 100 && nodes.get() > 1000 && tests.get() > 1000, "{surfaces} {nodes:?} {tests:?}");
}

fn bounds(aabb: Aabb) -> [Vec3; 2] {
    [aabb.min, aabb.max]
}

#[test]
fn orders_are_as_narrow_as_their_numbers() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for (count, bytes) in [(1, 2), (2, 2), (3, 2), (65_536, 2), (65_537, 4)] {
        let corners = vec![[0_u32, 1, 2]; count];
        let mesh = Mesh::new(&vertices, &corners[..]).unwrap();
        let order: Vec<u32> = (0..count as u32).rev().collect();
        let words = Baker::new().mesh(&mesh).numbers(&order).finish();
        let asset = Asset::from_words(&words).unwrap();
        assert_eq!(asset.section(Kind::Numbers).unwrap().len(), 1 + 2 * (count * bytes).div_ceil(4), "{count}");
        let reordered: Reordered<Mesh> = asset.read().unwrap();
        let scene = Scene::new(List::new(&reordered).unwrap(), reordered).unwrap();
        // All are in one place: the owner's first is the last here.
        let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
        assert_eq!(scene.closest_hit(&ray).map(|hit| hit.primitive), Some(0), "{count}");
        let last = scene.closest_hit_where(&ray, |hit| hit.primitive as usize == count - 1);
        assert!(last.is_some(), "{count}");
    }
}
