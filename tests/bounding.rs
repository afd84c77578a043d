//! Volumes contain their points as real numbers, fit them well, and reject no ray that hits something in them.
#![allow(missing_docs)]

mod common;
#[path = "bounding/exact.rs"]
mod exact;

use std::cell::Cell;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, coordinate, noise, point, rays, seed};
use exact::Exact;
use hitscan::{
    Accelerator, Arena, KdTree, List, Mesh, PreparedRay, Primitives, Ray, Scene,
    accel::Bounded,
    from_fn,
    geometry::{Aabb, Bounding, BoundingVolume, MAX_COORDINATE, Obb, Sphere, Volume},
    glam::{Mat3, Vec3},
    kdtree::Options,
    query::Progress,
};

/// Whether the volume contains the point, both read as real numbers.
fn contains(volume: &BoundingVolume, point: Vec3) -> bool {
    let away = |center: Vec3| {
        let (p, c) = (point.to_array(), center.to_array());
        [0, 1, 2].map(|i| Exact::from(p[i]) - Exact::from(c[i]))
    };
    match volume {
        BoundingVolume::Aabb(aabb) => aabb.contains(point),
        BoundingVolume::Sphere(sphere) => {
            let [x, y, z] = away(sphere.center).map(|x| x.clone() * x);
            let radius = Exact::from(sphere.radius);
            sphere.radius >= 0.0 && !(radius.clone() * radius - x - y - z).is_negative()
        }
        BoundingVolume::Obb(obb) => {
            let axes = [obb.axes.x_axis, obb.axes.y_axis, obb.axes.z_axis];
            axes.into_iter().zip(obb.half_size.to_array()).all(|(axis, half)| {
                let [x, y, z] = away(obb.center);
                let [a, b, c] = axis.to_array().map(Exact::from);
                let along = x * a + y * b + z * c;
                let half = Exact::from(half) * Exact::from(1.0);
                !(half.clone() - along.clone()).is_negative() && !(half + along).is_negative()
            })
        }
    }
}

/// The volume, of which everything that all kinds promise was checked.
fn checked(kind: Bounding, points: &[Vec3]) -> BoundingVolume {
    let volume = kind.around(points.iter().copied()).unwrap_or_else(|| panic!("{kind:?} {points:?}"));
    for point in points {
        assert!(contains(&volume, *point), "{kind:?} {volume:?} {point:?} of {points:?}");
    }
    if let BoundingVolume::Obb(obb) = &volume {
        assert!(obb.is_valid(), "{kind:?} {obb:?} {points:?}");
    }
    assert!(volume.volume() >= 0.0);
    volume
}

#[test]
fn boxes_contain_what_lies_between_all_their_faces() {
    let half = Vec3::new(1.0, 2.0, 0.5);
    let center = Vec3::new(3.0, -4.0, 5.0);
    let aabb = Aabb::new(center - half, center + half);
    let obb = Obb { axes: Mat3::from_rotation_y(0.5) * Mat3::from_rotation_x(0.3), center, half_size: half };
    assert!(aabb.is_valid() && obb.is_valid());
    assert!((obb.half_area() - 4.0 * (2.0 + 1.0 + 0.5)).abs() < 1.0e-5 && obb.half_area() == aabb.half_area());
    for (axis, side) in (0..6).map(|i| (i / 2, [-1.0, 1.0][i % 2])) {
        for (part, inside) in [(0.999, true), (1.001, false)] {
            // Not in the middle of the face.
            let mut at = half * 0.25;
            at[axis] = half[axis] * part * side;
            assert_eq!(aabb.contains(center + at), inside, "{axis} {side}");
            assert_eq!(obb.contains(center + obb.axes * at), inside, "{axis} {side}");
        }
        let mut wrong = obb;
        wrong.half_size[axis] = if side > 0.0 { f32::INFINITY } else { -0.1 };
        assert!(!wrong.is_valid(), "{wrong:?}");
        let mut wrong = obb;
        wrong.center[axis] = f32::MAX * side;
        assert!(!wrong.is_valid(), "{wrong:?}");
        let mut wrong = obb;
        *wrong.axes.col_mut(axis) *= 1.0 + 1.0e-3 * side;
        assert!(!wrong.is_valid(), "{wrong:?}");
        let mut wrong = obb;
        *wrong.axes.col_mut(axis) = (obb.axes.col(axis) + obb.axes.col((axis + 1) % 3) * 0.01).normalize();
        assert!(!wrong.is_valid(), "{wrong:?}");
    }
}

