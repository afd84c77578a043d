//! Meshes on lattices: the triangles are those over the decoded vertices, bit for bit.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{
    FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, plans,
    seal::{every_byte, every_length, place, sealed},
};
use hitscan::{
    Accelerator, DualSplit, Error, LatticeMesh, List, Mesh, Primitives, Ray, Scene,
    accel::{Plan, Structure},
    asset::{Asset, Kind},
    bake::{self, Baker, OnLattice},
    dualsplit,
    geometry::{Aabb, Axis, Lattice},
    glam::Vec3,
    primitives::{MeshError, Sides},
};

/// A frame and vertices on it: the whole 16 bits, a corner of it, or few planes, so that there are ties.
fn vertices(random: &mut Random, count: usize) -> (Aabb, Vec<[u16; 3]>) {
    let frame = random.pick(&[
        Aabb::new(Vec3::ZERO, Vec3::ONE),
        Aabb::new(Vec3::new(-3.0, 1.0e5, -7.0), Vec3::new(9.0, 1.0e5 + 4.0, -1.0)),
        Aabb::new(Vec3::splat(-32_768.0), Vec3::splat(32_767.0)),
        Aabb::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0e-30)),
    ]);
    let (most, scale) = random.pick(&[(0xffff, 1), (4, 0x3fff), (3, 1), (1000, 1)]);
    let mut number = || (random.below(most + 1) * scale) as u16;
    (frame, (0..count).map(|_| [number(), number(), number()]).collect())
}

#[test]
fn hits_are_those_of_the_decoded_mesh() {
    let mut random = Random::new(5);
    let mut memory = vec![0; 1 << 16];
    let mut hits = 0;
    for round in 0..600 {
        let count = 3 + random.below(40);
        let (frame, numbers) = vertices(&mut random, count);
        let corner = |random: &mut Random| random.below(count) as u16;
        let triangles: Vec<[u16; 3]> = (0..1 + random.below(48)).map(|_| [0; 3].map(|_| corner(&mut random))).collect();
        let masks: Vec<u32> = triangles.iter().map(|_| random.pick(&[1, 2, 3])).collect();
        let sides = random.pick(&[Sides::Both, Sides::Front]);
        let on_lattice = LatticeMesh::new(&frame, &numbers, &triangles[..]).unwrap();
        let on_lattice = on_lattice.with_sides(sides).with_masks(&masks).unwrap();
        let positions: Vec<Vec3> = on_lattice.positions().collect();
        let mesh = Mesh::new(&positions, &triangles[..]).unwrap().with_sides(sides).with_masks(&masks).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let kind = round % plans::KINDS;
        let Some((plan, built)) = plans::build(&mut random, kind, &on_lattice, &mut memory) else { continue };
        let scene = Scene::new(built, &on_lattice).unwrap();
        let soup: Vec<Vec3> = triangles.iter().flatten().map(|&vertex| positions[vertex as usize]).collect();
        for _ in 0..400 {
            let ray = adversarial_ray(&mut random, 2, &soup).seeing(random.pick(&[1, 2, 3]));
            let expected = list.closest_hit(&ray);
            assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{plan:?} {ray:?}");
            assert_eq!(scene.any_hit(&ray), expected.is_some());
            if let Some(hit) = expected {
                hits += 1;
                assert_eq!(scene.surface(&ray, &hit), list.surface(&ray, &hit));
            }
            let point = ray.at(1.0);
            assert_eq!(scene.nearest_point(point, 10.0), list.nearest_point(point, 10.0), "{plan:?} {point}");
        }
    }
    assert!(hits > 50_000, "{hits}");
}

#[test]
fn structures_take_the_frame_as_their_bounds() {
    let mut random = Random::new(3);
    for family in 0..FAMILIES {
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let snapped = bake::lattice(&mesh);
        let on_lattice = snapped.mesh(&mesh).unwrap();
        for (name, plan) in plans::presets() {
            let words = bake::build(&on_lattice, &plan).unwrap();
            let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
            assert_eq!(structure.bounds(), *on_lattice.frame(), "{name} {family}");
        }
        let lattice = Lattice::over(on_lattice.frame(), [LatticeMesh::LAST; 3]);
        assert_eq!(lattice, *on_lattice.lattice());
        for axis in Axis::ALL {
            let at = |number| lattice.position(axis, number);
            assert!((0..0xffff).all(|number| at(number) < at(number + 1)), "{family} {axis:?}");
        }
    }
}

#[test]
fn vertices_move_by_no_more_than_is_told() {
    let mut random = Random::new(8);
    for family in 0..FAMILIES {
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let OnLattice { vertices: numbers, displacement, frame } = bake::lattice(&mesh);
        let on_lattice = LatticeMesh::new(&frame, &numbers, &triangles[..]).unwrap();
        let farthest = on_lattice
            .positions()
            .zip(&vertices)
            .map(|(to, from)| (to.as_dvec3() - from.as_dvec3()).length())
            .fold(0.0, f64::max);
        let told = f64::from(displacement);
        assert!(farthest <= told && told <= farthest * 1.000_001, "{farthest} {told}");
        // Half a step along each axis, if the coordinates are not coarser.
        let steps = frame.size().as_dvec3() / 65_535.0;
        assert!(told <= steps.length() * 0.6 + 1.0e-40, "{family}: {told} {steps}");
    }
    let nothing = Mesh::new(&[], &[[0_u16; 3]; 0]).unwrap();
    assert_eq!(bake::lattice(&nothing).displacement, 0.0);
}

