//! Queries in whole numbers: every structure answers as the list, and closed meshes do not leak.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{Random, bits, meshes, plans, rays, seed};
use hitscan::{
    CompactKdTree, DualSplit, LatticeMesh, LatticeScene, List, Mesh, Ray, Scene,
    accel::{LatticeAccelerator, Plan},
    asset::{Asset, AssetError, Kind},
    bake::{self, OnLattice},
    dualsplit,
    geometry::{Aabb, LatticeSpace},
    glam::Vec3,
    kdtree,
    lattice_scene::LatticeError,
    primitives::{LatticeTriangles, Order, Renumbering, Reordered, Sides},
    query::ItemBuffer,
    render::{Camera, Caster, Color, Light, Renderer, Tile},
    scene::Mismatch,
};

/// Vertices on few planes, close together, all over the lattice, or of large and small triangles at once.
fn numbers(random: &mut Random, count: usize) -> Vec<[u16; 3]> {
    let (planes, scale) = random.pick(&[(65_535, 1), (4, 16_000), (3, 1), (1000, 1), (2, 65_534), (40, 7)]);
    let base = [0; 3].map(|_| random.below(65_535 - (planes - 1) * scale) as u16);
    (0..count)
        .map(|_| {
            if random.one_in(10) {
                [0; 3].map(|_| random.below(65_535) as u16)
            } else {
                [0, 1, 2].map(|k| base[k] + (random.below(planes) * scale) as u16)
            }
        })
        .collect()
}

/// A ray at corners, edges and planes of the triangles, or anywhere.
fn ray(random: &mut Random, mesh: &LatticeMesh<'_>, positions: &[Vec3]) -> Ray {
    let size = mesh.frame().size();
    let corners = mesh.indices().get(random.below(mesh.indices().len()) as u32).unwrap();
    let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
    let anywhere = |random: &mut Random| {
        let unit = Vec3::from_array([0; 3].map(|_| random.unit() * 3.0 - 1.0));
        mesh.frame().min + size * unit
    };
    let aim = |random: &mut Random| match random.below(5) {
        0 => random.pick(&[a, b, c]),
        1 => a.lerp(b, random.pick(&[0.5, 0.25])),
        2 => a.lerp(b.lerp(c, random.unit()), random.unit()),
        3 => random.pick(positions),
        _ => anywhere(random),
    };
    let target = aim(random);
    let mut origin = if random.one_in(3) { aim(random) } else { anywhere(random) };
    if random.one_in(20) {
        origin = target + (origin - target) * 1.0e4;
    }
    let mut direction = target - origin;
    match random.below(6) {
        0 => {
            // Along an axis, or almost.
            let axis = random.below(3);
            direction = Vec3::splat(random.pick(&[0.0, -0.0, 1.0e-9, -1.0e-5, 3.0e-5])) * size;
            direction[axis] = random.pick(&[1.0, -2.0]) * size[axis];
            origin = target;
            if random.one_in(2) {
                origin[axis] = mesh.frame().min[axis] - direction[axis];
            }
        }
        1 => {
            let diagonal = Vec3::from_array([0; 3].map(|_| random.below(3) as f32 - 1.0));
            direction = diagonal * size;
            origin = target - direction * random.below(3) as f32;
        }
        _ => {}
    }
    let intervals = [(f32::NEG_INFINITY, f32::INFINITY), (-1.0, 1.0), (1.0, f32::INFINITY), (-3.0, -0.25), (0.0, 0.5)];
    let (t_min, t_max) = intervals.get(random.below(9)).copied().unwrap_or((0.0, f32::INFINITY));
    Ray::new(origin, direction).starting_at(t_min).up_to(t_max).seeing(random.pick(&[1, 2, 3]))
}

#[derive(Default)]
struct Count {
    cast: usize,
    hits: usize,
}

fn compare<A: LatticeAccelerator>(
    random: &mut Random,
    mesh: &LatticeMesh<'_>,
    accelerator: A,
    plan: &Plan,
    count: &mut Count,
) {
    let positions: Vec<Vec3> = mesh.positions().collect();
    let scene = LatticeScene::new(accelerator, mesh).unwrap();
    let list = LatticeScene::new(List::new(mesh).unwrap(), mesh).unwrap();
    for _ in 0..400 {
        let ray = ray(random, mesh, &positions);
        let expected = list.closest_hit(&ray);
        count.cast += 1;
        count.hits += usize::from(expected.is_some());
        assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{plan:?} {ray:?} {:?}", mesh.vertices());
        assert_eq!(scene.any_hit(&ray), expected.is_some(), "{plan:?} {ray:?} {:?}", mesh.vertices());
        assert_eq!(list.any_hit(&ray), expected.is_some(), "{plan:?} {ray:?}");
    }
}

