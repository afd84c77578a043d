//! No ray gets out of a closed mesh, nor in, wherever it is and however large, under any structure.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{Random, bits, closed::Closed, memo::Memo, plans, rays, seed};
use hitscan::{List, Mesh, Ray, Scene, accel::Structure, glam::Vec3};

/// Far away, where coordinates have few digits left.
const FAR: Vec3 = Vec3::new(148_376.0, 1_234.0, -223_423.0);

/// From how many points rays go, for each mesh.
const POINTS: usize = 120;

/// A direction to a corner, to an edge, along axes or at random.
fn direction(random: &mut Random, mesh: &Closed, from: Vec3) -> Vec3 {
    let [a, b, c] = mesh.corners(random.below(mesh.triangles.len()));
    match random.below(6) {
        0 | 1 => a - from,
        2 => a * 0.5 + b * 0.5 - from,
        3 => a + (b - a) * random.unit() - from,
        4 => {
            // In a plane through a corner, where splits are.
            let mut direction = Vec3::from_array([0; 3].map(|_| random.unit() - 0.5));
            let axis = random.below(3);
            direction[axis] = c[axis] - from[axis];
            direction
        }
        _ => Vec3::from_array([0; 3].map(|_| random.pick(&[0.0, -0.0, 1.0, -1.0, 0.3, 1.0e-30]))),
    }
}

/// A point in the box around a mesh.
fn somewhere(random: &mut Random, mesh: &Closed) -> Vec3 {
    let [a, b, c] = [0; 3].map(|_| mesh.vertices[random.below(mesh.vertices.len())]);
    let mix = Vec3::from_array([0; 3].map(|_| random.unit()));
    let between = a + (b - a) * mix.x + (c - a) * mix.y;
    random.pick(&[mesh.middle, between, between + (mesh.middle - between) * mix.z])
}

/// What was asked and what was found.
#[derive(Debug, Default)]
struct Count {
    rays: usize,
    /// Rays, counted once for each of list, structures and wide tree.
    asked: usize,
    inside: usize,
    through: usize,
    /// Meshes by the power of ten of their scale, near and far.
    scales: std::collections::BTreeSet<(i32, bool)>,
}

fn leaks(random: &mut Random, round: usize, count: &mut Count, memory: &mut [Vec<u32>]) {
    let (power, far) = ((round % 13) as i32 - 6, round / 13 % 2 == 1);
    let mesh = Closed::new(random, 10.0_f64.powi(power), if far { FAR } else { Vec3::ZERO });
    let triangles = Mesh::new(&mesh.vertices, &mesh.triangles[..]).unwrap();
    // What a triangle said to a ray is remembered, in most rounds.
    let memo = Memo::new(triangles, !random.one_in(16));
    let list = Scene::new(List::new(&memo).unwrap(), &memo).unwrap();
    let structures: Vec<Structure> = (0..plans::KINDS)
        .zip(memory)
        .filter_map(|(kind, memory)| Some(plans::build(random, kind, &memo, memory)?.1))
        .collect();
    let scenes: Vec<_> = structures.iter().map(|&structure| Scene::new(structure, &memo).unwrap()).collect();
    #[cfg(feature = "std")]
    let wide = hitscan::wide::WideBvh::new(&triangles, &hitscan::wide::Options::default()).unwrap();
    let mut must_hit = |ray: Ray| {
        memo.forget();
        let hit = list.closest_hit(&ray);
        assert!(hit.is_some() && list.any_hit(&ray), "a leak: {ray:?} {:?} {:?}", mesh.vertices, mesh.triangles);
        #[cfg(feature = "std")]
        assert!(bits(wide.closest_hit(&ray)) == bits(hit) && wide.any_hit(&ray), "{ray:?} {:?}", mesh.vertices);
        for scene in &scenes {
            let found = bits(scene.closest_hit(&ray)) == bits(hit) && scene.any_hit(&ray);
            assert!(found, "{ray:?} {:?} {:?}", scene.accelerator().kind(), mesh.vertices);
        }
        count.rays += 1;
        count.asked += 1 + scenes.len() + usize::from(cfg!(feature = "std"));
    };
    for _ in 0..POINTS {
        let from = somewhere(random, &mesh);
        match mesh.contains(from) {
            Some(true) => {
                for _ in 0..4 {
                    let direction = direction(random, &mesh, from);
                    let ray = Ray::new(from, direction);
                    if ray.prepare().is_some() {
                        // Out, whichever way one goes.
                        must_hit(ray);
                        must_hit(ray.starting_at(f32::NEG_INFINITY).up_to(0.0));
                        count.inside += 1;
                        count.scales.insert((power, far));
                    }
                }
            }
            Some(false) if mesh.contains(mesh.middle) == Some(true) => {
                // In and out again, on a line that goes through the middle without any rounding.
                let ray = Ray::new(from, mesh.middle - from);
                if from.as_dvec3() + ray.direction.as_dvec3() == mesh.middle.as_dvec3() && ray.prepare().is_some() {
                    must_hit(ray.up_to(1.0));
                    must_hit(ray.starting_at(1.0));
                    count.through += 1;
                }
            }
            _ => {}
        }
    }
}

#[test]
fn closed_meshes_do_not_leak() {
    let wanted = rays(2_000_000);
    let mut random = Random::new(21 + 100 * seed());
    let mut memory = vec![vec![0; 1 << 17]; plans::KINDS];
    let mut count = Count::default();
    for round in 0.. {
        leaks(&mut random, round, &mut count, &mut memory);
        if count.asked >= wanted {
            break;
        }
    }
    println!("{count:?}: no leak");
    // Near they have all sizes, far away those that are more than a few steps of coordinates wide.
    let near = count.scales.iter().filter(|(_, far)| !far).count();
    assert!(near == 13 && count.scales.len() > near + 5, "{:?}", count.scales);
    assert!(count.inside * 3 > count.rays && count.through * 100 > count.rays, "{count:?}");
}

#[test]
fn meshes_with_a_hole_leak() {
    // The test itself: without one triangle, some ray gets out.
    let mut random = Random::new(22);
    let found = (0..1000).any(|_| {
        let mut mesh = Closed::new(&mut random, 1.0, Vec3::ZERO);
        let closed = mesh.contains(mesh.middle) == Some(true);
        mesh.triangles.pop();
        let triangles = Mesh::new(&mesh.vertices, &mesh.triangles[..]).unwrap();
        let list = Scene::new(List::new(&triangles).unwrap(), &triangles).unwrap();
        closed && (0..100).any(|_| !list.any_hit(&Ray::new(mesh.middle, direction(&mut random, &mesh, mesh.middle))))
    });
    assert!(found);
}