#[test]
fn bad_frames_and_corners_are_named() {
    let numbers = [[0_u16; 3], [1, 0, 0], [0, 1, 0xffff]];
    let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let error = |frame, triangle: [u16; 3]| LatticeMesh::new(&frame, &numbers, &[triangle]).err();
    assert_eq!(error(unit, [0, 1, 2]), None);
    assert_eq!(error(unit, [0, 3, 2]), Some(MeshError::Index { triangle: 0, vertex: 3, vertices: 3 }));
    assert_eq!(error(Aabb::EMPTY, [0, 1, 2]), Some(MeshError::Frame));
    assert_eq!(error(Aabb::new(Vec3::NAN, Vec3::ONE), [0, 1, 2]), Some(MeshError::Frame));
    let most = Aabb::new(Vec3::splat(-(2.0_f32.powi(126))), Vec3::splat(2.0_f32.powi(126)));
    assert_eq!(error(most, [0, 1, 2]), Some(MeshError::Vertex { triangle: 0, vertex: 2 }));
    assert_eq!(error(most, [0, 1, 1]), None);
    assert!(LatticeMesh::new(&unit, &numbers, &[[0_u16, 1, 2]]).unwrap().with_masks(&[1, 2]).is_err());
}

fn baked(corners: &[[u32; 3]], numbers: &[[u16; 3]]) -> Vec<u32> {
    let mesh = LatticeMesh::new(&Aabb::new(Vec3::ZERO, Vec3::ONE), numbers, corners).unwrap();
    let words = bake::build(&mesh, &Plan::DualSplit(dualsplit::Options::fast())).unwrap();
    Baker::new().lattice_mesh(&mesh).structure(DualSplit::open(&words).unwrap()).finish()
}

/// Opens everything, and if it opens, casts a few rays.
fn exercise(words: &[u32]) -> Result<(), Error> {
    let scene: Scene<DualSplit, LatticeMesh> = Asset::from_words(words)?.scene()?;
    for index in 0..scene.primitives().len() {
        let target = scene.primitives().triangle(index).a;
        let _ = scene.closest_hit(&Ray::between(Vec3::splat(2.0), target));
    }
    Ok(())
}

#[test]
fn what_is_baked_is_read_back() {
    let mut random = Random::new(4);
    for (corners, count) in [(40, 30), (41, 31), (3, 70_000)] {
        let numbers: Vec<[u16; 3]> = (0..count).map(|_| [0; 3].map(|_| random.below(0xffff) as u16)).collect();
        let triangles: Vec<[u32; 3]> = (0..corners).map(|_| [0; 3].map(|_| random.below(count) as u32)).collect();
        let words = baked(&triangles, &numbers);
        let asset = Asset::from_words(&words).unwrap();
        let mesh: LatticeMesh = asset.read().unwrap();
        assert_eq!((mesh.vertices(), mesh.len()), (&numbers[..], corners as u32));
        assert!((0..corners as u32).all(|i| mesh.indices().get(i) == Some(triangles[i as usize])));
        let kinds: Vec<Kind> = asset.sections().map(|section| section.kind).collect();
        let indices = if count > 65_536 { Kind::WideIndices } else { Kind::NarrowIndices };
        assert_eq!(kinds, [Kind::LatticeVertices, indices, Kind::DualSplit]);
        let bytes = asset.section(Kind::LatticeVertices).unwrap().len() * 4;
        assert_eq!(bytes, 28 + (count * 6).next_multiple_of(4));
        assert!(asset.read::<Mesh>().is_err());
        exercise(&words).unwrap();
    }
}

#[test]
fn damaged_sections_are_refused_or_harmless() {
    let numbers = [[0_u16, 0, 0], [60_000, 3, 9], [7, 50_000, 1], [9, 9, 40_000], [1, 2, 3]];
    let words = baked(&[[0, 1, 2], [0, 1, 3], [1, 2, 4]], &numbers);
    assert!(every_length(&words).all(|shorter| exercise(&shorter).is_err()));
    let (mut refused, mut harmless) = (0, 0);
    for damaged in every_byte(&words) {
        match exercise(&sealed(damaged)) {
            Ok(()) => harmless += 1,
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 5_000 && harmless > 5_000, "{refused} {harmless}");
    // One vertex more or less than there is room for.
    let asset = Asset::from_words(&words).unwrap();
    let first = place(&words, asset.section(Kind::LatticeVertices).unwrap());
    for count in [0, 4, 6, u32::MAX, 0x5555_5555] {
        let mut damaged = words.clone();
        damaged[first] = count;
        assert!(exercise(&sealed(damaged)).is_err(), "{count}");
    }
}
