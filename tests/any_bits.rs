//! Any bits in, a defined answer out: whatever the numbers are, nothing panics, nothing runs on, and all structures agree.
//!
//! `PROPTEST_CASES` sets how many cases are tried.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::bits;
use hitscan::{
    Arena, Instance, Instances, List, Mesh, Primitives, Ray, Scene,
    accel::{Bounded, Plan, Structure},
    bake::Baker,
    bvh, dualsplit,
    error::BuildError,
    geometry::{Aabb, Bounding, Sphere, Transform},
    glam::{Mat3, Vec3},
    grid, kdtree, octree,
    primitives::Spheres,
    query::Progress,
    render::{Camera, Light, Material, Materials, Numbers, Renderer},
    sensor::{Pose, RangeSensor},
};
use proptest::{
    array::{uniform2, uniform3, uniform9},
    collection::vec,
    prelude::*,
};

/// Zeros, denormals, infinities, NaNs, and the ends of what is accepted.
const SPECIAL: [u32; 18] = [
    0,
    0x8000_0000,
    1,
    0x8000_0001,
    0x007f_ffff,
    0x0080_0000,
    0x7f7f_ffff,
    0xff7f_ffff,
    0x7f80_0000,
    0xff80_0000,
    0x7fc0_0000,
    0xffc0_0000,
    0x7f80_0001,
    0x7e80_0000,
    0xfe80_0000,
    0x7e80_0001,
    0x3f80_0000,
    0x3f7f_ffff,
];

/// A float of any bits; half of them special or small whole numbers, so that coordinates coincide.
fn float() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![
        2 => any::<u32>().prop_map(f32::from_bits),
        1 => prop::sample::select(&SPECIAL[..]).prop_map(f32::from_bits),
        3 => (-4_i8..5).prop_map(f32::from),
    ]
}

/// A float such as a mesh accepts.
fn coordinate() -> impl Strategy<Value = f32> + Clone {
    float().prop_map(|x| if x.abs() <= hitscan::geometry::MAX_COORDINATE { x } else { 1.0 })
}

fn vector() -> impl Strategy<Value = Vec3> + Clone {
    uniform3(float()).prop_map(Vec3::from_array)
}

fn place() -> impl Strategy<Value = Vec3> + Clone {
    uniform3(coordinate()).prop_map(Vec3::from_array)
}

fn matrix() -> impl Strategy<Value = Mat3> {
    uniform9(float()).prop_map(|numbers| Mat3::from_cols_array(&numbers))
}

fn ray() -> impl Strategy<Value = Ray> {
    (prop_oneof![vector(), place()], vector(), uniform2(float()), any::<u32>(), any::<bool>()).prop_map(
        |(origin, direction, [t_min, t_max], mask, whole)| {
            let ray = Ray::new(origin, direction);
            if whole { ray } else { ray.starting_at(t_min).up_to(t_max).seeing(mask) }
        },
    )
}

/// A whole number, small, or of any bits.
fn number() -> impl Strategy<Value = u32> {
    prop_oneof![3 => 0_u32..40, 1 => any::<u32>()]
}

/// Any structure with any options.
fn plan() -> impl Strategy<Value = Plan> {
    (0..6, uniform2(float()), float(), [number(), number()], number(), prop::option::of(0_usize..3000), any::<u8>())
        .prop_map(|(kind, [cost, other], third, [leaf_size, depth], bytes, max_bytes, how)| {
            let (clip, intersection_cost) = (how < 128, cost);
            let kd = kdtree::Options {
                split: [kdtree::Split::Midpoint, kdtree::Split::Median, kdtree::Split::Sah][usize::from(how % 3)],
                leaf_size,
                max_depth: (how % 5 > 0).then_some(depth),
                intersection_cost,
                byte_cost: other,
                empty_bonus: third,
                clip,
                // Memory for the test is what bounds it.
                bytes_per_primitive: bytes % 2000,
                max_bytes,
            };
            match kind {
                0 => Plan::Grid(grid::Options {
                    density: cost,
                    form: grid::Form::ALL[usize::from(how % 3)],
                    clip,
                    bytes_per_primitive: bytes % 2000,
                    max_bytes,
                }),
                1 => Plan::Octree(octree::Options {
                    split: [octree::Split::Middle, octree::Split::Sah][usize::from(how % 2)],
                    leaf_size,
                    max_depth: depth,
                    intersection_cost,
                    clip,
                    bytes_per_primitive: bytes % 2000,
                    max_bytes,
                }),
                2 => Plan::KdTree(kd),
                3 => Plan::CompactKdTree(kd),
                4 => Plan::Bvh(bvh::Options {
                    method: [bvh::Method::Sah, bvh::Method::Ploc][usize::from(how % 2)],
                    reinsertions: leaf_size % 5,
                    leaf_size: depth,
                    intersection_cost,
                    bytes_per_primitive: other,
                    max_bytes,
                }),
                _ => Plan::DualSplit(dualsplit::Options {
                    leaf_size,
                    intersection_cost,
                    carve_threshold: other,
                    ..if clip { dualsplit::Options::fast() } else { dualsplit::Options::quick() }
                }),
            }
        })
}

/// Words for a plan, or many if it says that it may need more.
fn memory(plan: &Plan, count: usize) -> Vec<u32> {
    vec![0; plan.words(count).min(1 << 20)]
}

