use std::{fmt, str::FromStr};

use hitscan::{geometry::Aabb, glam::Vec3, render::Camera};

/// The vertical angle of view in degrees, unless another is given: tan of half of it is 0.36, as [`Camera::framing`] has.
const FOV: f32 = 39.6;

/// A camera as given on the command line: `EYE/TARGET` or `EYE/TARGET/DEGREES`, points as `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraArg {
    eye: Vec3,
    target: Vec3,
    fov: f32,
}

impl CameraArg {
    /// A camera at `eye` that looks at `target` with this vertical angle of view in degrees.
    pub const fn new(eye: Vec3, target: Vec3, fov: f32) -> Self {
        Self { eye, target, fov }
    }
}

impl FromStr for CameraArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.split('/');
        let points = parts.next().zip(parts.next());
        let (eye, target) = points
            .and_then(|(eye, target)| Some((point(eye)?, point(target)?)))
            .ok_or("give EYE/TARGET or EYE/TARGET/DEGREES such as 3,2,5/0,1,0/40")?;
        if !(eye - target).length().is_normal() {
            return Err("the eye must be some finite way off the target".to_owned());
        }
        let fov = parts.next().map_or(Ok(FOV), str::parse);
        match fov {
            Ok(fov) if (0.1..=170.0).contains(&fov) && parts.next().is_none() => Ok(Self { eye, target, fov }),
            _ => Err("the angle of view must be 0.1 to 170 degrees".to_owned()),
        }
    }
}

/// As it is given on the command line; reads back to the same bits.
impl fmt::Display for CameraArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([a, b, c], [d, e, g]) = (self.eye.to_array(), self.target.to_array());
        write!(f, "{a},{b},{c}/{d},{e},{g}/{}", self.fov)
    }
}

fn point(text: &str) -> Option<Vec3> {
    let numbers: Vec<f32> = text.split(',').map(|word| word.trim().parse().ok()).collect::<Option<_>>()?;
    let numbers: [f32; 3] = numbers.try_into().ok()?;
    Some(Vec3::from(numbers)).filter(|point| point.is_finite())
}

/// Which axis points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Up {
    X,
    Y,
    Z,
}

impl Up {
    /// The likeliest one: that along which a mesh is flat, or far longer than wide; else y, as the picture formats have it.
    pub fn guess(bounds: &Aabb) -> Self {
        /// So much thinner than its second side is a plan, a floor, a plane; so much longer is a tower, a robot.
        const FLAT: f32 = 0.25;
        const TALL: f32 = 2.5;
        let size = bounds.size();
        let mut order = [Self::X, Self::Y, Self::Z];
        order.sort_by(|a, b| size[*a as usize].total_cmp(&size[*b as usize]));
        let [least, middle, most] = order.map(|axis| size[axis as usize]);
        if least < FLAT * middle {
            order[0]
        } else if most > TALL * middle && order[2] == Self::Z {
            // Robots stand along z; what lies along x or y is more often a vehicle or an animal.
            order[2]
        } else {
            Self::Y
        }
    }

    /// The axis as a direction.
    pub fn direction(self) -> Vec3 {
        Vec3::AXES[self as usize]
    }

    /// From the middle of a scene towards somebody who looks at its front, from a little to the right and above.
    fn towards_viewer(self, bounds: &Aabb) -> Vec3 {
        let size = bounds.size();
        let (up, front) = match self {
            Self::X => (Vec3::X, Vec3::Z),
            Self::Y => (Vec3::Y, Vec3::Z),
            // Where z is up, y points away from the viewer.
            Self::Z => (Vec3::Z, Vec3::NEG_Y),
        };
        // Flat scenes are looked at from higher up.
        let breadth = (size - up * size).max_element();
        let flatness = 1.0 - (size.dot(up) / breadth.max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        front + front.cross(up) * -0.6 + up * (0.35 + 0.65 * flatness)
    }
}

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug)]
pub struct Viewpoint {
    /// The camera itself.
    pub camera: Camera,
    /// The direction to its right, of length 1.
    pub right: Vec3,
    /// The direction above it, of length 1.
    pub above: Vec3,
}

