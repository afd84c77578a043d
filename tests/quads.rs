//! Triangles in pairs: they are the same, hits at pairs are those at triangles, and assets of them are read or refused.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use std::collections::BTreeSet;

use common::{
    Random, adversarial_mesh, adversarial_ray, bits,
    closed::Closed,
    meshes::sheet,
    rays,
    seal::{every_byte, every_length, every_lie, place, sealed},
    seed,
};
use hitscan::{
    Error, LatticeMesh, List, Mesh, Primitives, Ray, Scene,
    accel::{Plan, Structure},
    asset::{Asset, Kind},
    bake::{self, Baker},
    bvh, dualsplit,
    glam::Vec3,
    grid, kdtree, octree,
    primitives::{Indices, MeshError, Meshlets, Proximity, QuadMesh, Sides, Smooth},
};

/// The corners in an order that begins with the least.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
}

#[test]
fn triangles_stay_as_they_were_but_for_their_first_corner() {
    let mut random = Random::new(91);
    for count in [0, 1, 2, 3, 63, 64, 65, 127, 128, 129, 1000] {
        for vertices in [3, 12, 40, 257] {
            let places: Vec<Vec3> = (0..vertices).map(|n| Vec3::new(n as f32, (n * n % 17) as f32, 1.0)).collect();
            let triangles: Vec<[u32; 3]> = (0..count).map(|_| [0; 3].map(|_| random.below(vertices) as u32)).collect();
            let pairs = bake::pairs(&Mesh::new(&places, &triangles[..]).unwrap());
            let quads = bake::quads(&pairs.corners[..]).unwrap();
            let (indices, order) = (quads.indices(), &quads.order);
            assert_eq!((indices.len(), pairs.corners.len()), (pairs.numbers.len(), pairs.numbers.len()));
            assert_eq!(pairs.numbers.iter().copied().collect::<BTreeSet<_>>(), (0..count).collect());
            let mut met = BTreeSet::new();
            for (triangle, &number) in (0..).zip(&pairs.numbers) {
                let corners = indices.get(triangle).unwrap().map(|vertex| order[vertex as usize]);
                assert_eq!(corners, pairs.corners[triangle as usize]);
                if met.insert(number) {
                    assert_eq!(turned(corners), turned(triangles[number as usize]));
                } else {
                    // What follows a triangle without partner has no area.
                    assert_eq!((triangle % 2, pairs.numbers[triangle as usize - 1]), (1, number));
                    assert_eq!(corners[1], corners[2]);
                }
            }
            assert_eq!(indices.get(indices.len() as u32), None);
        }
    }
}

#[test]
fn nearly_all_triangles_find_a_partner() {
    for side in [1, 2, 7, 30] {
        let (vertices, mut triangles) = sheet(side);
        let count = triangles.len();
        Random::new(92).shuffle(&mut triangles);
        assert_eq!(bake::pairs(&Mesh::new(&vertices, &triangles[..]).unwrap()).numbers.len(), count, "side {side}");
    }
    // Petersen's theorem: of closed meshes all could.
    let (mut random, mut all, mut stored) = (Random::new(94), 0, 0);
    for _ in 0..200 {
        let Closed { vertices, mut triangles, .. } = Closed::new(&mut random, 1.0, Vec3::ZERO);
        // Some are of triangles that share no vertex, only places.
        if vertices.len() >= triangles.len() {
            continue;
        }
        random.shuffle(&mut triangles);
        all += triangles.len();
        stored += bake::pairs(&Mesh::new(&vertices, &triangles[..]).unwrap()).numbers.len();
    }
    assert!(all > 5_000 && stored < all * 1_002 / 1_000, "{stored} {all}");
    // A fan around a triangle: three neighbours want the same partner.
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE, Vec3::NEG_X, Vec3::NEG_Y];
    let star = [[0_u16, 1, 2], [2, 1, 3], [0, 2, 4], [1, 0, 5]];
    assert_eq!(bake::pairs(&Mesh::new(&vertices, &star).unwrap()).numbers.len(), 6);
    // Faces that look in opposite directions across an edge share none.
    let opposed = [[0_u16, 1, 2], [1, 2, 3]];
    assert_eq!(bake::pairs(&Mesh::new(&vertices, &opposed).unwrap()).numbers.len(), 4);
    // As they stand they are no pairs.
    assert_eq!(bake::quads(&opposed).unwrap_err(), MeshError::Quads);
    assert_eq!(bake::quads(&star[..3]).unwrap_err(), MeshError::Quads);
}

