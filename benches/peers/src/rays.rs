use std::{f32::consts::TAU, fmt};

use hitscan::{
    Accelerator, Primitives, Ray, Scene,
    geometry::Aabb,
    glam::{Vec3, Vec3Swizzles},
};

use crate::random::Random;

/// What is asked of the rays of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The first hit.
    Closest,
    /// Whether there is a hit.
    Any,
}

/// Where the rays of a set come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From a camera that sees the whole model.
    Primary,
    /// From where the primary rays hit, in directions distributed as a matte surface scatters light.
    Diffuse,
    /// From where the primary rays hit to a point light.
    Shadow,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Primary, Self::Diffuse, Self::Shadow];

    /// What is asked of them.
    pub const fn query(self) -> Query {
        match self {
            Self::Primary | Self::Diffuse => Query::Closest,
            Self::Shadow => Query::Any,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Primary => "primary",
            Self::Diffuse => "diffuse",
            Self::Shadow => "shadow",
        })
    }
}

/// Rays of one kind, in the order of the pixels they belong to.
#[derive(Debug)]
pub struct RaySet {
    /// Where they come from.
    pub kind: Kind,
    /// The rays.
    pub rays: Vec<Ray>,
}

/// A set of each kind: `count` primary rays, and as many of the others as of these hit.
pub fn all<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, count: usize) -> [RaySet; 3] {
    let bounds = scene.bounds();
    let (eye, primary) = camera(&bounds, count);
    let offset = bounds.size().length() * 1.0e-5;
    let hits: Vec<(Vec3, Vec3)> = primary.iter().filter_map(|ray| surface(scene, ray, offset)).collect();
    let mut random = Random::new(1);
    let diffuse = hits.iter().map(|&(point, normal)| Ray::new(point, scatter(normal, &mut random))).collect();
    // Beside the camera.
    let light = eye + (eye - bounds.center()).yzx() * 0.5;
    let shadow = hits.iter().map(|&(point, _)| Ray::between(point, light)).collect();
    [(Kind::Primary, primary), (Kind::Diffuse, diffuse), (Kind::Shadow, shadow)]
        .map(|(kind, rays)| RaySet { kind, rays })
}

/// A camera's eye and one ray per pixel of a square picture that holds the sphere around `bounds`.
fn camera(bounds: &Aabb, count: usize) -> (Vec3, Vec<Ray>) {
    let center = bounds.center();
    let radius = bounds.size().length() / 2.0;
    let ahead = Vec3::new(-0.5, -0.45, -0.74).normalize();
    let eye = center - ahead * (radius * 2.0);
    let right = ahead.cross(Vec3::Y).normalize();
    let up = right.cross(ahead);
    // The half angle of the sphere seen from two radii away is 30 degrees.
    let half = 0.577;
    let side = (count as f32).sqrt() as u32;
    let pixel = |i: u32| ((i as f32 + 0.5) / side as f32 * 2.0 - 1.0) * half;
    let rays = (0..side)
        .flat_map(|y| (0..side).map(move |x| (x, y)))
        .map(|(x, y)| Ray::new(eye, (ahead + right * pixel(x) - up * pixel(y)).normalize()))
        .collect();
    (eye, rays)
}

/// The point `offset` before the surface that `ray` hits, and the normal there.
fn surface<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, ray: &Ray, offset: f32) -> Option<(Vec3, Vec3)> {
    let surface = scene.surface(ray, &scene.closest_hit(ray)?);
    let normal = surface.normal_towards_ray();
    Some((surface.point + normal * offset, normal))
}

/// A direction around `normal`, as likely as the cosine of the angle between the two.
fn scatter(normal: Vec3, random: &mut Random) -> Vec3 {
    let z = random.signed();
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    let sphere = Vec3::new(radius * cos, radius * sin, z);
    (normal + sphere * 0.9999).normalize()
}
