//! The torus knot of the device comparison: a tube around a curve that winds about a torus.

use std::f64::consts::TAU;

use hitscan::glam::Vec3;

type Vector = [f64; 3];

/// The radius of the tube.
const TUBE: f64 = 0.25;

/// The curve that winds twice around the axis and three times around the ring, for `t` from 0 to 1.
fn curve(t: f64) -> Vector {
    let a = TAU * t;
    let radius = 1.0 + 0.45 * (3.0 * a).cos();
    [radius * (2.0 * a).cos(), radius * (2.0 * a).sin(), 0.45 * (3.0 * a).sin()]
}

fn cross(u: Vector, v: Vector) -> Vector {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn unit(v: Vector) -> Vector {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// Vertices and triangles of a tube of `along` rings with `around` corners each.
pub fn mesh(along: u16, around: u16) -> (Vec<Vec3>, Vec<[u16; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..along {
        let t = f64::from(i) / f64::from(along);
        let (center, next) = (curve(t), curve(t + 1.0e-4));
        let tangent = unit([0, 1, 2].map(|k| next[k] - center[k]));
        let sideways = unit(cross(tangent, [center[0], center[1], 0.0]));
        let outward = cross(sideways, tangent);
        for j in 0..around {
            let (sin, cos) = (TAU * f64::from(j) / f64::from(around)).sin_cos();
            let vertex = [0, 1, 2].map(|k| center[k] + TUBE * (cos * outward[k] + sin * sideways[k]));
            vertices.push(Vec3::from_array(vertex.map(|x| x as f32)));
            let corner = |i, j| (i % along) * around + j % around;
            let (a, b, c, d) = (corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1));
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    (vertices, triangles)
}