impl Viewpoint {
    /// The camera that was asked for, or one that sees all `points` in a picture so many times as wide as high.
    pub fn new(
        asked: Option<CameraArg>,
        bounds: &Aabb,
        up: Up,
        aspect: f32,
        points: impl Iterator<Item = Vec3>,
    ) -> Self {
        let asked = asked.unwrap_or_else(|| framing(bounds, up, aspect, points));
        let mut above = up.direction();
        // Who looks straight up or down needs another direction for the picture's upper edge.
        if (asked.target - asked.eye).normalize_or_zero().cross(above).length() < 1.0e-3 {
            above = Vec3::AXES[(up as usize + 1) % 3];
        }
        let camera = Camera::pinhole(asked.eye, asked.target, above, asked.fov.to_radians());
        Self { camera, right: camera.forward().cross(camera.up()), above: camera.up() }
    }
}

/// The nearest camera in its direction that sees all `points`, but for a margin.
fn framing(bounds: &Aabb, up: Up, aspect: f32, points: impl Iterator<Item = Vec3>) -> CameraArg {
    const MARGIN: f32 = 1.12;
    let backward = up.towards_viewer(bounds).normalize();
    let right = up.direction().cross(backward).normalize();
    let above = backward.cross(right);
    let center = bounds.center();
    let tan = (FOV * 0.5).to_radians().tan() / MARGIN;
    // Each side of the view is a plane that all points must be behind; two opposite ones meet where the eye must be.
    let [mut x, mut y] = [(f32::INFINITY, f32::NEG_INFINITY); 2];
    for point in points {
        let off = point - center;
        let depth = off.dot(backward);
        for (side, range, slope) in [(right, &mut x, tan * aspect), (above, &mut y, tan)] {
            let across = off.dot(side);
            *range = (range.0.min(across - depth * slope), range.1.max(across + depth * slope));
        }
    }
    let width = (x.1 - x.0) / (2.0 * tan * aspect);
    let distance = width.max((y.1 - y.0) / (2.0 * tan)).max(f32::MIN_POSITIVE);
    let target = center + right * ((x.0 + x.1) * 0.5) + above * ((y.0 + y.1) * 0.5);
    CameraArg::new(target + backward * distance, target, FOV)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_are_sensible_or_refused() {
        let camera: CameraArg = "-1,2,3/0,0,0".parse().unwrap();
        assert_eq!((camera.eye, camera.fov), (Vec3::new(-1.0, 2.0, 3.0), FOV));
        assert_eq!("1,2,3/0,0,0/60".parse::<CameraArg>().unwrap().fov, 60.0);
        let odd: CameraArg = "-0.1,1e-30,3e9/0.3,-0,7/33.3".parse().unwrap();
        assert_eq!(odd.to_string().parse(), Ok(odd));
        for bad in [
            "",
            "1,2,3",
            "1,2/0,0,0",
            "1,1,1/1,1,1",
            "nan,0,0/1,1,1",
            "0,0,0/1,1,1/0",
            "0,0,0/1,1,1/50/7",
            "9e38,0,0/1,1,1",
        ] {
            assert!(bad.parse::<CameraArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn flat_and_tall_scenes_show_their_up() {
        let guess = |x, y, z| Up::guess(&Aabb::new(Vec3::ZERO, Vec3::new(x, y, z)));
        assert_eq!(guess(1.0, 1.0, 1.0), Up::Y);
        assert_eq!(guess(44.0, 25.0, 2.5), Up::Z);
        assert_eq!(guess(0.33, 0.26, 1.1), Up::Z);
        assert_eq!(guess(9.0, 1.0, 8.0), Up::Y);
        assert_eq!(guess(0.0, 0.0, 0.0), Up::Y);
    }

    #[test]
    fn the_whole_box_is_in_the_picture() {
        for (size, aspect) in [(Vec3::ONE, 1.5), (Vec3::new(1.0, 9.0, 1.0), 0.5), (Vec3::new(40.0, 20.0, 0.0), 2.0)] {
            let bounds = Aabb::new(Vec3::splat(3.0), Vec3::splat(3.0) + size);
            let corners = [bounds.min, bounds.max, Vec3::new(bounds.min.x, bounds.max.y, bounds.min.z)];
            let view = Viewpoint::new(None, &bounds, Up::guess(&bounds), aspect, corners.into_iter());
            let (eye, forward) = (view.camera.eye(), view.camera.forward());
            let tan = (FOV * 0.5).to_radians().tan();
            for corner in corners {
                let off = corner - eye;
                let depth = off.dot(forward);
                assert!(depth > 0.0 && off.dot(view.right).abs() <= depth * tan * aspect, "{size}");
                assert!(off.dot(view.above).abs() <= depth * tan, "{size}");
            }
        }
    }
}
