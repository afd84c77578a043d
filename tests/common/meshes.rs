//! Meshes that are hard on builders, in any size.

use hitscan::glam::Vec3;

use super::Random;

/// Vertices, and the triangles between them.
pub type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// Triangles that share no vertices.
pub fn separate(vertices: Vec<Vec3>) -> Triangles {
    let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (vertices, triangles)
}

/// Triangles of a size in a cube of 2.
pub fn random(count: usize, size: f32) -> Triangles {
    let mut random = Random::new(count as u64);
    let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
    separate((0..count).flat_map(|_| [point(2.0); 3].map(|v| v + point(size))).collect())
}

/// The same triangle again and again.
pub fn identical(count: usize) -> Triangles {
    separate([Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, -2.0, 1.0), Vec3::new(0.0, 2.0, 0.5)].repeat(count))
}

/// Large triangles around the same middle.
pub fn crossing(count: usize) -> Triangles {
    let mut random = Random::new(9);
    let mut point = || Vec3::from_array([0; 3].map(|_| random.unit() * 20.0 - 10.0));
    separate((0..count).map(|_| [point(), point()]).flat_map(|[a, b]| [a, b - a, -b]).collect())
}

/// Large triangles around one corner.
pub fn fan(count: usize) -> Triangles {
    let mut random = Random::new(9);
    let mut point = || Vec3::from_array([0; 3].map(|_| random.unit() * 20.0 - 10.0));
    separate((0..count).flat_map(|_| [Vec3::ZERO, point(), point()]).collect())
}

/// Thin diagonals through the whole scene.
pub fn hair(count: usize) -> Triangles {
    let mut random = Random::new(7);
    let mut shift = || Vec3::from_array([0; 3].map(|_| random.unit() * 0.1));
    separate((0..count).map(|_| shift()).flat_map(|v| [v - 9.0, v + 9.0, v + 9.0 + Vec3::X * 1.0e-3]).collect())
}

/// Each half as large as the one before, towards a corner.
pub fn shrinking(count: usize) -> Triangles {
    let corners = |i: usize| [Vec3::X, Vec3::Y, Vec3::ONE].map(|v| v * 0.5_f32.powi((i % 140) as i32));
    separate((0..count).flat_map(corners).collect())
}

/// A sheet of hills and cliffs: 2 `side`² triangles.
pub fn sheet(side: u32) -> Triangles {
    let row = side + 1;
    let height = |x: u32, z: u32| ((x * 7 + z * 5) % 11 + (x / 9 * 13 + z / 7 * 3) % 17) as f32 / 8.0;
    let vertices = (0..row * row).map(|i| Vec3::new((i % row) as f32, height(i % row, i / row), (i / row) as f32));
    let triangles = (0..side * side).flat_map(|i| {
        let corner = i / side * row + i % side;
        [[corner, corner + 1, corner + row], [corner + 1, corner + row + 1, corner + row]]
    });
    (vertices.collect(), triangles.collect())
}
