//! Meshes that need no file.

use std::f32::consts::TAU;

use hitscan::glam::Vec3;

use crate::{mesh::Mesh, random::Random};

/// Hills over a square: `count` triangles of nearly one size.
pub fn terrain(count: usize) -> Mesh {
    let side = (count as f32 / 2.0).sqrt().ceil() as u32;
    let height = |x: f32, z: f32| {
        let octave = |k: f32, a: f32| a * ((x * k + a).sin() * (z * k * 1.3 - a).cos() + ((x - z) * k * 0.7).sin());
        octave(7.0, 0.06) + octave(19.0, 0.02) + octave(53.0, 0.006) + octave(151.0, 0.002)
    };
    let place = |i: u32| i as f32 / side as f32;
    let vertices = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| (place(i), place(j))))
        .map(|(x, z)| Vec3::new(x, height(x, z), z))
        .collect();
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| j * (side + 1) + i));
    let corners = cells.flat_map(|a| quad(a, a + 1, a + side + 1, a + side + 2)).take(count).collect();
    Mesh::new(format!("terrain:{count}"), vertices, corners)
}

/// `count` triangles at random in a cube, as large as their distance from each other.
pub fn soup(count: usize) -> Mesh {
    let mut random = Random::new(1);
    let size = (count as f32).cbrt().recip();
    let mut point = || Vec3::new(random.signed(), random.signed(), random.signed());
    let mut vertices = Vec::with_capacity(count * 3);
    for _ in 0..count {
        let center = point();
        vertices.extend([0; 3].map(|_| center + point() * size));
    }
    let corners = (0..count as u32).map(|i| [i * 3, i * 3 + 1, i * 3 + 2]).collect();
    Mesh::new(format!("soup:{count}"), vertices, corners)
}

/// A tube along a (2, 3) torus knot, of about `count` triangles.
pub fn knot(count: usize) -> Mesh {
    // Rings of as many corners as make the triangles about as wide as long.
    let around = ((count as f32 / 50.0).sqrt().round() as u32).max(3);
    let along = (count as u32 / around / 2).max(3);
    let curve = |t: f32| {
        let (a, b) = (TAU * 2.0 * t, TAU * 3.0 * t);
        let radius = 1.0 + 0.45 * b.cos();
        Vec3::new(radius * a.cos(), radius * a.sin(), 0.45 * b.sin())
    };
    let mut vertices = Vec::new();
    for i in 0..along {
        let t = i as f32 / along as f32;
        let center = curve(t);
        let ahead = (curve(t + 1.0e-3) - center).normalize();
        let across = ahead.cross(center.with_z(0.0)).normalize();
        let up = across.cross(ahead);
        vertices.extend((0..around).map(|j| {
            let (sin, cos) = (TAU * j as f32 / around as f32).sin_cos();
            center + (up * cos + across * sin) * 0.25
        }));
    }
    let number = |i: u32, j: u32| i % along * around + j % around;
    let corners = (0..along)
        .flat_map(|i| (0..around).map(move |j| (i, j)))
        .flat_map(|(i, j)| quad(number(i, j), number(i, j + 1), number(i + 1, j), number(i + 1, j + 1)))
        .collect();
    Mesh::new(format!("knot:{count}"), vertices, corners)
}

fn quad(a: u32, b: u32, c: u32, d: u32) -> [[u32; 3]; 2] {
    [[a, c, b], [b, c, d]]
}
