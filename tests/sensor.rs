//! Range sensors, as a user of the crate sees them.
#![allow(missing_docs)]

mod common;

use std::f32::consts::{FRAC_PI_4, TAU};

use common::{Random, bits, plans};
use hitscan::{
    Arena, Hit, List, Mesh, Primitives, Ray, Scene,
    accel::Structure,
    geometry::Sphere,
    glam::{Mat3, Vec3},
    primitives::Spheres,
    sensor::{Pose, RangeSensor, depth_zones, rings, zones},
};

/// A square wall at `z`.
fn wall(z: f32) -> ([Vec3; 4], [[u16; 3]; 2]) {
    let corner = |x: f32, y: f32| Vec3::new(x, y, z);
    ([corner(-9.0, -9.0), corner(9.0, -9.0), corner(9.0, 9.0), corner(-9.0, 9.0)], [[0, 1, 2], [0, 2, 3]])
}

const LEVEL: Pose = Pose::new(Vec3::ZERO, Mat3::IDENTITY);

#[test]
fn a_wall_has_one_depth_and_many_distances() {
    let (vertices, triangles) = wall(3.0);
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let (depths, distances) = (depth_zones::<8, 8>([FRAC_PI_4; 2]), zones::<8, 8>([FRAC_PI_4; 2]));
    let depths = RangeSensor::new(depths.as_flattened()).ranges(&scene, &LEVEL);
    let distances = RangeSensor::new(distances.as_flattened());
    assert_eq!(depths.len(), 64);
    for ((depth, echo), beam) in depths.zip(distances.echoes(&scene, &LEVEL)).zip(distances.beams()) {
        let (depth, echo) = (depth.unwrap(), echo.unwrap());
        assert_eq!(depth.primitive, echo.primitive);
        assert!((depth.t - 3.0).abs() < 1.0e-5, "{}", depth.t);
        assert!((echo.range - 3.0 / beam.z).abs() < 1.0e-4, "{}", echo.range);
        assert!((echo.cosine - beam.z).abs() < 1.0e-6, "{}", echo.cosine);
    }
}

#[test]
fn what_is_too_near_hides_what_lies_behind() {
    let (vertices, triangles) = wall(3.0);
    let (mesh, ball) = (Mesh::new(&vertices, &triangles).unwrap(), [Sphere::new(Vec3::Z * 0.25, 0.15)]);
    let both = (mesh, Spheres::new(&ball).unwrap());
    let scene = Scene::new(List::new(&both).unwrap(), &both).unwrap();
    let beams = [Vec3::Z, Vec3::new(0.8, 0.0, 0.6), Vec3::NEG_Z];
    let range = |sensor: RangeSensor<'_>| -> Vec<_> {
        sensor.ranges(&scene, &LEVEL).map(|hit| hit.map(|hit| hit.t.round())).collect()
    };
    let sensor = RangeSensor::new(&beams).in_units_of(0.001);
    assert_eq!(range(sensor), [Some(100.0), Some(5000.0), None]);
    assert_eq!(range(sensor.within(200.0, 9000.0)), [None, Some(5000.0), None]);
    assert_eq!(range(sensor.within(0.0, 4000.0)), [Some(100.0), None, None]);
}

#[test]
fn beams_are_blind_to_what_their_mask_leaves_out() {
    let (vertices, triangles) = wall(3.0);
    let mesh = Mesh::new(&vertices, &triangles).unwrap().with_masks(&[0b01, 0b10]).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let beams = zones::<16, 16>([1.0, 1.0]);
    let sensor = RangeSensor::new(beams.as_flattened());
    let seen = |mask| sensor.seeing(mask).ranges(&scene, &LEVEL).flatten().map(|hit| hit.primitive).collect::<Vec<_>>();
    assert!(seen(0b11).len() == 256 && seen(0b100).is_empty());
    assert!(!seen(0b01).is_empty() && seen(0b01).iter().all(|&primitive| primitive == 0));
}

#[test]
fn a_sweep_is_a_turn_of_poses_and_any_structure_gives_the_same() {
    let mut random = Random::new(7);
    let balls: Vec<Sphere> = (0..40)
        .map(|_| Sphere::new(Vec3::from_array([0; 3].map(|_| random.unit() * 8.0 - 4.0)), 0.2 + random.unit() * 0.3))
        .collect();
    let balls = Spheres::new(&balls).unwrap();
    let list = Scene::new(List::new(&balls).unwrap(), &balls).unwrap();
    let beams = rings([-0.3, -0.1, 0.0, 0.2]);
    let lidar = RangeSensor::new(&beams).within(0.3, 6.0);
    let pose = Pose::looking(Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.0, 0.4, 2.0), Vec3::Y);
    let swept: Vec<Option<Hit>> = lidar.sweep(&list, &pose, 90).collect();
    assert_eq!(swept.len(), 360);
    assert!((30..350).contains(&swept.iter().flatten().count()));
    for (step, column) in swept.chunks(4).enumerate() {
        let turned = pose.turned(step as f32 * (TAU / 90.0));
        assert!(lidar.ranges(&list, &turned).map(bits).eq(column.iter().copied().map(bits)));
    }
    let mut memory = vec![0; 100_000];
    for (name, plan) in plans::presets() {
        let structure = Structure::build(&balls, &mut Arena::new(&mut memory), &plan).unwrap();
        let scene = Scene::new(structure, &balls).unwrap();
        assert!(lidar.sweep(&scene, &pose, 90).map(bits).eq(swept.iter().copied().map(bits)), "{name}");
    }
}

#[test]
fn rays_and_ranges_agree_whatever_the_numbers_are() {
    let (vertices, triangles) = wall(3.0);
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let numbers = [0.0, -0.0, 1.0, -1.0, 1.0e-30, 1.0e30, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut random = Random::new(3);
    let mut vector = || Vec3::from_array([0; 3].map(|_| random.pick(&numbers)));
    for _ in 0..10_000 {
        let beams = [vector(), vector(), Vec3::Z];
        let pose = Pose::new(vector(), Mat3::from_cols(vector(), vector(), vector()));
        let [unit, nearest, farthest] = vector().to_array();
        let sensor = RangeSensor::new(&beams).in_units_of(unit).within(nearest, farthest);
        let reached = |ray: Ray| bits(scene.closest_hit(&ray).filter(|hit| hit.t >= nearest));
        assert!(sensor.rays(&pose).map(reached).eq(sensor.ranges(&scene, &pose).map(bits)));
        assert!(sensor.echoes(&scene, &pose).flatten().all(|echo| echo.primitive < mesh.len()));
        assert_eq!(sensor.sweep(&scene, &pose.turned(nearest), 2).count(), 6);
    }
}
