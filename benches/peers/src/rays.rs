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

/// Where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// So far away that it sees the whole model.
    Outside,
    /// In the middle, looking all around: for buildings.
    Inside,
}

impl View {
    /// The eye and the directions through the pixels of a square picture.
    fn camera(self, bounds: &Aabb, side: u32) -> (Vec3, Vec<Vec3>) {
        let place = |i: u32| (i as f32 + 0.5) / side as f32;
        let mut pixels: Vec<(u32, u32)> = (0..side).flat_map(|y| (0..side).map(move |x| (x, y))).collect();
        // Tiles of tiles (Morton 1966), as renderers go about it: 16 rays after each other are 4 by 4 pixels.
        pixels.sort_by_key(|&(x, y)| spread(x) | spread(y) << 1);
        let pixels = pixels.into_iter().map(|(x, y)| (place(x), place(y)));
        match self {
            Self::Outside => {
                let ahead = Vec3::new(-0.5, -0.45, -0.74).normalize();
                let right = ahead.cross(Vec3::Y).normalize();
                let up = right.cross(ahead);
                // Two radii from the sphere around the model, which is then 60 degrees wide.
                let half = 0.577;
                let through = |(x, y)| ahead + (right * (x * 2.0 - 1.0) + up * (1.0 - y * 2.0)) * half;
                (bounds.center() - ahead * bounds.size().length(), pixels.map(through).map(Vec3::normalize).collect())
            }
            Self::Inside => (bounds.center(), pixels.map(|(x, y)| on_sphere(x, 1.0 - y * 2.0)).collect()),
        }
    }
}

/// A set of each kind: about `count` primary rays, and as many of the others as of these hit.
pub fn all<A: Accelerator, P: Primitives>(scene: &Scene<A, P>, view: View, count: usize) -> [RaySet; 4] {
    let bounds = scene.bounds();
    // A multiple of 4, so that no packet of 16 straddles two tiles.
    let (eye, directions) = view.camera(&bounds, ((count as f32).sqrt() as u32).next_multiple_of(4));
    let primary: Vec<Ray> = directions.into_iter().map(|direction| Ray::new(eye, direction)).collect();
    let size = bounds.size().length();
    let hits: Vec<(Vec3, Vec3)> = primary.iter().filter_map(|ray| surface(scene, ray, size * 1.0e-5)).collect();
    let mut random = Random::new(1);
    let mut bounce =
        || -> Vec<Ray> { hits.iter().map(|&(point, normal)| Ray::new(point, scatter(normal, &mut random))).collect() };
    let diffuse = bounce();
    let ambient = bounce().into_iter().map(|ray| ray.up_to(size * 0.1)).collect();
    // Beside the camera.
    let light = eye + (eye - bounds.center()).yzx() * 0.5 + bounds.size() * 0.05;
    let shadow = hits.iter().map(|&(point, _)| Ray::between(point, light)).collect();
    [(Kind::Primary, primary), (Kind::Diffuse, diffuse), (Kind::Shadow, shadow), (Kind::Ambient, ambient)]
        .map(|(kind, rays)| RaySet::new(scene, kind, rays))
}

/// The lower 16 bits with a gap before each.
const fn spread(x: u32) -> u32 {
    let x = (x | x << 8) & 0x00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
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