#[test]
fn every_structure_answers_as_the_list() {
    for kind in [3, 4] {
        let mut random = Random::new(kind as u64 + 100 * seed());
        let mut memory = vec![0; 1 << 16];
        let mut count = Count::default();
        while count.cast < rays(1_000_000) / 2 {
            let vertices = 3 + random.below(40);
            let numbers = numbers(&mut random, vertices);
            let triangles: Vec<[u16; 3]> =
                (0..1 + random.below(60)).map(|_| [0; 3].map(|_| random.below(vertices) as u16)).collect();
            let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[1, 2, 3, 3])).collect();
            let frame = random.pick(&[
                Aabb::new(Vec3::ZERO, Vec3::ONE),
                Aabb::new(Vec3::splat(-32_768.0), Vec3::splat(32_767.0)),
                Aabb::new(Vec3::new(-3.0, 100.0, -7.0), Vec3::new(9.0, 104.0, -1.0)),
                Aabb::new(Vec3::new(1.0e9, -5.0, 0.0), Vec3::new(2.0e9, 5.0, 1.0e-9)),
            ]);
            let mesh = LatticeMesh::new(&frame, &numbers, &triangles[..]).unwrap();
            let mesh = mesh.with_masks(&masks).unwrap().with_sides(random.pick(&[Sides::Both, Sides::Front]));
            let Some((plan, built)) = plans::build(&mut random, kind, &mesh, &mut memory) else { continue };
            let words = built.as_words();
            if kind == 3 {
                compare(&mut random, &mesh, CompactKdTree::open(words).unwrap(), &plan, &mut count);
            } else {
                compare(&mut random, &mesh, DualSplit::open(words).unwrap(), &plan, &mut count);
            }
        }
        let Count { cast, hits } = count;
        assert!(hits * 6 > cast, "{hits} of {cast}");
    }
}

/// A camera anywhere: among the triangles, near and far, along axes and not.
fn camera(random: &mut Random, mesh: &LatticeMesh<'_>, positions: &[Vec3]) -> Camera {
    let (size, middle) = (mesh.frame().size(), mesh.frame().center());
    let anywhere = |random: &mut Random, scale: f32| {
        middle + size * Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale))
    };
    let mut target = random.pick(positions);
    let scale = random.pick(&[1.0, 3.0, 8.0, 50.0, 1.0e4]);
    let eye = match random.below(3) {
        0 => random.pick(positions),
        1 => anywhere(random, scale),
        // Near a triangle.
        _ => target + size * Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * random.pick(&[0.1, 1.0e-3]))),
    };
    if random.one_in(4) {
        let axis = random.below(3);
        target = eye;
        target[axis] += random.pick(&[1.0, -1.0]) * size[axis];
    }
    let up = random.pick(&[Vec3::Y, Vec3::X, Vec3::Z, Vec3::new(0.3, 1.0, -0.2)]);
    let fov = random.pick(&[0.8, 0.8, 0.3, 0.05, 2.5, 1.0e-3, 1.0e-4, 3.1]);
    Camera::pinhole(eye, target, up, fov)
}

/// All rays of a tile at once hit what each hits by itself: rays that hit something, and whether they were at once.
fn same_at_once<A: LatticeAccelerator, P: LatticeTriangles>(
    scene: &LatticeScene<A, P>,
    camera: &Camera,
    tile: &Tile,
    picture: [u32; 2],
    what: &dyn Fn() -> String,
) -> Option<u32> {
    let [width, height] = picture;
    let pencil = camera.pencil(tile, width, height)?;
    let mut hits = ItemBuffer::new();
    if !scene.closest_hits(&pencil, &mut hits) {
        return None;
    }
    let mut found = 0;
    for (x, y) in tile.pixels() {
        let (column, row) = (x - tile.x, y - tile.y);
        let plain = scene.closest_hit(&camera.ray(x as f32 + 0.5, y as f32 + 0.5, width, height));
        let at_once = hits.get(column, row);
        assert_eq!(bits(at_once), bits(plain), "{camera:?} {tile:?} {picture:?} {column} {row} {}", what());
        found += u32::from(plain.is_some());
    }
    Some(found)
}

