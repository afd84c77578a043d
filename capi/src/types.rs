//! Plain data that C and Rust both see.

use bytemuck::{Pod, Zeroable};
use engine::{
    glam,
    primitives::{self, Indices, MeshError, Sides},
};

use crate::{
    raw::{In, Out},
    status::Status,
};

/// A point or a direction.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
#[allow(missing_docs, reason = "named by the axes")]
pub struct Vec3 {
    pub x: f32,
    pub y: f32,
    pub z: f32,
}

/// A half-line: the points origin + t * direction for t_min <= t <= t_max. Made by hitscan_ray_new or hitscan_ray_between.
///
/// The direction need not have length 1. A ray misses everything if a component is not finite, the interval is empty, or the
/// largest component of the direction is not within 2^-100 and 2^100.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Ray {
    /// The point at t = 0.
    pub origin: Vec3,
    /// The step for one unit of t.
    pub direction: Vec3,
    /// The least t that counts, itself included.
    pub t_min: f32,
    /// The greatest t that counts, itself included; INFINITY for no limit.
    pub t_max: f32,
    /// Only triangles whose mask shares a bit with this one are seen.
    pub mask: u32,
}

/// Where a ray hits which triangle. Hits are ordered by t, then by number.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Hit {
    /// The ray's parameter; the distance if its direction has length 1.
    pub t: f32,
    /// The triangle's number.
    pub triangle: u32,
}

/// The surface at a hit.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Surface {
    /// The point.
    pub point: Vec3,
    /// The unit normal on the side from which the corners run counter-clockwise.
    pub normal: Vec3,
    /// Where a ray must start that leaves to the side from which this one came, so that it does not hit the triangle again.
    pub start: Vec3,
    /// The weight of the triangle's second corner.
    pub u: f32,
    /// The weight of the triangle's third corner.
    pub v: f32,
    /// Whether the ray came from the side of the normal.
    pub front: bool,
}

/// The point of a scene that is nearest to another.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Nearest {
    /// The point.
    pub point: Vec3,
    /// How far away it is.
    pub distance: f32,
    /// The triangle on which it lies.
    pub triangle: u32,
}

/// A box.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Box {
    /// The least coordinates.
    pub min: Vec3,
    /// The greatest coordinates.
    pub max: Vec3,
}

/// Triangles in the caller's memory.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Mesh {
    /// The positions of the vertices.
    pub vertices: In<Vec3>,
    /// How many there are.
    pub vertex_count: usize,
    /// Three vertices per triangle, in 16 bits; NULL if they are in 32.
    pub indices16: In<u16>,
    /// Three vertices per triangle, in 32 bits; NULL if they are in 16.
    pub indices32: In<u32>,
    /// How many triangles there are.
    pub triangle_count: usize,
    /// A mask per triangle: rays that share no bit with it do not see it. NULL if all rays see all triangles.
    pub masks: In<u32>,
    /// Whether triangles are hit from the front only, the side from which the corners run counter-clockwise.
    pub front_only: bool,
}

/// Memory for structures, taken from the front.
#[repr(C)]
pub struct Arena {
    /// The words that are free.
    pub words: Out<u32>,
    /// How many there are.
    pub count: usize,
}

impl Surface {
    /// The surface at a hit of `ray`.
    pub fn new(surface: &primitives::Surface, ray: &engine::Ray) -> Self {
        Self {
            point: surface.point.into(),
            normal: surface.geometric_normal.into(),
            start: surface.start_towards(-ray.direction).into(),
            u: surface.uv.x,
            v: surface.uv.y,
            front: surface.front,
        }
    }
}

impl Mesh {
    /// The checked mesh.
    pub fn open(&self) -> Result<engine::Mesh<'static>, Status> {
        self.check().map_err(|(status, _)| status)
    }

    /// The checked mesh, or what is wrong with which triangle; the number of triangles if it is none of them.
    pub fn check(&self) -> Result<engine::Mesh<'static>, (Status, u32)> {
        let nowhere = |status| (status, self.triangle_count as u32);
        let (vertices, indices) = self.parts().map_err(nowhere)?;
        let mesh = engine::Mesh::new(vertices, indices).map_err(|error| match error {
            MeshError::Index { triangle, .. } | MeshError::Vertex { triangle, .. } => (error.into(), triangle),
            _ => nowhere(error.into()),
        })?;
        let mesh = mesh.with_sides(if self.front_only { Sides::Front } else { Sides::Both });
        if self.masks.is_null() {
            return Ok(mesh);
        }
        let masks = self.masks.array(self.triangle_count).map_err(nowhere)?;
        mesh.with_masks(masks).map_err(|error| nowhere(error.into()))
    }

    fn parts(&self) -> Result<(&'static [glam::Vec3], Indices<'static>), Status> {
        let vertices = cast(self.vertices.array(self.vertex_count)?);
        let count = self.triangle_count.checked_mul(3).ok_or(Status::Length)?;
        let indices: Indices<'static> = match (self.indices16.is_null(), self.indices32.is_null()) {
            (false, true) => corners(self.indices16.array(count)?).into(),
            (true, false) => corners(self.indices32.array(count)?).into(),
            _ if count == 0 => Indices::Narrow(&[]),
            _ => return Err(Status::Null),
        };
        Ok((vertices, indices))
    }
}

impl Arena {
    /// Leaves the last `available` words.
    pub fn advance(&mut self, available: usize) {
        self.words = self.words.skip(self.count.saturating_sub(available));
        self.count = available;
    }
}

/// The same numbers as another type of the same layout.
fn cast<A: Pod, B: Pod>(values: &[A]) -> &[B] {
    bytemuck::try_cast_slice(values).unwrap_or_default()
}

/// Three by three.
fn corners<T: Pod>(vertices: &[T]) -> &[[T; 3]] {
    vertices.as_chunks().0
}

impl From<Vec3> for glam::Vec3 {
    fn from(Vec3 { x, y, z }: Vec3) -> Self {
        Self { x, y, z }
    }
}

impl From<glam::Vec3> for Vec3 {
    fn from(glam::Vec3 { x, y, z }: glam::Vec3) -> Self {
        Self { x, y, z }
    }
}

impl From<&Ray> for engine::Ray {
    fn from(&Ray { origin, direction, t_min, t_max, mask }: &Ray) -> Self {
        Self { origin: origin.into(), direction: direction.into(), t_min, t_max, mask }
    }
}

impl From<engine::Ray> for Ray {
    fn from(engine::Ray { origin, direction, t_min, t_max, mask }: engine::Ray) -> Self {
        Self { origin: origin.into(), direction: direction.into(), t_min, t_max, mask }
    }
}

impl From<engine::Hit> for Hit {
    fn from(engine::Hit { t, primitive }: engine::Hit) -> Self {
        Self { t, triangle: primitive }
    }
}

impl From<Hit> for engine::Hit {
    fn from(Hit { t, triangle }: Hit) -> Self {
        Self { t, primitive: triangle }
    }
}

impl From<primitives::Nearest> for Nearest {
    fn from(primitives::Nearest { point, distance, primitive }: primitives::Nearest) -> Self {
        Self { point: point.into(), distance, triangle: primitive }
    }
}

impl From<engine::geometry::Aabb> for Box {
    fn from(engine::geometry::Aabb { min, max }: engine::geometry::Aabb) -> Self {
        Self { min: min.into(), max: max.into() }
    }
}
