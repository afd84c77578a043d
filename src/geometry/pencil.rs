use glam::Vec3;

use super::{Bundle, Ray, Triangle};
use crate::math::{greatest, least};

/// Rays from one point through at most 8 x 8 points of a picture with perspective: the middles of a tile's pixels, or some
/// samples of each.
///
/// A [`Camera`](crate::render::Camera) makes them. Together they tell cheaply which of them may hit a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Pencil {
    origin: Vec3,
    screen: Screen,
    /// Where the columns and the rows are, in pixels.
    places: [[f32; Self::SIDE as usize]; 2],
    columns: u32,
    rows: u32,
    /// The direction of the first ray; those of the others lie [within](Self::error) some steps of it.
    corner: Vec3,
    /// What the direction changes by from a column to the next.
    right: Vec3,
    /// And from a row to the next.
    down: Vec3,
    /// More than the magnitudes of all that any coordinate of a direction is summed from.
    size: f32,
}

/// Where the points of a picture are, as seen from an eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    /// The middle.
    pub(crate) forward: Vec3,
    /// From there to the upper edge.
    pub(crate) up: Vec3,
    /// As far to the right.
    pub(crate) right: Vec3,
    /// Half of the picture's width and height, in pixels.
    pub(crate) half: [f32; 2],
}

impl Screen {
    /// From the middle to the point `(x, y)`, in pixels from the upper left corner.
    #[inline]
    pub(crate) fn across(&self, x: f32, y: f32) -> Vec3 {
        let [middle, half] = self.half;
        let (u, v) = ((x - middle) / half, 1.0 - y / half);
        self.right * u + self.up * v
    }

    fn through(&self, [x, y]: [f32; 2]) -> Vec3 {
        self.forward + self.across(x, y)
    }
}

/// Where a sample of a pixel is, in pixels; samples are `step` apart.
#[inline]
pub(crate) fn place(pixel: u32, sample: u32, step: f32) -> f32 {
    pixel as f32 + (sample as f32 + 0.5) * step
}

/// 2^-18, 64 u: what edge functions may be off by, of the sums of magnitudes that they are made of.
///
/// 22 u of it because directions are rounded, 4 u for the normals' sake, and two dozen for products, steps and sums.
const ERROR: f32 = 1.0 / 262_144.0;

/// Beyond this, products of three lengths may leave the range of `f32`.
const LARGE: f32 = 1.0e24;

/// Products of two lengths below this may be small beside what they lose by underflow.
const TINY: f32 = 1.0e-30;

/// What the division by a step, which may itself be less, may lose.
const SMALL: f32 = 16.0 * f32::MIN_POSITIVE;

impl Pencil {
    /// Columns and rows at most.
    pub const SIDE: u32 = 8;

    /// The rays from `origin` through so many pixels from the first on, `samples` x `samples` of each; none if they are too
    /// many, or none.
    pub(crate) fn new(origin: Vec3, screen: Screen, first: [u32; 2], pixels: [u32; 2], samples: u32) -> Option<Self> {
        let [columns, rows] = pixels.map(|pixels| pixels.saturating_mul(samples));
        let sides = 1..=Self::SIDE;
        if !(sides.contains(&columns) && sides.contains(&rows)) {
            return None;
        }
        let [middle, half] = screen.half;
        let largest = |v: Vec3| greatest(greatest(v.x.abs(), v.y.abs()), v.z.abs());
        let [x, y] = first.map(|first| (first.saturating_add(Self::SIDE) as f32) / half);
        let size =
            largest(screen.forward) + largest(screen.right) * (x + middle / half) + largest(screen.up) * (y + 2.0);
        let step = 1.0 / samples as f32;
        let places = first.map(|first| Self::places(first, samples, step));
        let corner = screen.through(places.map(|[first, ..]| first));
        let (right, down) = (screen.right * (step / half), screen.up * -(step / half));
        Some(Self { origin, screen, places, columns, rows, corner, right, down, size })
    }

    /// Where the samples of pixels are along a side of the picture.
    fn places(first: u32, samples: u32, step: f32) -> [f32; Self::SIDE as usize] {
        let (mut pixel, mut sample) = (first, 0);
        [(); Self::SIDE as usize].map(|()| {
            let place = place(pixel, sample, step);
            sample += 1;
            if sample == samples {
                (pixel, sample) = (pixel.saturating_add(1), 0);
            }
            place
        })
    }

    /// How many rays there are in a row.
    #[must_use]
    pub const fn columns(&self) -> u32 {
        self.columns
    }

    /// How many rows of rays there are.
    #[must_use]
    pub const fn rows(&self) -> u32 {
        self.rows
    }

