//! What the tests share: random numbers, adversarial scenes and rays.
#![allow(dead_code, missing_docs)]

use hitscan::{Hit, Ray, geometry::Aabb, glam::Vec3};

pub mod closed;
pub mod memo;
pub mod meshes;
pub mod plans;
pub mod seal;

/// How many rays a test casts: `usual`, or as many as `HITSCAN_RAYS` says, for long runs.
pub fn rays(usual: usize) -> usize {
    from_environment("HITSCAN_RAYS").unwrap_or(usual)
}

/// Added to the seeds of what is long run, so that every run may see other scenes: `HITSCAN_SEED`.
pub fn seed() -> u64 {
    from_environment("HITSCAN_SEED").unwrap_or(0) as u64
}

fn from_environment(name: &str) -> Option<usize> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text} is no number")))
}

/// A hit for comparisons that tell -0 from 0.
pub fn bits(hit: Option<Hit>) -> Option<(u32, u32)> {
    hit.map(|hit| (hit.t.to_bits(), hit.primitive))
}

/// A small generator of reproducible numbers (xorshift64*, Vigna 2016).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((u64::from(self.next()) * n as u64) >> 32) as usize
    }

    /// Whether a chance of one in `n` comes true.
    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A number from 0 up to 1.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 8) as f32 / 16_777_216.0
    }

    /// Any order, as likely as any other.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for end in (1..list.len()).rev() {
            list.swap(end, self.below(end + 1));
        }
    }

    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

/// How many families of coordinates there are.
pub const FAMILIES: usize = 11;

/// A coordinate of a family: grids that make ties, numbers that cancel, underflow or overflow.
pub fn coordinate(random: &mut Random, family: usize) -> f32 {
    match family {
        0 => random.below(5) as f32 - 2.0,
        1 => (random.below(9) as f32 - 4.0) * 0.25,
        2 => random.unit() * 2.0 - 1.0,
        3 => (random.below(5) as f32 - 2.0) * 0.1,
        4 => random.pick(&[0.0, -0.0, 1.0, -1.0, 1.0e-40, 0.5, f32::MIN_POSITIVE, -1.0e-42]),
        5 => 4096.0 + random.below(9) as f32 / 2048.0,
        6 => 1.0e5 + random.unit() * 4.0,
        7 => (random.unit() - 0.5) * 10.0_f32.powi(random.below(13) as i32 - 6),
        8 => (random.below(9) as f32 - 4.0) * 1.0e-20,
        9 => (random.below(3) as f32 - 1.0) * 3.0e15 + random.unit(),
        _ => (random.below(7) as f32 - 3.0) / 3.0,
    }
}

pub fn point(random: &mut Random, family: usize) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| coordinate(random, family)))
}

/// Vertices and triangles made to break engines: shared, flat, thin, degenerate and repeated ones.
pub fn adversarial_mesh(random: &mut Random, family: usize, most: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let count = 1 + random.below(most);
    let pool: Vec<Vec3> = (0..3 + random.below(12)).map(|_| point(random, family)).collect();
    let pooled = random.one_in(2);
    let flat = random.below(4);
    let mut vertices = Vec::new();
    for _ in 0..count {
        let mut corners = [0; 3].map(|_| {
            let family = if random.one_in(10) { random.below(FAMILIES) } else { family };
            if pooled { random.pick(&pool) } else { point(random, family) }
        });
        if flat < 3 && random.one_in(2) {
            let c = coordinate(random, family);
            corners.iter_mut().for_each(|v| v[flat] = c);
        }
        if random.one_in(12) {
            corners[1] = corners[0];
            corners[1][random.below(3)] += random.unit() * 1.0e-6;
        }
        if random.one_in(16) && vertices.len() >= 3 {
            let other = random.below(vertices.len() / 3) * 3;
            corners.copy_from_slice(&vertices[other..other + 3]);
            if random.one_in(2) {
                corners.swap(0, 1);
            }
        }
        vertices.extend(corners);
    }
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (vertices, triangles)
}

/// A ray at the mesh: at corners, edges, planes and at random, parallel to axes or not, with all kinds of intervals.
pub fn adversarial_ray(random: &mut Random, family: usize, vertices: &[Vec3]) -> Ray {
    let triangle = random.below(vertices.len() / 3) * 3;
    let [a, b, c] = [0, 1, 2].map(|i| vertices[triangle + i]);
    let target = |random: &mut Random| match random.below(5) {
        0 => random.pick(&[a, b, c]),
        1 => random.pick(&[a, b, c]) * 0.5 + random.pick(&[a, b, c]) * 0.5,
        2 => {
            let (x, y) = (random.unit(), random.unit());
            a + (b - a) * x + (c - a) * y * (1.0 - x)
        }
        3 => point(random, family),
        _ => random.pick(vertices),
    };
    let aim = target(random);
    let (mut origin, mut direction);
    match random.below(4) {
        0 => {
            let axis = random.below(3);
            direction = Vec3::splat(random.pick(&[0.0, -0.0, 1.0e-40, -1.0e-39, 1.0e-30]));
            direction[axis] = random.pick(&[1.0, -2.0]);
            origin = aim;
            origin[axis] = coordinate(random, family);
        }
        1 => {
            origin = point(random, family);
            direction = aim - origin;
        }
        2 => {
            origin = target(random);
            direction = aim - origin;
            if random.one_in(2) {
                origin -= direction;
            }
        }
        _ => {
            direction = Vec3::from_array([0; 3].map(|_| random.below(3) as f32 - 1.0));
            origin = aim - direction * random.below(5) as f32;
        }
    }
    if random.one_in(4) {
        // In a plane through a corner, where splits are.
        let axis = random.below(3);
        origin[axis] = random.pick(vertices)[axis];
        if random.one_in(2) {
            direction[axis] = random.pick(&[0.0, -0.0, 1.0e-41, -1.0e-38]);
        }
    }
    if random.one_in(8) {
        direction *= random.pick(&[2.0_f32.powi(-90), 2.0_f32.powi(90), 3.7, 1.0e-10]);
    }
    let intervals = [(f32::NEG_INFINITY, f32::INFINITY), (-1.0, 1.0), (1.0, f32::INFINITY), (-3.0, -0.25), (0.0, 0.5)];
    let (t_min, t_max) = intervals.get(random.below(9)).copied().unwrap_or((0.0, f32::INFINITY));
    Ray::new(origin, direction).starting_at(t_min).up_to(t_max)
}

/// A box between two points.
pub fn boxed(random: &mut Random, family: usize) -> Aabb {
    Aabb::around([point(random, family), point(random, family)])
}

/// A number that has nothing to do with any shape, but is always the same for the same ray and shape.
pub fn noise(index: u32, ray: &Ray) -> f32 {
    let mut seed = u64::from(index);
    for x in ray.origin.to_array().into_iter().chain(ray.direction.to_array()) {
        seed = (seed ^ u64::from(x.to_bits())).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
    }
    let mut random = Random::new(seed);
    let scale = random.pick(&[1.0, 100.0, f32::MAX, f32::NAN, 1.0e-3]);
    (random.unit() - 0.3) * scale
}