#[test]
fn volumes_contain_their_points_as_real_numbers() {
    let mut random = Random::new(21);
    for round in 0..6000 {
        let family = random.below(FAMILIES);
        let scale = random.pick(&[1.0, 1.0, 1.0e-38, 1.0e-45, 1.0e20]);
        let count = 1 + random.below(if round % 50 == 0 { 200 } else { 9 });
        let mut points: Vec<Vec3> = (0..count).map(|_| point(&mut random, family) * scale).collect();
        match random.below(6) {
            0 => points.iter_mut().for_each(|p| p.y = 0.1),
            1 => points.iter_mut().for_each(|p| *p = Vec3::new(p.x, p.x, p.x * 2.0)),
            2 => points.iter_mut().for_each(|p| *p = (*p * 1.0e3).clamp(-Vec3::ONE, Vec3::ONE) * MAX_COORDINATE),
            _ => {}
        }
        for kind in Bounding::ALL {
            checked(kind, &points);
        }
    }
}

#[test]
fn nothing_and_what_is_no_number_has_no_volume() {
    for kind in Bounding::ALL {
        assert!(kind.around([].into_iter()).is_none());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
            for points in [[Vec3::splat(bad), Vec3::ZERO], [Vec3::ZERO, Vec3::new(1.0, bad, 0.0)]] {
                assert!(kind.around(points.into_iter()).is_none(), "{kind:?} {points:?}");
            }
        }
    }
}

#[test]
fn few_points_have_the_volumes_of_their_shapes() {
    let p = Vec3::new(3.0, -1.0, 0.5);
    for kind in Bounding::ALL {
        for copies in [1, 2, 50] {
            let volume = checked(kind, &vec![p; copies]);
            assert!(volume.volume() <= 1.0e-12, "{kind:?} {volume:?}");
        }
        if let BoundingVolume::Sphere(sphere) = checked(kind, &[p, -p]) {
            assert!((sphere.radius / p.length() - 1.0).abs() < 1.0e-6 && sphere.center.length() < 1.0e-6);
        }
        // On a line and in a plane boxes that turn are flat.
        if let BoundingVolume::Obb(obb) = checked(kind, &[-p, p * 0.2, p * 3.0]) {
            let mut size = obb.half_size.to_array();
            size.sort_by(f32::total_cmp);
            assert!(size[1] < 1.0e-5 && (size[2] / (p.length() * 2.0) - 1.0).abs() < 1.0e-5, "{kind:?} {obb:?}");
        }
    }
}

/// An upper bound of the least radius, at most 1 % above. Bădoiu and Clarkson, 2003.
fn about_least_radius(points: &[Vec3]) -> f32 {
    let mut center = points[0];
    let farthest =
        |center: Vec3| points.iter().copied().max_by(|p, q| p.distance(center).total_cmp(&q.distance(center))).unwrap();
    for step in 0..10_000 {
        center += (farthest(center) - center) / (step + 2) as f32;
    }
    farthest(center).distance(center)
}

fn radius(kind: Bounding, points: &[Vec3]) -> f32 {
    match kind.around(points.iter().copied()) {
        Some(BoundingVolume::Sphere(sphere)) => sphere.radius,
        other => panic!("{other:?}"),
    }
}