/// Asks everything of a structure and the list.
fn compare<P: Primitives>(primitives: &P, plan: &Plan, rays: &[Ray]) -> Result<(), TestCaseError> {
    let mut memory = memory(plan, primitives.len() as usize);
    let list = List::new(primitives);
    let built = match Structure::build(primitives, &mut Arena::new(&mut memory), plan) {
        Ok(built) => built,
        Err(BuildError::Bounds { primitive }) => {
            prop_assert_eq!(list.map(|_| ()), Err(BuildError::Bounds { primitive }));
            return Ok(());
        }
        Err(_) => return Ok(()),
    };
    let scene = Scene::new(Structure::open(built.kind().unwrap(), built.as_words()).unwrap(), primitives).unwrap();
    let list = Scene::new(list.unwrap(), primitives).unwrap();
    for ray in rays {
        let hit = list.closest_hit(ray);
        prop_assert_eq!(bits(scene.closest_hit(ray)), bits(hit), "{:?}", ray);
        prop_assert_eq!(scene.any_hit(ray), hit.is_some());
        prop_assert!(scene.hits(ray).eq(list.hits(ray)));
        if ray.prepare().is_none() {
            prop_assert_eq!(scene.begin(ray).advance(1), Progress::Done(None));
        }
        if let Some(hit) = hit {
            let surface = scene.surface(ray, &hit);
            _ = surface.start_towards(ray.direction);
        }
    }
    Ok(())
}

fn config() -> ProptestConfig {
    let usual = ProptestConfig::default();
    ProptestConfig { cases: usual.cases.max(4096), failure_persistence: None, ..usual }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn meshes_and_spheres(
        vertices in vec(prop_oneof![20 => place(), 1 => vector()], 1..20),
        corners in vec(uniform3(any::<prop::sample::Index>()), 0..20),
        beyond in prop_oneof![9 => Just(0), 1 => Just(1)],
        spheres in vec((place(), float()), 0..3),
        plan in plan(),
        rays in vec(ray(), 1..20),
        point in vector(),
        far in float(),
    ) {
        let corners: Vec<[u32; 3]> =
            corners.iter().map(|three| three.map(|corner| corner.index(vertices.len() + beyond) as u32)).collect();
        let spheres: Vec<Sphere> = spheres.into_iter().map(|(center, radius)| Sphere::new(center, radius)).collect();
        match Mesh::new(&vertices, &corners[..]) {
            Ok(mesh) => {
                compare(&mesh, &plan, &rays)?;
                let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
                _ = scene.nearest_point(point, far);
                for kind in Bounding::ALL {
                    if let Some(volume) = kind.around(vertices.iter().copied()) {
                        let bounded = Scene::new(Bounded::new(volume, List::new(&mesh).unwrap()), &mesh).unwrap();
                        for ray in &rays {
                            prop_assert_eq!(bits(bounded.closest_hit(ray)), bits(scene.closest_hit(ray)));
                        }
                    }
                }
                if let Ok(spheres) = Spheres::new(&spheres) {
                    compare(&(mesh, spheres), &plan, &rays)?;
                    _ = Baker::new().mesh(&mesh).finish();
                }
            }
            Err(error) => {
                let good = |v: &Vec3| v.abs().max_element() <= hitscan::geometry::MAX_COORDINATE && v.is_finite();
                let used = |c: &[u32; 3]| c.iter().all(|&v| vertices.get(v as usize).is_some_and(good));
                prop_assert!(!corners.iter().all(used), "{error}");
            }
        }
    }

    #[test]
    fn placed_scenes(
        vertices in vec(place(), 3..10),
        linears in vec((prop_oneof![matrix(), uniform3(float()).prop_map(|v| Mat3::from_diagonal(v.into()))], vector()), 1..5),
        plan in plan(),
        rays in vec(ray(), 1..20),
    ) {
        let corners: Vec<[u32; 3]> = (2..vertices.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
        let mesh = Mesh::new(&vertices, &corners[..]).unwrap();
        let scenes = [Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap()];
        let mut placed: Vec<Instance> =
            linears.iter().filter_map(|&(l, t)| Transform::new(l, t).ok()).map(|t| Instance::new(0, t)).collect();
        if let Ok(instances) = Instances::place(&scenes, &mut placed) {
            compare(&instances, &plan, &rays)?;
        }
    }

    #[test]
    fn pictures_and_ranges(
        vertices in vec(place(), 3..10),
        [eye, target, up] in uniform3(vector()),
        [fov, other] in uniform2(float()),
        colors in uniform3(vector()),
        axes in matrix(),
        size in uniform2(0_u32..5),
    ) {
        let corners: Vec<[u32; 3]> = (2..vertices.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
        let mesh = Mesh::new(&vertices, &corners[..]).unwrap();
        let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let palette = [Material::matte(colors[0]).with_highlights(fov, other).with_reflectivity(other)];
        let lights = [Light::point(target, colors[1]), Light::directional(up, colors[2])];
        let cameras = [
            Camera::pinhole(eye, target, up, fov),
            Camera::orthographic(eye, target, up, other),
            Camera::framing(&Aabb::new(eye, target), up, colors[0]),
            Camera::framing(&scene.bounds(), eye, up),
        ];
        for camera in cameras {
            let renderer = Renderer::new(&scene, camera, size[0], size[1])
                .with_lights(&lights)
                .with_materials(Materials::new(&palette, Numbers::First))
                .with_ambient(colors[2])
                .with_background(eye, up)
                .with_bounces(3);
            let mut pixels = 0;
            for tile in renderer.tiles(3, 2) {
                pixels += renderer.colors::<[u8; 3]>(tile).count();
                _ = renderer.colors::<u16>(tile).count();
            }
            prop_assert_eq!(pixels, (size[0] * size[1]) as usize);
        }
        let beams = [eye, target, up];
        let sensor = RangeSensor::new(&beams).in_units_of(fov).within(other, fov);
        for pose in [Pose::new(eye, axes), Pose::looking(eye, target, up).turned(other)] {
            prop_assert_eq!(sensor.ranges(&scene, &pose).count(), 3);
            prop_assert_eq!(sensor.echoes(&scene, &pose).count(), 3);
        }
    }
}
