//! Arguments that the optimiser cannot know: any bits, in slices of any length.

use core::{array, hint::black_box};

use hitscan::{
    Ray,
    geometry::{Aabb, Sphere},
    glam::{Mat3, Vec3},
};

/// An opaque number.
pub fn word() -> u32 {
    black_box(0)
}

/// An opaque float.
pub fn float() -> f32 {
    f32::from_bits(word())
}

/// An opaque point or direction.
pub fn vector() -> Vec3 {
    Vec3::new(float(), float(), float())
}

/// An opaque matrix.
pub fn matrix() -> Mat3 {
    Mat3::from_cols(vector(), vector(), vector())
}

/// An opaque ray.
pub fn ray() -> Ray {
    Ray::new(vector(), vector()).starting_at(float()).up_to(float()).seeing(word())
}

/// An opaque box.
pub fn aabb() -> Aabb {
    Aabb::new(vector(), vector())
}

/// An opaque sphere.
pub fn sphere() -> Sphere {
    Sphere::new(vector(), float())
}

/// Opaque corners of a triangle.
pub fn triangle() -> [Vec3; 3] {
    [vector(), vector(), vector()]
}

/// Opaque things, of which the optimiser does not know how many.
pub fn some<T>(make: fn() -> T, storage: &mut Option<[T; 4]>) -> &[T] {
    black_box(storage.insert(array::from_fn(|_| make())).as_slice())
}