    /// The ray in a column and a row, as the camera makes it.
    #[inline]
    #[must_use]
    pub fn ray(&self, column: u32, row: u32) -> Ray {
        let [x, y] = &self.places;
        let at = |places: &[f32; Self::SIDE as usize], number: u32| places[(number % Self::SIDE) as usize];
        Ray::new(self.origin, self.screen.through([at(x, column), at(y, row)]))
    }

    /// The ray of a bit, eight for a row.
    #[inline]
    pub(crate) fn numbered(&self, bit: u32) -> Ray {
        self.ray(bit % Self::SIDE, bit / Self::SIDE)
    }

    /// Where they begin.
    pub(crate) const fn eye(&self) -> Vec3 {
        self.origin
    }

    /// The directions of four rays half a step around all others.
    pub(crate) fn corners(&self) -> [Vec3; 4] {
        let [right, bottom] = [self.columns, self.rows].map(|count| count as f32 - 0.5);
        let through = |x: f32, y: f32| self.corner + self.right * x + self.down * y;
        [through(-0.5, -0.5), through(right, -0.5), through(-0.5, bottom), through(right, bottom)]
    }

    /// The direction of the first ray, and what it changes by from a column and a row to the next.
    pub(crate) const fn steps(&self) -> [Vec3; 3] {
        [self.corner, self.right, self.down]
    }

    /// More than the magnitudes of all that any coordinate of a direction is summed from.
    pub(crate) const fn size(&self) -> f32 {
        self.size
    }

    /// All of the rays; none if they are to be looked at one by one.
    #[must_use]
    pub fn bundle(&self) -> Option<Bundle> {
        let (last, bottom) = (self.columns - 1, self.rows - 1);
        Bundle::around([(0, 0), (last, 0), (0, bottom), (last, bottom)].map(|(column, row)| self.ray(column, row)))
    }

    /// A bit per ray, eight for a row: those that there are.
    pub(crate) const fn all(&self) -> u64 {
        let row = (1 << self.columns) - 1;
        let rows = u64::MAX >> (64 - Self::SIDE * self.rows);
        (row * 0x0101_0101_0101_0101) & rows
    }

    /// A bit per ray, eight for a row: those that may hit a triangle; the others certainly do not.
    ///
    /// Along a row and from row to row the edge functions, d . (B x C) and so on, change by constant steps. Where they are
    /// proven to have different signs there is no hit (Pineda, *A parallel algorithm for polygon rasterization*, 1988).
    pub(crate) fn candidates(&self, triangle: &Triangle) -> u64 {
        let &Triangle { a, b, c } = triangle;
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let (a, b, c) = (a - self.origin, b - self.origin, c - self.origin);
        let length = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
        let edges = length(ab) + length(ca);
        let area = (length(a) + edges) * edges;
        let error = area * (self.size * ERROR) + SMALL;
        if !(area > TINY && area < LARGE && self.size < LARGE) {
            return self.all();
        }
        let normals = [b.cross(bc), c.cross(ca), a.cross(ab)];
        let edges = Edges {
            at: normals.map(|normal| normal.dot(self.corner)),
            right: normals.map(|normal| normal.dot(self.right)),
            down: normals.map(|normal| normal.dot(self.down)),
            error,
        };
        // Their sum tells from which side the triangle is seen; rays nearly in its plane may be on both.
        let [at, right, down] = [edges.at, edges.right, edges.down].map(|[u, v, w]| u + v + w);
        let (right, down) = (right * LAST, down * LAST);
        let lowest = at + least(right, 0.0) + least(down, 0.0);
        let highest = at + greatest(right, 0.0) + greatest(down, 0.0);
        let mut candidates = 0;
        if !(highest < -4.0 * error) {
            candidates |= edges.inside();
        }
        if !(lowest > 4.0 * error) {
            candidates |= edges.turned().inside();
        }
        candidates & self.all()
    }
}

/// Steps from the first row or column to the last.
const LAST: f32 = (Pencil::SIDE - 1) as f32;

/// Three edge functions over the rays of a pencil.
struct Edges {
    at: [f32; 3],
    right: [f32; 3],
    down: [f32; 3],
    error: f32,
}

impl Edges {
    /// The triangle seen from the other side.
    fn turned(&self) -> Self {
        let [at, right, down] = [self.at, self.right, self.down].map(|edges| edges.map(|edge| -edge));
        Self { at, right, down, ..*self }
    }