#[test]
fn welzl_finds_the_least_sphere() {
    let mut random = Random::new(22);
    for _ in 0..100 {
        let points: Vec<Vec3> = (0..1 + random.below(40)).map(|_| point(&mut random, 2)).collect();
        let least = radius(Bounding::WelzlSphere, &points);
        assert!(least <= about_least_radius(&points) * 1.000_01 + 1.0e-6, "{points:?}");
    }
    // Known ones: corners of a regular tetrahedron on the surface of a ball, or of a great triangle, and points in it.
    for corners in [
        [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
        [[1.732_050_8, 0.0, 0.0], [-0.866_025_4, 1.5, 0.0], [-0.866_025_4, -1.5, 0.0], [0.0; 3]],
    ] {
        for _ in 0..50 {
            let center = point(&mut random, 7);
            let mut points: Vec<Vec3> = (0..60).map(|_| center + point(&mut random, 2)).collect();
            points.extend(corners.map(|corner| center + Vec3::from_array(corner)));
            let swapped = random.below(60);
            points.swap(swapped, 61);
            let (got, expected) = (radius(Bounding::WelzlSphere, &points), 3.0_f32.sqrt());
            let rounding = center.abs().max_element() * 1.0e-6 + 1.0e-5;
            assert!((got - expected).abs() < rounding, "{got} {points:?}");
        }
    }
    // Many on the surface, where all are candidates.
    for family in [0, 1, 3, 10] {
        let points: Vec<Vec3> = (0..400).map(|_| point(&mut random, family)).collect();
        assert!(radius(Bounding::WelzlSphere, &points) <= about_least_radius(&points) * 1.000_01);
    }
}

#[test]
fn better_spheres_are_smaller() {
    let mut random = Random::new(23);
    let mut sums = [0.0; 4];
    for _ in 0..300 {
        let stretch = Vec3::new(1.0, 0.2 + random.unit(), 0.2 + random.unit());
        let points: Vec<Vec3> = (0..200)
            .map(|_| {
                let dense = if random.one_in(2) { 0.2 } else { 1.0 };
                (point(&mut random, 2) * dense + Vec3::splat(1.0 - dense)) * stretch
            })
            .collect();
        let [barycenter, middle, ritter, welzl, ..] = Bounding::ALL;
        let radii = [barycenter, middle, ritter, welzl].map(|kind| radius(kind, &points));
        assert!(radii.iter().all(|radius| radii[3] <= radius * 1.000_001), "{radii:?}");
        sums.iter_mut().zip(radii).for_each(|(sum, radius)| *sum += radius / radii[3]);
    }
    let [barycenter, middle, ritter, welzl] = sums.map(|sum| sum / 300.0);
    assert!(barycenter > 1.1 && middle < 1.1 && ritter < 1.1 && welzl == 1.0, "{sums:?}");
}

#[test]
fn boxes_turn_with_what_they_are_around() {
    let mut random = Random::new(24);
    for _ in 0..200 {
        let turn = Mat3::from_euler(
            hitscan::glam::EulerRot::XYZ,
            random.unit() * 6.0,
            random.unit() * 6.0,
            random.unit() * 6.0,
        );
        let size = Vec3::new(1.0, 2.0 + random.unit(), 4.0 + random.unit());
        let center = point(&mut random, 2) * 10.0;
        let corners = Aabb::new(-size, size).corners().map(|corner| center + turn * corner);
        let real = f64::from(size.x * size.y * size.z * 8.0);
        for kind in [Bounding::PcaObb, Bounding::DitoObb] {
            let volume = checked(kind, &corners).volume() / real;
            assert!((0.9999..1.0001).contains(&volume), "{kind:?} {volume}");
        }
    }
    // What stands along the axes is not turned.
    let upright: Vec<Vec3> = (0..500).map(|_| point(&mut random, 1)).collect();
    let [dito, aabb] = [Bounding::DitoObb, Bounding::Aabb].map(|kind| checked(kind, &upright).volume());
    assert!(dito <= aabb * 1.000_001, "{dito} {aabb}");
}

#[test]
fn dito_is_never_larger_than_the_box_along_the_axes_and_mostly_smaller_than_pca() {
    let mut random = Random::new(25);
    let mut smaller = 0;
    for _ in 0..300 {
        let stretch = Vec3::new(1.0, 0.1 + random.unit(), 0.1 + random.unit());
        let turn = Mat3::from_rotation_x(random.unit() * 6.0) * Mat3::from_rotation_y(random.unit() * 6.0);
        let points: Vec<Vec3> = (0..100).map(|_| turn * (point(&mut random, 2) * stretch)).collect();
        let area = |kind| match checked(kind, &points) {
            BoundingVolume::Obb(obb) => obb.half_area(),
            BoundingVolume::Aabb(aabb) => aabb.half_area(),
            BoundingVolume::Sphere(_) => unreachable!(),
        };
        let [aabb, pca, dito] = [Bounding::Aabb, Bounding::PcaObb, Bounding::DitoObb].map(area);
        assert!(dito <= aabb * 1.000_01, "{points:?}");
        smaller += u32::from(dito <= pca);
    }
    assert!(smaller > 210, "{smaller} of 300");
}

#[test]
fn builders_go_over_the_points_a_limited_number_of_times() {
    let mut random = Random::new(28);
    let on_a_sphere: Vec<Vec3> = (0..2000).map(|_| point(&mut random, 2).normalize()).collect();
    let on_a_circle: Vec<Vec3> = on_a_sphere.iter().map(|p| Vec3::new(p.x, p.y, 0.0).normalize()).collect();
    let series: Vec<Vec3> = (0..250).map(|i| Vec3::new(0.5, -0.7, 0.3) * 0.5_f32.powi(i / 2 * 2)).collect();
    let grid: Vec<Vec3> = (0..2000).map(|_| point(&mut random, 0)).collect();
    let scattered: Vec<Vec3> = (0..2000).map(|_| point(&mut random, 7)).collect();
    let same = vec![Vec3::splat(0.1); 65_537];
    for points in [on_a_sphere, on_a_circle, series, grid, scattered, same] {
        for kind in Bounding::ALL {
            let visits = Cell::new(0);
            kind.around(points.iter().copied().inspect(|_| visits.set(visits.get() + 1))).unwrap();
            let (passes, most) = (visits.get() as f64 / points.len() as f64, 24.0);
            assert!(passes <= most, "{kind:?} {passes}");
        }
    }
}

/// A scene of triangles and of boxes hit at random, with the points that a volume around it must contain.
struct Jumble {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    boxes: Vec<Aabb>,
    family: usize,
    small: f32,
    fast: f32,
}

impl Jumble {
    fn new(random: &mut Random) -> Self {
        let family = random.below(FAMILIES);
        let (mut vertices, mut triangles) = adversarial_mesh(random, family, 12);
        let number = random.pick(&[0, 1, 6]);
        let mut boxes: Vec<Aabb> = (0..number).map(|_| boxed(random, family)).collect();
        if number > 0 && random.one_in(2) {
            (vertices, triangles) = (vec![], vec![]);
        }
        let (small, fast) = random.pick(&[(1.0, 1.0), (1.0, 1.0), (1.0, 1.0), (2.0_f32.powi(-60), 2.0_f32.powi(85))]);
        vertices.iter_mut().for_each(|v| *v *= small);
        boxes.iter_mut().for_each(|b| *b = Aabb::new(b.min * small, b.max * small));
        Self { vertices, triangles, boxes, family, small, fast }
    }

    fn points(&self) -> Vec<Vec3> {
        self.boxes.iter().flat_map(Aabb::corners).chain(self.vertices.iter().copied()).collect()
    }

    fn primitives(&self) -> impl Primitives + Copy + '_ {
        let mesh = Mesh::new(&self.vertices, &self.triangles[..]).unwrap();
        let first = mesh.len();
        let others =
            from_fn(self.boxes.len() as u32, |i| self.boxes[i as usize], move |i, ray| Some(noise(i + first, ray)));
        (mesh, others)
    }

    /// A ray at the scene, or along the surface of the volume.
    fn ray(&self, random: &mut Random, points: &[Vec3], center: Vec3) -> Ray {
        let corners: Vec<Vec3> = points.iter().map(|p| *p / self.small).cycle().take(points.len().max(3)).collect();
        let mut ray = adversarial_ray(random, self.family, &corners);
        if random.one_in(4) {
            let corner = random.pick(&corners);
            let out = corner - center / self.small;
            let other = Vec3::from_array([0; 3].map(|_| coordinate(random, self.family)));
            ray.direction = out.cross(other);
            ray.origin = corner - ray.direction * random.pick(&[0.0, 1.0, 0.5, -1.0]);
        }
        ray.origin *= self.small;
        ray.direction *= self.fast;
        ray
    }
}

