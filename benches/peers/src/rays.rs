use std::{f32::consts::TAU, fmt};

use clap::ValueEnum;
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
    /// From a camera.
    Primary,
    /// From where the primary rays hit, in directions distributed as a matte surface scatters light.
    Diffuse,
    /// From where the primary rays hit to a point light.
    Shadow,
    /// As the diffuse ones, a tenth of the model long: whether something is near.
    Ambient,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Primary, Self::Diffuse, Self::Shadow, Self::Ambient];

    /// What is asked of them.
    pub const fn query(self) -> Query {
        match self {
            Self::Primary | Self::Diffuse => Query::Closest,
            Self::Shadow | Self::Ambient => Query::Any,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Primary => "primary",
            Self::Diffuse => "diffuse",
            Self::Shadow => "shadow",
            Self::Ambient => "ambient",
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
    /// What comes of each: the `t` of its hit, or 0 for any hit; infinite for a miss.
    pub truth: Vec<f32>,
}

impl RaySet {
    fn new<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, kind: Kind, rays: Vec<Ray>) -> Self {
        let truth = rays.iter().map(|ray| match kind.query() {
            Query::Closest => scene.closest_hit(ray).map_or(f32::INFINITY, |hit| hit.t),
            Query::Any => {
                if scene.any_hit(ray) {
                    0.0
                } else {
                    f32::INFINITY
                }
            }
        });
        Self { kind, truth: truth.collect(), rays }
    }
}

/// In which order the rays come that begin where others hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Order {
    /// That of the picture's tiles: neighbours ask for the same memory.
    Tiles,
    /// None, as after many bounces.
    Shuffled,
}

/// Where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// So far away that it sees the whole model.
    Outside,
    /// In the middle, looking all around: for buildings.
    Inside,
}

impl View {
    /// Where the eye is.
    fn eye(self, bounds: &Aabb) -> Vec3 {
        match self {
            // Two radii from the sphere around the model, which is then 60 degrees wide.
            Self::Outside => bounds.center() - AHEAD.normalize() * bounds.size().length(),
            Self::Inside => bounds.center(),
        }
    }

    /// The rays through the pixels of a square picture, of this fineness or a little finer.
    fn rays(self, bounds: &Aabb, side: u32) -> impl Iterator<Item = Ray> {
        let eye = self.eye(bounds);
        let ahead = AHEAD.normalize();
        let right = ahead.cross(Vec3::Y).normalize();
        let up = right.cross(ahead);
        // A multiple of 4, so that no packet of 16 straddles two tiles.
        let side = side.next_multiple_of(4);
        let place = move |i: u32| (i as f32 + 0.5) / side as f32;
        let direction = move |x: f32, y: f32| match self {
            Self::Outside => (ahead + (right * (x * 2.0 - 1.0) + up * (1.0 - y * 2.0)) * 0.577).normalize(),
            Self::Inside => on_sphere(x, 1.0 - y * 2.0),
        };
        // Tiles of tiles (Morton 1966), as renderers go about it: 16 rays after each other are 4 by 4 pixels.
        (0..u64::from(side.next_power_of_two()).pow(2))
            .map(|code| (gather(code), gather(code >> 1)))
            .filter(move |&(x, y)| x < side && y < side)
            .map(move |(x, y)| Ray::new(eye, direction(place(x), place(y))))
    }
}

/// Where the camera looks from outside.
const AHEAD: Vec3 = Vec3::new(-0.5, -0.45, -0.74);

/// A set of each kind, of about `count` rays.
///
/// The primary ones are a picture. The others begin where the rays of a picture hit that is so much finer that as many of
/// them do.
pub fn all<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, view: View, count: usize, order: Order) -> [RaySet; 4] {
    /// How much finer at most, of each side: for a model that is hardly to be seen.
    const FINEST: f32 = 10.0;
    let bounds = scene.bounds();
    let size = bounds.size().length();
    let side = (count as f32).sqrt();
    let primary: Vec<Ray> = view.rays(&bounds, side as u32).collect();
    let seen = primary.iter().filter(|ray| scene.any_hit(ray)).count().max(1);
    let fineness = (primary.len() as f32 / seen as f32).sqrt().min(FINEST);
    let mut hits: Vec<(Vec3, Vec3)> =
        view.rays(&bounds, (side * fineness) as u32).filter_map(|ray| surface(scene, &ray, size * 1.0e-5)).collect();
    let mut random = Random::new(1);
    if order == Order::Shuffled {
        // Fisher and Yates 1938.
        (1..hits.len()).rev().for_each(|last| hits.swap(last, (random.unit() * (last + 1) as f32) as usize));
    }
    let mut bounce =
        || -> Vec<Ray> { hits.iter().map(|&(point, normal)| Ray::new(point, scatter(normal, &mut random))).collect() };
    let diffuse = bounce();
    let ambient = bounce().into_iter().map(|ray| ray.up_to(size * 0.1)).collect();
    // Beside the camera.
    let eye = view.eye(&bounds);
    let light = eye + (eye - bounds.center()).yzx() * 0.5 + bounds.size() * 0.05;
    let shadow = hits.iter().map(|&(point, _)| Ray::between(point, light)).collect();
    [(Kind::Primary, primary), (Kind::Diffuse, diffuse), (Kind::Shadow, shadow), (Kind::Ambient, ambient)]
        .map(|(kind, rays)| RaySet::new(scene, kind, rays))
}

/// Every other bit of the lower 32.
const fn gather(code: u64) -> u32 {
    let x = code as u32 & 0x5555_5555;
    let x = (x | x >> 1) & 0x3333_3333;
    let x = (x | x >> 2) & 0x0f0f_0f0f;
    let x = (x | x >> 4) & 0x00ff_00ff;
    (x | x >> 8) & 0x0000_ffff
}

/// The point `offset` before the surface that `ray` hits, and the normal there.
fn surface<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, ray: &Ray, offset: f32) -> Option<(Vec3, Vec3)> {
    let surface = scene.surface(ray, &scene.closest_hit(ray)?);
    let normal = surface.normal_towards_ray();
    Some((surface.point + normal * offset, normal))
}

/// A direction around `normal`, as likely as the cosine of the angle between the two.
fn scatter(normal: Vec3, random: &mut Random) -> Vec3 {
    // Not quite 1, so that the sum is never zero.
    (normal + on_sphere(random.unit(), random.signed()) * 0.9999).normalize()
}

/// The unit vector at this height, after this part of a turn; evenly spread where both are.
fn on_sphere(turn: f32, z: f32) -> Vec3 {
    let (sin, cos) = (TAU * turn).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    Vec3::new(radius * cos, radius * sin, z)
}