    /// A bit per ray: those for which no edge function is proven to be negative. Written so that NaN proves nothing.
    #[inline(never)]
    fn inside(&self) -> u64 {
        let &Self { at: [u, v, w], right: [ux, vx, wx], down: [uy, vy, wy], error } = self;
        let edges = [(u + error, ux, uy), (v + error, vx, vy), (w + error, wx, wy)];
        // The greatest value in the first row, and that in all of them.
        let tops = edges.map(|(at, right, down)| (at + greatest(right * LAST, 0.0), down));
        if tops.iter().any(|&(top, down)| top + greatest(down * LAST, 0.0) < 0.0) {
            return 0;
        }
        let edges = edges.map(|(at, right, down)| (at, down, -1.0 / right));
        let mut rays = 0;
        for row in 0..Pencil::SIDE {
            let y = row as f32;
            if tops.iter().any(|&(top, down)| top + y * down < 0.0) {
                continue;
            }
            // From the last column where a rising one becomes positive to the first where a falling one becomes negative.
            let (mut first, mut last) = (0.0, LAST);
            for (at, down, step) in edges {
                let crossing = (at + y * down) * step;
                if step.is_sign_negative() {
                    first = greatest(crossing, first);
                } else {
                    last = least(crossing, last);
                }
            }
            // Quotients have an error, too.
            let (first, last) = (first + 0.99, last + 0.01);
            if !(last < 0.0) && first as u32 <= last as u32 {
                rays |= u64::from((2_u32 << last as u32) - (1 << first as u32)) << (Pencil::SIDE * row);
            }
        }
        rays
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::cases;

    /// Triangles some pixels large, in front of an eye, turned in all ways.
    #[test]
    fn candidates_are_the_hits_and_hardly_more() {
        let screen = Screen { forward: Vec3::Z, up: Vec3::Y * 0.36, right: Vec3::NEG_X * 0.36, half: [120.0; 2] };
        let pencil = Pencil::new(Vec3::ONE, screen, [96, 136], [8, 7], 1).unwrap();
        let mut state = 1_u32;
        let mut random = |size: f32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) as f32 / 8_388_608.0 - 1.0) * size
        };
        let (mut hits, mut candidates) = (0, 0);
        for _ in 0..cases(20_000) {
            let middle = pencil.ray(4, 4).at(5.0) + Vec3::new(random(0.06), random(0.06), random(1.0));
            let mut corner = || middle + Vec3::new(random(0.08), random(0.08), random(0.08));
            let triangle = Triangle::new(corner(), corner(), corner());
            let rays = pencil.candidates(&triangle);
            assert_eq!(rays & !pencil.all(), 0);
            candidates += rays.count_ones();
            for (column, row) in (0..7).flat_map(|row| (0..8).map(move |column| (column, row))) {
                let ray = pencil.ray(column, row).prepare().unwrap();
                if triangle.intersect(&ray, 0.0, f32::MAX).is_some() {
                    hits += 1;
                    assert_ne!(rays >> (row * Pencil::SIDE + column) & 1, 0, "{triangle:?} {column} {row}");
                }
            }
        }
        assert!(hits > cases(50_000) && candidates < hits + hits / 20, "{hits} {candidates}");
    }

    /// Products of such lengths are rounded to whole denormal numbers.
    #[test]
    fn candidates_are_the_hits_where_products_underflow() {
        let screen = Screen { forward: Vec3::Z, up: Vec3::Y * 1.0e15, right: Vec3::NEG_X * 1.0e15, half: [4.0; 2] };
        let pencil = Pencil::new(Vec3::ZERO, screen, [0, 0], [8, 8], 1).unwrap();
        let mut state = 1_u32;
        let mut random = |steps: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) % steps) as f32 - 0.5 * (steps - 1) as f32
        };
        let mut hits = 0;
        for _ in 0..cases(100_000) {
            let mut corner = || Vec3::new(random(16), random(16), random(16)) * 2.0e-23;
            let triangle = Triangle::new(corner(), corner(), corner());
            let rays = pencil.candidates(&triangle);
            for (column, row) in (0..8).flat_map(|row| (0..8).map(move |column| (column, row))) {
                let ray = pencil.ray(column, row).prepare().unwrap();
                if triangle.intersect(&ray, 0.0, f32::MAX).is_some() {
                    hits += 1;
                    assert_ne!(rays >> (row * Pencil::SIDE + column) & 1, 0, "{triangle:?} {column} {row}");
                }
            }
        }
        assert!(hits > cases(10_000), "{hits}");
    }

    #[test]
    fn pencils_have_some_rays_but_not_too_many() {
        let screen = Screen { forward: Vec3::Z, up: Vec3::Y, right: Vec3::X, half: [8.0; 2] };
        let rays =
            |columns, rows| Pencil::new(Vec3::ZERO, screen, [0, 0], [columns, rows], 1).map(|pencil| pencil.all());
        assert_eq!(rays(8, 8), Some(u64::MAX));
        assert_eq!(rays(3, 2), Some(0x0707));
        assert_eq!(rays(1, 1), Some(1));
        assert!(rays(0, 8).is_none() && rays(8, 0).is_none() && rays(9, 1).is_none() && rays(1, 9).is_none());
    }
}