#[test]
fn rays_of_a_tile_hit_at_once_what_they_hit_alone() {
    let mut random = Random::new(5 + 100 * seed());
    let mut memory = vec![0; 1 << 16];
    let (mut tiles, mut at_once, mut hits) = (0, 0, 0);
    while tiles < rays(1_000_000) / 10 {
        let vertices = 3 + random.below(40);
        let numbers = numbers(&mut random, vertices);
        let triangles: Vec<[u16; 3]> =
            (0..1 + random.below(60)).map(|_| [0; 3].map(|_| random.below(vertices) as u16)).collect();
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[0, 1, 3, u32::MAX])).collect();
        let frame = random.pick(&[
            Aabb::new(Vec3::ZERO, Vec3::ONE),
            Aabb::new(Vec3::ZERO, Vec3::ONE),
            Aabb::new(Vec3::splat(-32_768.0), Vec3::splat(32_767.0)),
            Aabb::new(Vec3::new(-3.0, 100.0, -7.0), Vec3::new(9.0, 104.0, -1.0)),
            Aabb::new(Vec3::new(1.0e9, -5.0, 0.0), Vec3::new(2.0e9, 5.0, 1.0e-9)),
        ]);
        let mesh = LatticeMesh::new(&frame, &numbers, &triangles[..]).unwrap();
        let mesh = mesh.with_masks(&masks).unwrap().with_sides(random.pick(&[Sides::Both, Sides::Front]));
        let positions: Vec<Vec3> = mesh.positions().collect();
        let kind = random.pick(&[3, 4]);
        let Some((plan, built)) = plans::build(&mut random, kind, &mesh, &mut memory) else { continue };
        let words = built.as_words();
        for _ in 0..20 {
            let camera = camera(&mut random, &mesh, &positions);
            let picture @ [width, height] = random.pick(&[[240, 240], [64, 48], [8, 8], [1, 1], [2000, 30], [7, 7]]);
            let at = |random: &mut Random, side: u32| match random.below(2) {
                0 => (side / 2) & !7,
                _ => random.below(side as usize) as u32,
            };
            let (x, y) = (at(&mut random, width), at(&mut random, height));
            let [columns, rows] = random.pick(&[[8, 8], [8, 8], [1, 1], [7, 7], [8, 1], [3, 5]]);
            let tile = Tile { x, y, width: columns.min(width - x), height: rows.min(height - y) };
            let what = || format!("{plan:?} {mesh:?}");
            let found = if kind == 3 {
                let scene = LatticeScene::new(CompactKdTree::open(words).unwrap(), &mesh).unwrap();
                same_at_once(&scene, &camera, &tile, picture, &what)
            } else {
                let scene = LatticeScene::new(DualSplit::open(words).unwrap(), &mesh).unwrap();
                same_at_once(&scene, &camera, &tile, picture, &what)
            };
            tiles += 1;
            at_once += usize::from(found.is_some());
            hits += found.unwrap_or(0) as usize;
        }
    }
    assert!(at_once * 3 > tiles && hits > tiles, "{hits} hits, {at_once} of {tiles} tiles");
}

/// A closed surface: a cube of `side`² squares on each face, pushed out to a bumpy ball.
fn ball(side: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices: Vec<Vec3> = Vec::new();
    let mut triangles = Vec::new();
    let mut number = |v: Vec3| match vertices.iter().position(|&other| other == v) {
        Some(place) => place as u32,
        None => {
            vertices.push(v);
            vertices.len() as u32 - 1
        }
    };
    for face in 0..6 {
        let corner = |i: u32, j: u32| {
            let at = |i: u32| i as f32 / side as f32 * 2.0 - 1.0;
            let height = if face < 3 { 1.0 } else { -1.0 };
            let mut v = [at(i) * height, at(j), height];
            v.rotate_left(face % 3);
            Vec3::from_array(v)
        };
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let [a, b, c, d] =
                [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)].map(&mut number);
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    let bumpy = |v: Vec3| v / v.length() * (1.0 + 0.2 * (v.x * 5.0).sin() * (v.y * 7.0).cos());
    (vertices.into_iter().map(bumpy).collect(), triangles)
}