/// A plan for half as many primitives as there are triangles.
fn plan(random: &mut Random) -> Plan {
    random.pick(&[
        Plan::Grid(grid::Options::small()),
        Plan::Grid(grid::Options::fast()),
        Plan::KdTree(kdtree::Options::fast()),
        Plan::CompactKdTree(kdtree::Options::balanced()),
        Plan::DualSplit(dualsplit::Options::balanced()),
        Plan::Octree(octree::Options::balanced()),
        Plan::Bvh(bvh::Options::balanced()),
        Plan::List,
    ])
}

/// Hits, distances and surfaces of pairs against those of the list of their triangles.
#[test]
fn answers_are_those_of_single_triangles() {
    let (mut random, mut hits, mut folded) = (Random::new(93 + 100 * seed()), 0, 0);
    for round in 0..rays(60_000) / 60 {
        let family = random.below(4);
        let (mut vertices, mut triangles) = adversarial_mesh(&mut random, family, 90);
        // Enough edges in common.
        if round % 2 == 0 {
            let (first, (more, corners)) = (vertices.len() as u32, sheet(5));
            vertices.extend(more.iter().map(|&place| place * 0.25 - 0.5));
            triangles.extend(corners.iter().map(|corners| corners.map(|vertex| vertex + first)));
        }
        let Ok(mesh) = Mesh::new(&vertices, &triangles[..]) else { continue };
        let pairs = bake::pairs(&mesh);
        let quads = bake::quads(&pairs.corners[..]).unwrap();
        let moved = quads.vertices(&vertices);
        let sides = random.pick(&[Sides::Both, Sides::Front]);
        let masks: Vec<u32> = pairs.numbers.iter().map(|_| random.pick(&[1, 2, 3])).collect();
        let mesh = Mesh::new(&moved, quads.indices()).unwrap().with_sides(sides).with_masks(&masks).unwrap();
        let snapped = bake::lattice(&mesh);
        let plan = plan(&mut random);
        let pairs = QuadMesh::new(mesh).unwrap();
        assert_eq!((pairs.len() * 2, pairs.numbers()), (mesh.len(), mesh.len()));
        let structure = |words| match plan.kind() {
            None => Structure::from(List::new(&pairs).unwrap()),
            Some(kind) => Structure::open(kind, words).unwrap(),
        };
        let words = bake::build(&pairs, &plan).unwrap();
        let (scene, list) =
            (Scene::new(structure(&words), pairs).unwrap(), Scene::new(List::new(&mesh).unwrap(), mesh).unwrap());
        let on_lattice = snapped.mesh(mesh.indices()).ok().map(|mesh| mesh.with_sides(sides));
        let on_lattice = on_lattice.map(|mesh| {
            let pairs = QuadMesh::new(mesh).unwrap();
            let list = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
            (bake::build(&pairs, &plan).unwrap(), pairs, list)
        });
        for _ in 0..60 {
            let ray = adversarial_ray(&mut random, family, &vertices).seeing(random.pick(&[1, 2, u32::MAX]));
            let hit = list.closest_hit(&ray);
            assert_eq!(bits(scene.closest_hit(&ray)), bits(hit), "{ray:?} {plan:?}");
            assert_eq!(scene.any_hit(&ray), hit.is_some(), "{ray:?} {plan:?}");
            let all = [scene.hits(&ray).collect::<Vec<_>>(), list.hits(&ray).collect()];
            assert!(all[0].iter().map(|&hit| bits(Some(hit))).eq(all[1].iter().map(|&hit| bits(Some(hit)))), "{ray:?}");
            folded += all[0].windows(2).filter(|pair| pair[0].primitive / 2 == pair[1].primitive / 2).count();
            if let Some(hit) = hit {
                hits += 1;
                assert_eq!(format!("{:?}", scene.surface(&ray, &hit)), format!("{:?}", list.surface(&ray, &hit)));
            }
            let nearest = list.nearest_point(ray.origin, f32::INFINITY);
            assert_eq!(scene.nearest_point(ray.origin, f32::INFINITY), nearest, "{:?}", ray.origin);
            if let Some((words, pairs, list)) = &on_lattice
                && plan.kind().is_some()
            {
                let scene = Scene::new(structure(words), pairs).unwrap();
                assert_eq!(bits(scene.closest_hit(&ray)), bits(list.closest_hit(&ray)), "{ray:?} {plan:?}");
            }
        }
    }
    assert!(hits > 1000 && folded > 10, "{hits} {folded}");
}

