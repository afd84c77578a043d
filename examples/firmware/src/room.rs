//! A room with moving boxes, and the time-of-flight sensor on its wall.

use core::f32::consts::FRAC_PI_4;

use hitscan::{
    Arena, Bvh, Error, Instance, Instances, List, Mesh, Scene,
    bvh::Options,
    geometry::Transform,
    glam::{Mat3, Vec3},
    sensor::{Pose, RangeSensor, depth_zones},
};

/// Zones of the sensor, which are square: those of the VL53L5CX.
pub const ZONES: usize = 8;

/// Frames after which the boxes have arrived.
pub const FRAMES: u32 = 8;

/// A cube of side 1, for the room and what stands in it.
static CORNERS: [Vec3; 8] = [
    Vec3::new(-0.5, -0.5, -0.5),
    Vec3::new(0.5, -0.5, -0.5),
    Vec3::new(-0.5, 0.5, -0.5),
    Vec3::new(0.5, 0.5, -0.5),
    Vec3::new(-0.5, -0.5, 0.5),
    Vec3::new(0.5, -0.5, 0.5),
    Vec3::new(-0.5, 0.5, 0.5),
    Vec3::new(0.5, 0.5, 0.5),
];

/// Two triangles a side.
#[rustfmt::skip]
static TRIANGLES: [[u16; 3]; 12] = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
];

/// The room, 4 m x 2.5 m x 4 m.
#[derive(Debug)]
pub struct Room<'a> {
    cube: [Scene<Bvh<'a>, Mesh<'static>>; 1],
    beams: [[Vec3; ZONES]; ZONES],
}

/// A cube of this size around this place.
fn placed(size: [f32; 3], center: [f32; 3]) -> Result<Instance, Error> {
    let scale = Mat3::from_diagonal(Vec3::from_array(size));
    Ok(Instance::new(0, Transform::new(scale, Vec3::from_array(center))?))
}

impl<'a> Room<'a> {
    /// Builds the cube of which everything is made.
    ///
    /// # Errors
    ///
    /// If the arena is too small.
    pub fn new(arena: &mut Arena<'a>) -> Result<Self, Error> {
        let mesh = Mesh::new(&CORNERS, &TRIANGLES)?;
        let bvh = Bvh::build(&mesh, arena, &Options::small())?;
        Ok(Self { cube: [Scene::new(bvh, mesh)?], beams: depth_zones([FRAC_PI_4; 2]) })
    }

    /// The millimetres that the sensor reports in a frame, row by row; none where nothing is in range.
    ///
    /// # Errors
    ///
    /// None, but the library cannot know where the boxes are.
    pub fn ranges(&self, frame: u32) -> Result<[Option<u16>; ZONES * ZONES], Error> {
        let way = frame as f32 / FRAMES as f32;
        let mut places = [
            placed([4.0, 2.5, 4.0], [0.0, 1.25, 0.0])?,
            placed([0.5, 0.5, 0.5], [1.5 - 3.0 * way, 0.25, 0.2])?,
            placed([0.4, 1.2, 0.4], [-0.4, 0.6, 1.6 - 2.0 * way])?,
        ];
        let things = Instances::place(&self.cube, &mut places)?;
        let scene = Scene::new(List::new(&things)?, things)?;

        let sensor = RangeSensor::new(self.beams.as_flattened()).in_units_of(0.001).within(20.0, 4000.0);
        let pose = Pose::looking(Vec3::new(0.0, 1.4, -1.9), Vec3::new(0.0, 0.8, 0.0), Vec3::Y);
        let mut ranges = [None; ZONES * ZONES];
        for (range, hit) in ranges.iter_mut().zip(sensor.ranges(&scene, &pose)) {
            *range = hit.map(|hit| (hit.t + 0.5) as u16);
        }
        Ok(ranges)
    }
}