#[test]
fn closed_meshes_do_not_leak() {
    let (vertices, triangles) = ball(12);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let snapped = bake::lattice(&mesh);
    let mesh = snapped.mesh(&mesh).unwrap();
    let words = bake::build(&mesh, &Plan::DualSplit(dualsplit::Options::fast())).unwrap();
    let scene = LatticeScene::new(DualSplit::open(&words).unwrap(), &mesh).unwrap();
    let positions: Vec<Vec3> = mesh.positions().collect();
    let mut random = Random::new(3 + 100 * seed());
    for _ in 0..rays(1_000_000) / 2 {
        // From inside, most at corners and along edges.
        let origin = Vec3::from_array([0; 3].map(|_| random.unit() - 0.5)) * 0.8;
        let corners = mesh.indices().get(random.below(triangles.len()) as u32).unwrap();
        let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
        let target = match random.below(3) {
            0 => a,
            1 => a.lerp(b, random.unit()),
            _ => a.lerp(b.lerp(c, random.unit()), random.unit()),
        };
        let ray = Ray::new(origin, target - origin);
        let hit = scene.closest_hit(&ray);
        assert!(hit.is_some_and(|hit| hit.t > 0.0) && scene.any_hit(&ray), "{ray:?} {hit:?}");
        // It leaves the surface once more often than it enters it.
        assert!(scene.closest_hit(&Ray { direction: -ray.direction, ..ray }).is_some(), "{ray:?}");
    }
}

fn picture<S: Caster>(scene: &S, camera: Camera, side: u32) -> Vec<[u8; 3]> {
    let lights = [Light::directional(Vec3::new(-1.0, -2.0, -0.5), Vec3::ONE)];
    let renderer = Renderer::new(scene, camera, side, side).with_lights(&lights).with_bounces(1);
    let mut pixels = vec![[0; 3]; (side * side) as usize];
    renderer.fill(Tile { x: 0, y: 0, width: side, height: side }, &mut pixels).unwrap();
    let alone = |(x, y)| <[u8; 3]>::from_linear(renderer.pixel(x, y));
    let whole = Tile { x: 0, y: 0, width: side, height: side };
    assert!(whole.pixels().map(alone).eq(pixels.iter().copied()), "tiles differ from their pixels");
    pixels
}

#[test]
fn pictures_are_those_of_the_list_and_nearly_those_of_floats() {
    let (vertices, triangles) = ball(6);
    // A plate below, on which the ball casts its shadow.
    let (mut vertices, mut triangles) = (vertices, triangles);
    let first = vertices.len() as u32;
    vertices.extend([(-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -2.0)].map(|(x, z)| Vec3::new(x, -1.3, z)));
    triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let snapped = bake::lattice(&mesh);
    let mesh = snapped.mesh(&mesh).unwrap();
    let list = LatticeScene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let words = bake::build(&mesh, &Plan::DualSplit(dualsplit::Options::fast())).unwrap();
    let tree = LatticeScene::new(DualSplit::open(&words).unwrap(), &mesh).unwrap();
    let floats = Scene::new(DualSplit::open(&words).unwrap(), &mesh).unwrap();
    for (from, side) in
        [(Vec3::new(1.0, 0.8, 2.0), 48), (Vec3::new(0.1, 3.0, -0.2), 32), (Vec3::new(-5.0, 0.3, 0.0), 32)]
    {
        // All of it, and a part in whose tiles there is something everywhere.
        for camera in
            [Camera::framing(&floats.bounds(), from, Vec3::Y), Camera::pinhole(from * 1.5, Vec3::ZERO, Vec3::Y, 0.3)]
        {
            let shown = picture(&tree, camera, side);
            assert_eq!(shown, picture(&list, camera, side));
            // Shadows of surfaces on themselves would be dark dots.
            let exact = picture(&floats, camera, side);
            let differ = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 12);
            let off = shown.iter().zip(&exact).filter(|&pair| differ(pair)).count();
            assert!(off * 50 < shown.len(), "{off} of {} pixels", shown.len());
        }
    }
}