#[test]
fn only_pairs_are_quads_and_numbers_out_of_range_are_missed() {
    let (vertices, triangles) = sheet(3);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    assert_eq!(QuadMesh::new(mesh).unwrap_err(), MeshError::Quads);
    let quads = bake::quads(&bake::pairs(&mesh).corners[..]).unwrap();
    let moved = quads.vertices(&vertices);
    let mesh = Mesh::new(&moved, quads.indices()).unwrap();
    let normals = vec![Vec3::Y; moved.len()];
    let smooth = Smooth::new(mesh, &normals);
    let pairs = QuadMesh::new(smooth).unwrap();
    assert_eq!(pairs.mesh().len(), 18);
    let ray = Ray::new(Vec3::new(1.2, 20.0, 1.3), Vec3::NEG_Y);
    let scenes = (
        Scene::new(List::new(&pairs).unwrap(), pairs).unwrap(),
        Scene::new(List::new(&smooth).unwrap(), smooth).unwrap(),
    );
    let hit = scenes.0.closest_hit(&ray).unwrap();
    assert_eq!(scenes.1.closest_hit(&ray), Some(hit));
    assert_eq!(scenes.0.surface(&ray, &hit).shading_normal, scenes.1.surface(&ray, &hit).shading_normal);
    for beyond in [9, 1 << 31, u32::MAX] {
        assert!(pairs.clip(beyond, &pairs.bounds(0)).is_none() || pairs.bounds(beyond).size() == Vec3::ZERO);
        assert_eq!(QuadMesh::new(mesh).unwrap().closest_point(beyond.saturating_mul(2), Vec3::ONE), None);
    }
}

fn baked(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u32> {
    let quads = bake::quads(&bake::pairs(&Mesh::new(vertices, triangles).unwrap()).corners[..]).unwrap();
    let vertices = quads.vertices(vertices);
    let mesh = Mesh::new(&vertices, quads.indices()).unwrap();
    let words = bake::build(&QuadMesh::new(mesh).unwrap(), &Plan::Grid(grid::Options::small())).unwrap();
    Baker::new().mesh(&mesh).structure(Structure::open(Kind::Grid, &words).unwrap()).finish()
}

/// Opens the quads of an asset and, if they open, casts rays at them.
fn exercise(words: &[u32]) -> Result<(), Error> {
    let asset = Asset::from_words(words)?;
    let scene: Scene<Structure, QuadMesh<Mesh>> = asset.scene()?;
    let mesh = *scene.primitives().mesh();
    for index in 0..mesh.len() {
        let _ = scene.closest_hit(&Ray::between(Vec3::splat(2.0), mesh.triangle(index).a));
    }
    Ok(())
}

#[test]
fn sections_are_read_back_or_refused() {
    for side in [1, 6, 13] {
        let (vertices, triangles) = sheet(side);
        let words = baked(&vertices, &triangles);
        let asset = Asset::from_words(&words).unwrap();
        let section = asset.section(Kind::Quads).unwrap();
        assert_eq!(section.len(), 1 + (triangles.len() / 2).div_ceil(64) + triangles.len() / 2);
        let mesh: Mesh = asset.read().unwrap();
        assert!(matches!(mesh.indices(), Indices::Quads(_)));
        assert_eq!(mesh.len() as usize, triangles.len());
        exercise(&words).unwrap();
        // A structure over pairs is none over triangles.
        assert!(matches!(asset.scene::<Structure, Mesh>(), Err(Error::Mismatch(_))));
        assert!(asset.read::<LatticeMesh>().is_err());

        // Counts that lie.
        for (lie, damaged) in every_lie(&words, place(&words, section), 64) {
            assert!(exercise(&damaged).is_err(), "{lie}");
        }
    }
    let (vertices, triangles) = sheet(2);
    let words = baked(&vertices, &triangles);
    assert!(every_length(&words).all(|shorter| exercise(&shorter).is_err()));
    let (mut refused, mut harmless) = (0, 0);
    for damaged in every_byte(&words) {
        match exercise(&sealed(damaged)) {
            Ok(()) => harmless += 1,
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 5_000 && harmless > 5_000, "{refused} {harmless}");
    assert!(Meshlets::new(&[], &[[0_u8; 4]]).is_err());
}