/// The middle of a volume.
fn center(volume: &BoundingVolume) -> Vec3 {
    match volume {
        BoundingVolume::Sphere(sphere) => sphere.center,
        BoundingVolume::Aabb(aabb) => aabb.center(),
        BoundingVolume::Obb(obb) => obb.center,
    }
}

#[test]
fn bounded_structures_answer_as_the_list() {
    let mut random = Random::new(26 + 100 * seed());
    let mut memory = vec![0; 1 << 15];
    let (mut cast, mut hits, mut rejected) = (0, 0, [0; Bounding::ALL.len()]);
    while cast < rays(1_000_000) {
        let jumble = Jumble::new(&mut random);
        let (points, primitives) = (jumble.points(), jumble.primitives());
        let list = List::new(&primitives).unwrap();
        let alone = Scene::new(list, primitives).unwrap();
        let kind = random.below(Bounding::ALL.len());
        let volume = Bounding::ALL[kind].around(points.iter().copied()).unwrap();
        let other = random.pick(&Bounding::ALL).around(points.iter().copied()).unwrap();
        let tree = KdTree::build(&primitives, &mut Arena::new(&mut memory), &Options::fast()).unwrap();
        let bounded = Scene::new(Bounded::new(volume, list), primitives).unwrap();
        let twice = Scene::new(Bounded::new((volume, other), tree), primitives).unwrap();
        for _ in 0..100 {
            let mut ray = jumble.ray(&mut random, &points, center(&volume));
            let expected = alone.closest_hit(&ray);
            // Some intervals begin or end at a hit.
            if let Some(hit) = expected {
                match random.below(8) {
                    0 => ray.t_min = hit.t,
                    1 => ray.t_max = hit.t,
                    _ => {}
                }
            }
            let expected = bits(alone.closest_hit(&ray));
            let shown = || format!("{ray:?} {volume:?} {other:?} {:?} {:?}", jumble.vertices, jumble.boxes);
            assert_eq!(bits(bounded.closest_hit(&ray)), expected, "{}", shown());
            assert_eq!(bits(twice.closest_hit(&ray)), expected, "{}", shown());
            assert_eq!(bounded.any_hit(&ray), expected.is_some(), "{}", shown());
            cast += 1;
            hits += usize::from(expected.is_some());
            if let Some(prepared) = ray.prepare() {
                rejected[kind] += usize::from(!volume.may_meet(&prepared, f32::MAX));
            }
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    assert!(rejected.iter().all(|&rejected| rejected * 200 > cast), "{rejected:?} of {cast}");
}

#[test]
fn bounded_walks_pause_and_end() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 2]]).unwrap();
    let sphere = Sphere::welzl(vertices.iter().copied()).unwrap();
    let scene = Scene::new(Bounded::new(sphere, List::new(&mesh).unwrap()), &mesh).unwrap();
    let mut query = scene.begin(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z));
    assert_eq!(query.advance(1), Progress::Paused);
    assert!(matches!(query.advance(1), Progress::Done(Some(_))));
    let mut query = scene.begin(&Ray::new(Vec3::new(2.0, 0.2, -1.0), Vec3::Z));
    assert_eq!(query.advance(0), Progress::Done(None));
    assert_eq!(scene.bounds(), scene.accelerator().accelerator().bounds());
}