#[test]
fn hits_are_those_of_the_float_scene_to_a_step() {
    for (vertices, triangles) in [ball(9), meshes::sheet(20), meshes::random(300, 0.4)] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let snapped = bake::lattice(&mesh);
        let mesh = snapped.mesh(&mesh).unwrap();
        let float = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let whole = LatticeScene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let step = (mesh.frame().size() / 65_535.0).max_element();
        let mut random = Random::new(3);
        let (mut cast, mut same, mut near) = (0, 0, 0);
        for _ in 0..20_000 {
            let point = |random: &mut Random, scale: f32| {
                let unit = Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
                mesh.frame().center() + mesh.frame().size() * unit
            };
            let (origin, target) = (point(&mut random, 3.0), point(&mut random, 1.0));
            let ray = Ray::new(origin, (target - origin).normalize());
            let (a, b) = (float.closest_hit(&ray), whole.closest_hit(&ray));
            cast += 1;
            same += usize::from(a.map(|hit| hit.primitive) == b.map(|hit| hit.primitive));
            if let (Some(a), Some(b)) = (a, b)
                && a.primitive == b.primitive
            {
                near += usize::from((a.t - b.t).abs() < step * 8.0);
            } else {
                near += usize::from(a.is_none() && b.is_none());
            }
        }
        assert!(same * 1000 > cast * 995 && near * 1000 > cast * 985, "{same} {near} of {cast}");
    }
}

#[test]
fn rows_are_as_rays_for_themselves() {
    let (vertices, triangles) = ball(9);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let snapped = bake::lattice(&mesh);
    let mesh = snapped.mesh(&mesh).unwrap();
    let scene = LatticeScene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let (mut cast, mut same, mut hits) = (0, 0, 0);
    for (eye, forward) in [
        (Vec3::new(0.3, 0.1, -4.0), Vec3::Z),
        (Vec3::new(0.2, 9.0, 1.0), Vec3::new(0.1, -3.0, 0.0)),
        (Vec3::ZERO, Vec3::X),
    ] {
        for y in 0..40 {
            let (first, step) = (forward + Vec3::new(-0.5, 0.0, y as f32 / 40.0 - 0.5), Vec3::X / 100.0);
            let row = scene.space().rays(eye, first, step, 100);
            assert_eq!(row.len(), 100);
            for (x, ray) in row.enumerate() {
                let single = Ray::new(eye, first + step * x as f32);
                let hit = ray.and_then(|ray| scene.closest_hit_along(&ray));
                let expected = scene.closest_hit(&single);
                cast += 1;
                hits += usize::from(hit.is_some());
                same += usize::from(match (hit, expected) {
                    (Some(a), Some(b)) => a.primitive == b.primitive && (a.t - b.t).abs() < 1.0e-3,
                    (None, None) => true,
                    _ => false,
                });
            }
        }
    }
    assert!(hits * 3 > cast && same * 1000 > cast * 997, "{same} and {hits} of {cast}");
    assert_eq!(scene.space().rays(Vec3::NAN, Vec3::Z, Vec3::X, 9).count(), 0);
    assert!(scene.space().rays(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, 9).all(|ray| ray.is_none()));
}

#[test]
fn ties_are_decided_by_the_owners_numbers() {
    let frame = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let numbers = [[0, 0, 30_000], [60_000, 0, 30_000], [0, 60_000, 30_000_u16]];
    let mesh = LatticeMesh::new(&frame, &numbers, &[[0_u16, 1, 2]; 3]).unwrap();
    let ray = Ray::new(Vec3::new(0.2, 0.2, 2.0), Vec3::NEG_Z);
    let hit = |hit: Option<hitscan::Hit>| hit.map(|hit| hit.primitive);
    assert_eq!(hit(LatticeScene::new(List::new(&mesh).unwrap(), mesh).unwrap().closest_hit(&ray)), Some(0));
    let renumbering = Renumbering::new(Order::Narrow(&[1, 2, 0]), Order::Narrow(&[2, 0, 1])).unwrap();
    let reordered = Reordered::new(mesh, renumbering).unwrap();
    let scene = LatticeScene::new(List::new(&reordered).unwrap(), reordered).unwrap();
    assert_eq!(hit(scene.closest_hit(&ray)), Some(0));
    assert_eq!(hit(scene.closest_hit(&ray.up_to(1.0))), None);
}

