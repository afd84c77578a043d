use std::{vec, vec::Vec};

use fearless_simd::dispatch;
use glam::Vec3;

use super::{
    Coherence, Options, WideBvh, gait,
    node::{CHILDREN, Child},
};
use crate::{accel::List, geometry::Ray, primitives::Mesh, scene::Scene, testing::Random};

/// Hills of `side` x `side` x 2 triangles, some corners of which are moved.
fn rough_hills(side: u32, size: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut random = Random::new(1);
    let points = (0..=side).flat_map(|j| (0..=side).map(move |i| (i as f32, j as f32)));
    let vertices = points.map(|(x, z)| Vec3::new(x, random.unit() * 3.0, z) / side as f32 * size).collect();
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| j * (side + 1) + i));
    (vertices, cells.flat_map(|a| [[a, a + 1, a + side + 1], [a + 1, a + side + 2, a + side + 1]]).collect())
}

fn presets() -> [Options; 3] {
    [Options::fast(), Options::balanced(), Options::best()]
}

#[test]
fn any_number_of_threads_packs_the_same() {
    // Enough for several parts and for the passes of all threads together.
    let (vertices, triangles) = rough_hills(200, 1.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for options in presets() {
        let trees = [1, 2, 3, 7, 64].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| WideBvh::new(&mesh, &options).unwrap().tree)
        });
        let first = &trees[0];
        assert!(first.nodes.len() > 1000);
        for tree in &trees {
            assert!(tree.nodes.iter().zip(&first.nodes).all(|(node, other)| node.rows == other.rows));
            assert!(tree.blocks == first.blocks && tree.nodes.len() == first.nodes.len() && tree.stack == first.stack);
        }
    }
}

#[test]
fn scenes_of_any_size_become_the_same_tree() {
    let tree = |exponent: i32| {
        let (vertices, triangles) = rough_hills(60, 2.0_f64.powi(exponent) as f32);
        WideBvh::new(Mesh::new(&vertices, &triangles[..]).unwrap(), &Options::balanced()).unwrap().tree
    };
    let usual = tree(0);
    for exponent in [60, -60, 90, -90, 126, -110] {
        let other = tree(exponent);
        let rows = |nodes: &[super::node::Node]| -> Vec<_> { nodes.iter().map(|node| node.rows[CHILDREN]).collect() };
        assert!(rows(&other.nodes) == rows(&usual.nodes), "{exponent}");
    }
}

