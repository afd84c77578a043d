use glam::{Mat3, Vec3};

use crate::{math, primitives::unit};

/// Where a sensor is and how it is turned.
///
/// ```
/// use hitscan::{glam::Vec3, sensor::Pose};
/// let pose = Pose::looking(Vec3::ZERO, Vec3::X, Vec3::Y);
/// assert_eq!((pose.ahead(), pose.right(), pose.up()), (Vec3::X, Vec3::Z, Vec3::Y));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The point from which it measures.
    pub position: Vec3,
    /// What takes its own coordinates, x to the right, y down and z ahead, to those of the scene.
    pub rotation: Mat3,
}

impl Pose {
    /// At `position`, turned by `rotation`, whose columns are where right, down and ahead point in the scene.
    #[must_use]
    pub const fn new(position: Vec3, rotation: Mat3) -> Self {
        Self { position, rotation }
    }

    /// At `position`, looking at `target` with `up` upwards.
    #[must_use]
    pub fn looking(position: Vec3, target: Vec3, up: Vec3) -> Self {
        let ahead = unit(target - position);
        let right = unit(ahead.cross(up));
        Self::new(position, Mat3::from_cols(right, ahead.cross(right), ahead))
    }

    /// The same place, turned to its own right by an angle in radians.
    #[must_use]
    pub fn turned(&self, angle: f32) -> Self {
        let (sin, cos) = math::sin_cos(angle);
        let Mat3 { x_axis: right, y_axis: down, z_axis: ahead } = self.rotation;
        let rotation = Mat3::from_cols(right * cos - ahead * sin, down, ahead * cos + right * sin);
        Self { rotation, ..*self }
    }

    /// Its right, in the scene.
    #[must_use]
    pub const fn right(&self) -> Vec3 {
        self.rotation.x_axis
    }

    /// What is above it.
    #[must_use]
    pub fn up(&self) -> Vec3 {
        -self.rotation.y_axis
    }

    /// Where it looks.
    #[must_use]
    pub const fn ahead(&self) -> Vec3 {
        self.rotation.z_axis
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_pose_is_a_rotation() {
        let pose = Pose::looking(Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, 0.5, 7.0), Vec3::Y).turned(0.7);
        let Mat3 { x_axis, y_axis, z_axis } = pose.rotation;
        assert!((x_axis.cross(y_axis) - z_axis).length() < 1.0e-6);
        assert!((pose.rotation.determinant() - 1.0).abs() < 1.0e-6);
    }

    #[test]
    fn a_quarter_turn_looks_to_the_right() {
        let pose = Pose::looking(Vec3::ZERO, Vec3::Z, Vec3::Y);
        let turned = pose.turned(FRAC_PI_2);
        assert!((turned.ahead() - pose.right()).length() < 1.0e-6);
        assert_eq!(turned.up(), pose.up());
    }

    #[test]
    fn looking_nowhere_is_still_a_pose() {
        for target in [Vec3::ZERO, Vec3::Y, Vec3::NAN] {
            let pose = Pose::looking(Vec3::ZERO, target, Vec3::Y);
            assert!(pose.rotation.is_finite(), "{target}");
        }
    }
}