#[test]
fn what_is_not_on_one_lattice_is_refused() {
    let frame = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let numbers = [[0, 0, 0], [60_000, 0, 30_000], [0, 60_000, 30_000], [5, 5, 65_535_u16]];
    let error = |frame: &Aabb, triangles: &[[u16; 3]], over: &Aabb| {
        let mesh = LatticeMesh::new(frame, &numbers, triangles).unwrap();
        let other = LatticeMesh::new(over, &numbers, triangles).unwrap();
        LatticeScene::new(List::new(&other).unwrap(), mesh).map(|_| ()).err()
    };
    assert_eq!(error(&frame, &[[0, 1, 2]], &frame), None);
    assert_eq!(error(&frame, &[], &frame), None);
    let larger = Aabb::new(Vec3::ZERO, Vec3::splat(1.5));
    assert_eq!(error(&frame, &[[0, 1, 2]], &larger), Some(LatticeError::Frame));
    // The last plane lies outside.
    let uneven = Aabb::new(Vec3::ZERO, Vec3::splat(1.1));
    assert_eq!(error(&uneven, &[[0, 1, 3]], &uneven), Some(LatticeError::Frame));
    let far = Aabb::new(Vec3::splat(1000.0), Vec3::splat(1001.0));
    assert_eq!(error(&far, &[[0, 1, 2]], &far), Some(LatticeError::TooFine));
    let (one, two) = ([[0_u16, 1, 2]], [[0_u16, 1, 2]; 2]);
    let (one, two) =
        (LatticeMesh::new(&frame, &numbers, &one).unwrap(), LatticeMesh::new(&frame, &numbers, &two).unwrap());
    let mismatch = LatticeError::Mismatch(Mismatch { structure: 1, primitives: 2 });
    assert_eq!(LatticeScene::new(List::new(&one).unwrap(), two).map(|_| ()), Err(mismatch));
    let flat = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0));
    assert!(LatticeSpace::over(&flat).is_none() && LatticeSpace::over(&Aabb::EMPTY).is_none());
}

#[test]
fn assets_give_the_scene_that_was_baked() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]).unwrap();
    let on_lattice = bake::lattice(&mesh);
    let mesh = on_lattice.mesh(mesh.indices()).unwrap();
    let words = bake::build(&mesh, &Plan::CompactKdTree(kdtree::Options::small())).unwrap();
    let tree = CompactKdTree::open(&words).unwrap();
    let baked = bake::Baker::new().lattice_mesh(&mesh).structure(tree).finish();
    let asset = Asset::open(bytemuck::cast_slice(&baked)).unwrap();
    let scene = asset.lattice_scene::<CompactKdTree<'_>, LatticeMesh<'_>>().unwrap();
    let direct = LatticeScene::new(tree, mesh).unwrap();
    let ray = Ray::new(Vec3::ONE, Vec3::NEG_ONE);
    assert!(direct.closest_hit(&ray).is_some());
    assert_eq!(bits(scene.closest_hit(&ray)), bits(direct.closest_hit(&ray)));
    let other = asset.lattice_scene::<DualSplit<'_>, LatticeMesh<'_>>();
    assert_eq!(other.map(|_| ()), Err(AssetError::Missing { kind: Kind::DualSplit }.into()));
}

#[test]
fn invalid_rays_miss() {
    let OnLattice { frame, vertices, .. } =
        bake::lattice(&Mesh::new(&[Vec3::ZERO, Vec3::X, Vec3::ONE], &[[0_u16, 1, 2]]).unwrap());
    let mesh = LatticeMesh::new(&frame, &vertices, &[[0_u16, 1, 2]]).unwrap();
    let words = bake::build(&mesh, &Plan::CompactKdTree(kdtree::Options::fast())).unwrap();
    let scene = LatticeScene::new(CompactKdTree::open(&words).unwrap(), &mesh).unwrap();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1.0e38, 1.0e-45, 0.0, -0.0, 0.3];
    for code in 0..9_usize.pow(6) {
        let at = |place: u32| odd[code / 9_usize.pow(place) % 9];
        let ray = Ray::new(Vec3::new(at(0), at(1), at(2)), Vec3::new(at(3), at(4), at(5)));
        let hit = scene.closest_hit(&ray);
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            assert_eq!(hit, None, "{ray:?}");
        }
        assert_eq!(scene.any_hit(&ray), hit.is_some(), "{ray:?}");
    }
    let through = Ray::new(Vec3::new(0.6, 0.3, -1.0), Vec3::new(0.0, 0.0, 1.0));
    assert!(scene.any_hit(&through));
    for (t_min, t_max) in [(f32::NAN, 1.0), (0.0, f32::NAN), (2.0, 1.9), (f32::INFINITY, f32::INFINITY)] {
        assert!(!scene.any_hit(&through.starting_at(t_min).up_to(t_max)), "{t_min} {t_max}");
    }
}
