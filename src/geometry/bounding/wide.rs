//! Vectors of doubles: no product of up to six coordinates over- or underflows, so that nothing needs to be scaled.

use glam::Vec3;

use crate::math;

/// Three coordinates.
pub(super) type Wide = [f64; 3];

pub(super) fn wide(v: Vec3) -> Wide {
    v.to_array().map(f64::from)
}

/// To the nearest.
pub(super) fn narrow(v: Wide) -> Vec3 {
    Vec3::from_array(v.map(|x| x as f32))
}

pub(super) fn add([a, b, c]: Wide, [x, y, z]: Wide) -> Wide {
    [a + x, b + y, c + z]
}

pub(super) fn sub([a, b, c]: Wide, [x, y, z]: Wide) -> Wide {
    [a - x, b - y, c - z]
}

pub(super) fn scale(v: Wide, factor: f64) -> Wide {
    v.map(|x| x * factor)
}

pub(super) fn dot([a, b, c]: Wide, [x, y, z]: Wide) -> f64 {
    a * x + b * y + c * z
}

pub(super) fn square(v: Wide) -> f64 {
    dot(v, v)
}

pub(super) fn cross([a, b, c]: Wide, [x, y, z]: Wide) -> Wide {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// At length 1; `None` if there is no direction.
pub(super) fn unit(v: Wide) -> Option<Wide> {
    let length = math::sqrt64(square(v));
    (length > 0.0).then(|| scale(v, 1.0 / length))
}

/// The least `f32` that is not below.
pub(super) fn upward(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}

/// The barycentre of the points, each counted once; `None` of none.
pub(super) fn mean(points: impl Iterator<Item = Vec3>) -> Option<Wide> {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for point in points {
        sum = add(sum, wide(point));
        count += 1.0;
    }
    (count > 0.0).then(|| scale(sum, 1.0 / count))
}