/// Tests as textbooks have them, without slack.
#[derive(Clone, Copy)]
enum Careless {
    Sphere(Sphere),
    Obb(Obb),
}

impl Volume for Careless {
    fn may_meet(&self, ray: &PreparedRay, _t_max: f32) -> bool {
        let ray = ray.ray();
        match self {
            Self::Sphere(sphere) => {
                let away = ray.origin - sphere.center;
                let (a, b) = (ray.direction.dot(ray.direction), away.dot(ray.direction));
                b * b - a * (away.dot(away) - sphere.radius * sphere.radius) >= 0.0
            }
            Self::Obb(obb) => {
                let turn = obb.axes.transpose();
                let ray = Ray { origin: turn * (ray.origin - obb.center), direction: turn * ray.direction, ..*ray };
                match ray.prepare() {
                    Some(ray) => Aabb::new(-obb.half_size, obb.half_size).interval(&ray).is_some(),
                    None => true,
                }
            }
        }
    }

    fn volume(&self) -> f64 {
        0.0
    }
}

#[test]
fn tests_without_slack_are_caught() {
    let careless: [fn(&[Vec3]) -> Careless; 2] = [
        |points| Careless::Sphere(Sphere::welzl(points.iter().copied()).unwrap()),
        |points| Careless::Obb(Obb::dito(points.iter().copied()).unwrap()),
    ];
    for make in careless {
        let mut random = Random::new(27);
        let caught = (0..20_000).find(|_| {
            let jumble = Jumble::new(&mut random);
            let (points, primitives) = (jumble.points(), jumble.primitives());
            let volume = make(&points);
            let middle = center(&Bounding::WelzlSphere.around(points.iter().copied()).unwrap());
            let list = List::new(&primitives).unwrap();
            let alone = Scene::new(list, primitives).unwrap();
            let bounded = Scene::new(Bounded::new(volume, list), primitives).unwrap();
            (0..100).any(|_| {
                let ray = jumble.ray(&mut random, &points, middle);
                bits(alone.closest_hit(&ray)) != bits(bounded.closest_hit(&ray))
            })
        });
        assert!(caught.is_some());
    }
}