#[test]
fn bytes_have_their_price() {
    let (vertices, triangles) = rough_hills(60, 1.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let bytes = [0.0, 0.2, 1.0, f32::NAN].map(|byte_price| {
        let options = Options { byte_price, ..Options::balanced() };
        WideBvh::new(&mesh, &options).unwrap().bytes() as f32 / triangles.len() as f32
    });
    assert!(bytes[0] > bytes[1] + 1.0 && bytes[1] > bytes[2] && bytes[0] == bytes[3], "{bytes:?}");
    assert!(bytes[1] < 36.0, "{bytes:?}");
}

#[test]
fn every_triangle_is_in_a_block_of_each_number_it_has() {
    let (vertices, triangles) = rough_hills(50, 1.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for options in presets() {
        let tree = WideBvh::new(&mesh, &options).unwrap().tree;
        let mut found = vec![0; triangles.len()];
        for &child in tree.nodes.iter().flat_map(|node| &node.rows[CHILDREN]) {
            let child = Child(child);
            if !child.is_block() || child == Child::NONE {
                continue;
            }
            let block = tree.block(child).unwrap();
            for lane in 0..block.lanes().count_ones() as usize {
                let number = block.number(lane);
                assert_eq!(block.triangle(lane), mesh.triangle(number));
                found[number as usize] += 1;
            }
        }
        assert!(found.iter().all(|&times| times > 0));
    }
}

#[test]
fn what_passes_by_narrowly_is_missed() {
    // So near to an edge, single precision does not tell the sides apart.
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let wide = WideBvh::new(Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap(), &Options::default()).unwrap();
    for (beside, is_hit) in [(-1.0e-8, false), (-1.0e-30, false), (0.0, true), (1.0e-30, true), (1.0e-8, true)] {
        let ray = Ray::new(Vec3::new(0.25, beside, -1.0), Vec3::Z);
        assert_eq!(wide.closest_hit(&ray).is_some(), is_hit, "{beside}");
        assert_eq!(wide.any_hit(&ray), is_hit, "{beside}");
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            let (wide, mut hits) = (wide.clone().with_coherence(coherence), [None; 64]);
            wide.closest_hits(&[ray; 64], &mut hits);
            assert!(hits.iter().all(|hit| hit.is_some() == is_hit), "{beside}");
        }
    }
}

#[test]
fn rays_in_planes_of_boxes_find_what_is_there() {
    // Along axes from corners: planes whose parameters are no numbers, through nodes with empty places.
    let (vertices, triangles) = rough_hills(12, 1.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let (wide, list) =
        (WideBvh::new(&mesh, &Options::fast()).unwrap(), Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap());
    for &origin in &vertices {
        for direction in [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::new(1.0e-40, 1.0, -0.0)] {
            let ray = Ray::new(origin, direction).starting_at(-1.0);
            assert_eq!(wide.closest_hit(&ray), list.closest_hit(&ray), "{ray:?}");
        }
    }
}

#[test]
fn a_sample_changes_no_answer() {
    let (vertices, triangles) = rough_hills(40, 40.0);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let wide = WideBvh::new(&mesh, &Options::best()).unwrap();
    let mut random = Random::new(5);
    let mut unit = || random.unit();
    let rays: Vec<Ray> = (0..2000)
        .map(|_| {
            let origin = Vec3::new(unit() * 40.0, unit() * 3.0, unit() * 40.0);
            Ray::new(origin, Vec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5))
        })
        .collect();
    // The boxes of hills hardly overlap, so that the octants' order is as good as that by distance; also of a few rays.
    for rays in [&rays[..], &rays[..3], &[]] {
        assert!(!dispatch!(wide.level, simd => gait::is_better_alone(simd, &wide.tree, rays)));
    }
    let mut hits = vec![None; rays.len()];
    wide.closest_hits(&rays, &mut hits);
    assert!(rays.iter().zip(&hits).all(|(ray, &hit)| hit == wide.closest_hit(ray)));
}

#[test]
fn hits_are_within_limits_to_the_last_bit() {
    // Long, thin and near to where rays begin: single precision knows that they are hit, and about where.
    let mut random = Random::new(3);
    let mut roughly = 0;
    for _ in 0..2000 {
        let mut signed = || random.unit() * 2.0 - 1.0;
        let mut point = |size: f32| Vec3::new(signed(), signed(), signed()) * size;
        let (a, along, aside) = (point(100.0), point(100.0), point(5.0));
        let vertices = [a - along * 3.0, a + along * 3.0, a + aside];
        let (inside, direction) = ((vertices[0] + vertices[1] + vertices[2]) / 3.0, point(1.0));
        let wide = WideBvh::new(Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap(), &Options::default()).unwrap();
        let ray = Ray::new(inside - direction * 0.01, direction);
        let Some(hit) = wide.closest_hit(&ray) else { continue };
        roughly += 1;
        for (ray, is_hit) in [
            (ray, true),
            (ray.up_to(hit.t), true),
            (ray.up_to(hit.t.next_down()), false),
            (ray.starting_at(hit.t), true),
            (ray.starting_at(hit.t.next_up()), false),
            (ray.starting_at(hit.t * 0.9).up_to(hit.t * 1.1), true),
            (ray.starting_at(hit.t * 1.01).up_to(hit.t * 1.1), false),
            (ray.starting_at(hit.t * 0.9).up_to(hit.t * 0.99), false),
        ] {
            assert_eq!(wide.any_hit(&ray), is_hit, "{ray:?}, {hit:?}");
            for coherence in [Coherence::Coherent, Coherence::Incoherent] {
                let (wide, mut hits) = (wide.clone().with_coherence(coherence), [false; 64]);
                wide.any_hits(&[ray; 64], &mut hits);
                assert!(hits.iter().all(|&hit| hit == is_hit), "{ray:?}, {hit:?}");
            }
        }
    }
    assert!(roughly > 1000, "{roughly}");
}
