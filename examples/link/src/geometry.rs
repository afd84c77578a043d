//! Shapes, rays and transforms.

use core::hint::black_box;

use hitscan::{
    Ray,
    geometry::{Axis, Bounding, BoundingVolume, Bundle, Lattice, Obb, Sphere, Transform, Triangle, Volume},
    glam::Vec3,
};

use crate::input::{aabb, float, matrix, ray, some, sphere, vector, word};

/// Calls everything in `hitscan::geometry`.
pub fn all() {
    boxes();
    triangles();
    spheres();
    transforms();
    lattices();
    volumes(some(vector, &mut None));
}

fn boxes() {
    let (a, b) = (aabb(), aabb());
    black_box((a.union(&b), a.intersection(&b), a.is_empty(), a.is_valid(), a.contains(vector())));
    let axis = Axis::of_largest(vector());
    black_box((a.size(), a.center(), a.half_area(), a.split(axis, float()), axis.next().of(vector())));
    black_box(a.corners());
    black_box(hitscan::geometry::Aabb::around(some(vector, &mut None).iter().copied()));
    black_box((a.gaps(vector()), a.distance(vector())));
    black_box(ray().prepare().map(|ray| a.interval(&ray)));
}

fn triangles() {
    let triangle = Triangle::new(vector(), vector(), vector());
    black_box((triangle.normal(), triangle.bounds(), triangle.clip(&aabb())));
    black_box((triangle.closest_point(vector()), triangle.distance(vector())));
    if let Some(ray) = ray().prepare() {
        black_box((triangle.intersect(&ray, float(), float()), triangle.weights(&ray)));
    }
}

fn spheres() {
    black_box((sphere().bounds(), sphere().closest_point(vector()), sphere().distance(vector())));
    black_box(ray().prepare().map(|ray| sphere().intersect(&ray)));
}

fn transforms() {
    if let Ok(transform) = black_box(Transform::new(matrix(), vector())) {
        let inverse = transform.inverse();
        black_box(inverse.factor());
        black_box((inverse.point(vector()), inverse.vector(vector()), inverse.normal(vector())));
        black_box((transform.ray(&ray()), transform.bounds(&aabb()), ray().at(float())));
        black_box((transform.ray_back(&ray()), transform.translation()));
        black_box(Ray::between(vector(), vector()));
    }
}

fn lattices() {
    let lattice = Lattice::over(&aabb(), [word(), word(), word()]);
    let axis = Axis::of_largest(vector());
    black_box((lattice.above(axis, float()), lattice.below(axis, float()), lattice.last(axis)));
    black_box(lattice.position(axis, word()));
    black_box(Bundle::around([ray(), ray()]).map(|bundle| bundle.entry(&aabb())));
}

fn volumes(points: &[Vec3]) {
    let points = points.iter().copied();
    for kind in Bounding::ALL {
        black_box((kind.name(), kind.around(points.clone())));
    }
    black_box((Sphere::around_barycenter(points.clone()), Sphere::around_box_center(points.clone())));
    black_box((Sphere::ritter(points.clone()), Sphere::welzl(points.clone())));
    black_box((Obb::pca(points.clone()), Obb::dito(points.clone())));
    let obb = Obb::new(vector(), matrix(), vector());
    black_box((obb.is_valid(), obb.contains(vector()), obb.half_area()));
    let two = (BoundingVolume::Sphere(sphere()), (BoundingVolume::Aabb(aabb()), BoundingVolume::Obb(obb)));
    black_box((ray().prepare().map(|ray| two.may_meet(&ray, float())), two.volume()));
}
