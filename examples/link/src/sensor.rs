//! Range sensors.

use core::hint::black_box;

use hitscan::{
    render::Caster,
    sensor::{Pose, RangeSensor, depth_zones, rings, zones},
};

use crate::input::{float, matrix, some, vector, word};

/// Lets a sensor see `scene` from anywhere.
pub fn sees(scene: &(impl Caster + ?Sized)) {
    let mut beams = None;
    let sensor = RangeSensor::new(some(vector, &mut beams));
    let sensor = sensor.in_units_of(float()).within(float(), float()).seeing(word());
    for pose in [Pose::new(vector(), matrix()), Pose::looking(vector(), vector(), vector())] {
        let pose = pose.turned(float());
        black_box((pose.right(), pose.up(), pose.ahead()));
        black_box((sensor.ranges(scene, &pose).last(), sensor.echoes(scene, &pose).last()));
        black_box((sensor.sweep(scene, &pose, word()).last(), sensor.rays(&pose).last()));
    }
    black_box((zones::<8, 8>([float(); 2]), depth_zones::<4, 2>([float(); 2]), rings([float(); 3])));
}
