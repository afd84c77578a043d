//! Corners in bytes: the triangles are the same, their vertices few more, and assets of them are read or refused.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{
    Random, adversarial_mesh, adversarial_ray, bits,
    meshes::sheet,
    rays,
    seal::{every_byte, every_length, every_lie, place, sealed},
};
use hitscan::{
    Error, LatticeMesh, LatticeScene, List, Mesh, Primitives, Ray, Scene,
    accel::{Plan, Structure},
    asset::{Asset, Kind},
    bake::{self, Baker},
    bvh, dualsplit,
    glam::Vec3,
    grid,
    primitives::{Indices, MeshError, Meshlets},
};

#[test]
fn triangles_stay_as_they_were() {
    let mut random = Random::new(81);
    for count in [0, 1, 2, 63, 64, 65, 127, 128, 129, 1000] {
        for vertices in [3, 40, 256, 257, 5000] {
            let triangles: Vec<[u32; 3]> = (0..count).map(|_| [0; 3].map(|_| random.below(vertices) as u32)).collect();
            let meshlets = bake::meshlets(&triangles[..]);
            assert_eq!(meshlets.indices().len(), count);
            for (triangle, corners) in (0..).zip(&triangles) {
                let [a, b, c] = meshlets.indices().get(triangle).unwrap();
                assert_eq!([a, b, c].map(|vertex| meshlets.order[vertex as usize]), *corners);
            }
            assert_eq!(meshlets.indices().get(count as u32), None);
            let numbers: Vec<u32> = (0..vertices as u32).collect();
            assert_eq!(meshlets.vertices(&numbers), meshlets.order);
        }
    }
    // Numbers that no list of vertices is as long as.
    let far = [[u32::MAX, 0, u32::MAX - 1]];
    assert_eq!(bake::meshlets(&far).order, [u32::MAX, 0, u32::MAX - 1]);
}

#[test]
fn few_vertices_stand_several_times_if_triangles_are_neighbours() {
    let (vertices, triangles) = sheet(60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    assert!(bake::meshlets(&mesh).order.len() <= vertices.len() * 102 / 100);
    let mut triangles = triangles;
    Random::new(82).shuffle(&mut triangles);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    assert!(bake::meshlets(&mesh).order.len() > vertices.len() * 4);
    // The order of a hierarchy's leaves mends that.
    let words = bake::build(&mesh, &Plan::Bvh(bvh::Options::fast())).unwrap();
    let near = bake::reorder(&mesh, &hitscan::Bvh::open(&words).unwrap().order().collect::<Vec<_>>());
    assert!(bake::meshlets(&near[..]).order.len() <= vertices.len() * 8 / 7);
}

#[test]
fn a_first_vertex_belongs_to_each_64_triangles() {
    for (meshlets, triangles) in [(0, 1), (1, 0), (1, 65), (2, 64), (3, 128)] {
        let (first, corners) = (vec![0; meshlets], vec![[0; 3]; triangles]);
        assert_eq!(Meshlets::new(&first, &corners), Err(MeshError::Meshlets { meshlets, triangles }));
    }
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let error = Mesh::new(&vertices, Meshlets::new(&[1], &[[0, 1, 2]]).unwrap()).unwrap_err();
    assert_eq!(error, MeshError::Index { triangle: 0, vertex: 3, vertices: 3 });
    let beyond = Meshlets::new(&[u32::MAX], &[[0, 0, 0]]).unwrap();
    assert!(Mesh::new(&vertices, beyond).is_err());
}

/// Hits of a mesh in meshlets against those of the same mesh without.
#[test]
fn answers_are_those_of_other_indices() {
    let (mut random, mut compared) = (Random::new(83), 0);
    for _ in 0..rays(60_000) / 60 {
        let family = random.below(4);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 90);
        let Ok(mesh) = Mesh::new(&vertices, &triangles[..]) else { continue };
        let plan = random.pick(&[
            Plan::DualSplit(dualsplit::Options::balanced()),
            Plan::Grid(grid::Options::small()),
            Plan::Bvh(bvh::Options::balanced()),
        ]);
        let words = bake::build(&mesh, &plan).unwrap();
        let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
        let meshlets = bake::meshlets(&mesh);
        let moved = meshlets.vertices(&vertices);
        let packed = Mesh::new(&moved, meshlets.indices()).unwrap();
        assert!(bake::build(&packed, &plan).unwrap() == words);
        let asset = Baker::new().mesh(&packed).structure(structure).finish();
        let asset = Asset::from_words(&asset).unwrap();
        assert!(asset.section(Kind::NarrowIndices).is_err() && asset.section(Kind::Meshlets).is_ok());
        let scene = Scene::new(structure, mesh).unwrap();
        let stored: Scene<Structure, Mesh> = asset.scene().unwrap();
        let (snapped, plain) = (bake::lattice(&packed), bake::lattice(&mesh));
        let (on_lattice, other) = (snapped.mesh(&packed), plain.mesh(&mesh));
        assert_eq!(on_lattice.is_ok(), other.is_ok());
        let on_lattice = on_lattice.map(|mesh| LatticeScene::new(List::new(&mesh).unwrap(), mesh).unwrap());
        let other = other.map(|mesh| LatticeScene::new(List::new(&mesh).unwrap(), mesh).unwrap());
        for _ in 0..60 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            assert_eq!(bits(stored.closest_hit(&ray)), bits(scene.closest_hit(&ray)), "{ray:?}");
            assert_eq!(stored.any_hit(&ray), scene.any_hit(&ray), "{ray:?}");
            if let (Ok(on_lattice), Ok(other)) = (&on_lattice, &other) {
                assert_eq!(bits(on_lattice.closest_hit(&ray)), bits(other.closest_hit(&ray)), "{ray:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "{compared}");
}

fn baked(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u32> {
    let meshlets = bake::meshlets(triangles);
    let vertices = meshlets.vertices(vertices);
    Baker::new().mesh(&Mesh::new(&vertices, meshlets.indices()).unwrap()).finish()
}

/// Opens the mesh of an asset and, if it opens, casts rays at it.
fn exercise(words: &[u32]) -> Result<(), Error> {
    let mesh: Mesh = Asset::from_words(words)?.read()?;
    let scene = Scene::new(List::new(&mesh)?, &mesh)?;
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
        let section = asset.section(Kind::Meshlets).unwrap();
        assert_eq!(section.len(), 1 + triangles.len().div_ceil(64) + (triangles.len() * 3).div_ceil(4));
        let mesh: Mesh = asset.read().unwrap();
        assert!(matches!(mesh.indices(), Indices::Meshlets(_)));
        let old = Mesh::new(&vertices, &triangles[..]).unwrap();
        assert!((0..old.len()).all(|triangle| mesh.triangle(triangle) == old.triangle(triangle)));
        assert!(asset.read::<LatticeMesh>().is_err());

        // Counts that lie, as long as the section is.
        for (lie, damaged) in every_lie(&words, place(&words, section), 64) {
            let padded = (lie as usize).div_ceil(64) + (lie as usize * 3).div_ceil(4) == section.len() - 1;
            assert_eq!(exercise(&damaged).is_ok(), padded, "{lie}");
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
}
