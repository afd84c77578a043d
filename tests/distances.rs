//! Real meshes are measured as in double precision: `HITSCAN_DATA` names the folder, see `tests/truth.rs`.
#![allow(missing_docs)]

mod common;

use std::{
    collections::HashMap,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use common::Random;
use hitscan::{
    Arena, KdTree, List, Mesh, Primitives, Scene, geometry::Triangle, glam::Vec3, kdtree, primitives::Nearest,
};

fn key(nearest: Nearest) -> (u32, u32) {
    (nearest.distance.to_bits(), nearest.primitive)
}

/// The closest point of a triangle by regions, in double precision: Ericson, Real-Time Collision Detection, §5.1.5.
fn distance(triangle: &Triangle, p: Vec3) -> f64 {
    let [a, b, c, p] = [triangle.a, triangle.b, triangle.c, p].map(Vec3::as_dvec3);
    let (ab, ac, ap, bp, cp) = (b - a, c - a, p - a, p - b, p - c);
    let (d1, d2, d3, d4, d5, d6) = (ab.dot(ap), ac.dot(ap), ab.dot(bp), ac.dot(bp), ab.dot(cp), ac.dot(cp));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let closest = if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        a + ab * (d1 / (d1 - d3))
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        a + ac * (d2 / (d2 - d6))
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))
    } else {
        a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc))
    };
    // Of triangles without area, whatever the regions say.
    let edges = [(a, ab), (b, c - b), (c, -ac)].map(|(corner, edge)| {
        let s = (edge.dot(p - corner) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (corner + edge * s).distance(p)
    });
    let face = closest.distance(p);
    edges.into_iter().fold(if face.is_nan() { f64::INFINITY } else { face }, f64::min)
}

/// Vertices welded by their bits, and triangles in the file's order.
fn load(path: &Path) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let floats: Vec<f32> = bytes.chunks_exact(4).map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect();
    let (mut numbers, mut vertices) = (HashMap::new(), Vec::new());
    let mut number = |p: &[f32]| {
        *numbers.entry([p[0].to_bits(), p[1].to_bits(), p[2].to_bits()]).or_insert_with(|| {
            vertices.push(Vec3::from_slice(p));
            vertices.len() as u32 - 1
        })
    };
    let corners: Vec<u32> = floats[1..].chunks_exact(3).map(&mut number).collect();
    (vertices, corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

#[test]
fn real_meshes_are_measured_as_in_double_precision() {
    // Past the test harness, which keeps what `eprintln` says of tests that pass.
    let say = |text: &str| io::stderr().lock().write_all(text.as_bytes()).unwrap();
    let Some(folder) = std::env::var_os("HITSCAN_DATA").map(PathBuf::from) else {
        say("\n*** SKIPPED: distances to real meshes. HITSCAN_DATA names no folder, so NOTHING WAS COMPARED. ***\n\n");
        return;
    };
    let mut random = Random::new(6);
    let mut names: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.retain(|path| path.extension().is_some_and(|extension| extension == "tri"));
    names.sort();
    assert!(!names.is_empty());
    for path in names {
        let (vertices, triangles) = load(&path);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = kdtree::Options::small();
        let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
        let tree = KdTree::build(&mesh, &mut Arena::new(&mut memory), &options).unwrap();
        let scene = Scene::new(tree, &mesh).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let (bounds, count) = (scene.bounds(), (20_000_000 / triangles.len()).clamp(4, 200));
        let mut worst = 0.0_f64;
        for _ in 0..count {
            let within = Vec3::new(random.unit(), random.unit(), random.unit()) * 1.4 - 0.2;
            let p = match random.below(3) {
                0 => bounds.min + bounds.size() * within,
                1 => random.pick(&vertices) + bounds.size() * (within - 0.5) * 1.0e-3,
                _ => random.pick(&vertices).lerp(random.pick(&vertices), random.unit()),
            };
            let nearest = scene.nearest_point(p, f32::INFINITY).unwrap();
            assert_eq!(key(nearest), list.nearest_point(p, f32::INFINITY).map(key).unwrap(), "{path:?} {p:?}");
            let truth = (0..mesh.len()).map(|i| distance(&mesh.triangle(i), p)).fold(f64::INFINITY, f64::min);
            let error = (f64::from(nearest.distance) - truth).abs() / f64::from(bounds.size().max_element());
            worst = worst.max(error);
            assert!(error < 1.0e-6, "{path:?} {p:?} {nearest:?} {truth}");
            let moved = f64::from(nearest.point.distance(p)) - truth;
            assert!(
                moved.abs()
                    < f64::from((bounds.min.abs().max(bounds.max.abs())).max_element()) * 1.0e-6 + truth * 1.0e-6
            );
        }
        say(&format!("{}: {count} points, off by {worst:.1e} of its size\n", path.file_stem().unwrap().display()));
    }
}
