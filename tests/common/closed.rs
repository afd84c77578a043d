//! Closed meshes of many shapes, wherever they are and however large, and what is inside of them.

use std::f64::consts::{PI, TAU};

use hitscan::glam::{DMat3, DVec3, Vec3};

use super::Random;

/// A surface without holes: each edge belongs to two triangles, which run along it in opposite directions.
pub struct Closed {
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// A point that was well inside before vertices were rounded.
    pub middle: Vec3,
}

/// Shapes of about size 1 around a point inside of them.
type Shape = (Vec<DVec3>, Vec<[u32; 3]>, DVec3);

/// A grid of quads that is closed around itself: `columns` x `rows` vertices.
fn wrapped(columns: u32, rows: u32) -> Vec<[u32; 3]> {
    let at = |column: u32, row: u32| column % columns + row % rows * columns;
    let quad = |i: u32| {
        let (column, row) = (i % columns, i / columns);
        let [a, b, c, d] = [at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..columns * rows).flat_map(quad).collect()
}

fn torus(random: &mut Random) -> Shape {
    let (columns, rows) = (3 + random.below(9) as u32, 3 + random.below(5) as u32);
    let thick = 0.1 + 0.3 * f64::from(random.unit());
    let vertex = |i: u32| {
        let around = TAU * f64::from(i % columns) / f64::from(columns);
        let about = TAU * f64::from(i / columns) / f64::from(rows);
        let far = 1.0 + thick * about.cos();
        DVec3::new(far * around.cos(), far * around.sin(), thick * about.sin())
    };
    ((0..columns * rows).map(vertex).collect(), wrapped(columns, rows), DVec3::X)
}

/// A bumpy ball, its vertices in rows between two poles.
fn ball(random: &mut Random) -> Shape {
    let (columns, rows) = (3 + random.below(8) as u32, 1 + random.below(7) as u32);
    let bumps = random.pick(&[0.0, 0.0, 0.2, 0.5]);
    let mut far = || 1.0 - bumps * f64::from(random.unit());
    let mut vertices = vec![DVec3::Z * far(), DVec3::NEG_Z * far()];
    for row in 1..=rows {
        let (high, out) = (PI * f64::from(row) / f64::from(rows + 1)).sin_cos();
        for column in 0..columns {
            let (y, x) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
            vertices.push(DVec3::new(x * high, y * high, out) * far());
        }
    }
    let at = |row: u32, column: u32| 2 + row * columns + column % columns;
    let mut triangles = vec![];
    for column in 0..columns {
        triangles.push([0, at(0, column), at(0, column + 1)]);
        triangles.push([1, at(rows - 1, column + 1), at(rows - 1, column)]);
        for row in 1..rows {
            let [a, b, c, d] = [at(row - 1, column), at(row, column), at(row, column + 1), at(row - 1, column + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, triangles, DVec3::ZERO)
}

/// A box, perhaps a flat or a long one.
fn cuboid(random: &mut Random) -> Shape {
    let mut half = || random.pick(&[1.0_f64, 1.0, 0.1, 1.0e-3]);
    let half = DVec3::new(half(), half(), half());
    let vertex = |i: u32| half * DVec3::from_array([0, 1, 2].map(|k| f64::from(i >> k & 1) * 2.0 - 1.0));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(vertex).collect(), triangles, DVec3::ZERO)
}

impl Closed {
    /// A shape, turned, `scale` times as large and at `place`; its vertices are rounded there.
    pub fn new(random: &mut Random, scale: f64, place: Vec3) -> Self {
        let (vertices, triangles, middle) = [torus, ball, ball, cuboid][random.below(4)](random);
        let mut angle = || f64::from(random.unit()) * TAU;
        let turn = DMat3::from_rotation_x(angle()) * DMat3::from_rotation_y(angle()) * DMat3::from_rotation_z(angle());
        let turn = if random.one_in(2) { DMat3::IDENTITY } else { turn };
        let placed = |v: DVec3| (place.as_dvec3() + turn * v * scale).as_vec3();
        let (vertices, middle) = (vertices.into_iter().map(placed).collect(), placed(middle));
        let mut it = Self { vertices, triangles, middle };
        if random.one_in(4) {
            it.separate();
        }
        it
    }

    /// Gives each triangle vertices of its own.
    fn separate(&mut self) {
        let corner = |&vertex: &u32| self.vertices[vertex as usize];
        self.vertices = self.triangles.iter().flatten().map(corner).collect();
        self.triangles = (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    }

    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// Whether the surface, read as real numbers, goes around a point once; `None` if the point is so close to it that
    /// doubles do not tell. Van Oosterom and Strackee, *The solid angle of a plane triangle*, 1983.
    pub fn contains(&self, point: Vec3) -> Option<bool> {
        let mut turns = 0.0;
        for triangle in 0..self.triangles.len() {
            let [a, b, c] = self.corners(triangle).map(|v| v.as_dvec3() - point.as_dvec3());
            let (x, y, z) = (a.length(), b.length(), c.length());
            let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
            let above = a.dot(b.cross(c));
            // In the plane, or as good as in it: there the angle is anyone's guess.
            if above.abs() < 1.0e-9 * x * y * z && below < 1.0e-6 * x * y * z {
                return None;
            }
            turns += 2.0 * above.atan2(below);
        }
        let turns = (turns / (2.0 * TAU)).abs();
        match turns {
            ..1.0e-6 => Some(false),
            0.999_999..1.000_001 => Some(true),
            _ => None,
        }
    }
}
