use glam::Vec3;

use super::{
    LatticeSpace,
    ray::{LAST, MIDDLE},
    space::Planes,
};
use crate::{
    geometry::{Axis, Pencil},
    math::greatest,
};

/// From the lattice to the pixels of a tile, with perspective: it tells which rays may hit a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    /// The eye, in 2^-`shift` planes.
    eye: [i32; 3],
    shift: [u8; 3],
    /// What a point's way from the eye is multiplied with: to its distance, and its column and row times that.
    rows: [[i32; 3]; 3],
    /// What columns and rows may be off by at any distance, in 2^-6.
    fuzz: i32,
    /// What they may be off by at a distance of 1, and that for each 2^-6 that they are away.
    blur: [i32; 2],
}

/// The steps by which what is hit may be off a ray's line, with something to spare: 1.4 for the roundings of ray and corners,
/// 1 for that of the eye, 0.5 for those of planes.
const OFF: f32 = 4.0;

/// Bits behind the point of columns and rows.
const FRACTION: u32 = 6;

/// The least distance of a corner from the eye.
const NEAR: i32 = 1 << 10;

/// How many bits columns and rows may have, so that the products of their differences fit 32.
const BITS: u32 = 13;

/// All rays.
const ALL: u64 = u64::MAX;

/// The last column, and row.
const LAST_PIXEL: i32 = Pencil::SIDE as i32 - 1;

impl LatticeSpace {
    /// Where what is seen from the eye is in a tile; `None` if it is not a camera's, or too far off.
    #[inline(never)]
    pub(super) fn projection(&self, pencil: &Pencil, start: &Planes) -> Option<Projection> {
        let [corner, right, down] = pencil.steps();
        let size = pencil.size();
        let across = right.cross(down);
        let area = across.dot(corner);
        let (width, height) = (right.length_squared(), down.length_squared());
        let coarse = size * (1.0 + size);
        let least = if width < height { width } else { height };
        // The axes are at right angles and one way forward is 1, and a pixel is larger than what rays are rounded by.
        if !(area * area > 0.5 * width * height && least > coarse * coarse * (1.0 / 4_294_967_296.0)) {
            return None;
        }
        let scale = 1.0 / area;
        let rows = [across, down.cross(corner), corner.cross(right)].map(|row| self.in_steps(row * scale));
        let mut eye = [0; 3];
        let mut shift = [0; 3];
        let mut reach = [0.0; 3];
        for (((eye, shift), reach), axis) in eye.iter_mut().zip(&mut shift).zip(&mut reach).zip(Axis::ALL) {
            let whole = start.whole(axis, 0).saturating_add(MIDDLE);
            let most = whole.unsigned_abs().max(LAST.abs_diff(whole)).saturating_add(1);
            *shift = most.leading_zeros().checked_sub(1).filter(|&shift| shift >= 8)?;
            *eye = start.whole(axis, *shift).wrapping_add(MIDDLE << *shift);
            *reach = most as f32;
        }
        let reach = Vec3::from_array(reach);
        let bound = rows.map(|row| row.abs().dot(reach));
        let [distance, column, row] = bound;
        let scale = 536_870_000.0 / greatest(distance, greatest(column, row));
        if !(scale > f32::MIN_POSITIVE && scale < f32::MAX) {
            return None;
        }
        let [by, column, row] = rows.map(|row| row.abs().dot(Vec3::splat(OFF)) * scale + 4.0);
        let blur = [greatest(column, row) as i32, (by * (1.0 / 64.0)) as i32 + 2];
        // 2^32 because only the upper half of products is kept.
        let unit = shift.map(|shift| scale * (1_u64 << (32 - shift)) as f32);
        let rows = rows.map(|row| (row * Vec3::from_array(unit)).to_array().map(|x| x as i32));
        let fuzz = (coarse / crate::math::sqrt(least) * (1.0 / 2048.0)) as i32 + 3;
        let shift = shift.map(|shift| shift as u8);
        Some(Projection { eye, shift, rows, fuzz, blur })
    }
}

impl Projection {
    /// A bit per ray, eight for a row: those that may hit a triangle; the others certainly do not.
    ///
    /// Those within its projection, widened by what that may be off (Akenine-Möller and Aila, *Conservative and tiled
    /// rasterization using a modified triangle setup*, 2005).
    #[inline(never)]
    pub(crate) fn candidates(&self, corners: [&[u16; 3]; 3]) -> u64 {
        let [ex, ey, ez] = self.eye;
        let [sx, sy, sz] = self.shift;
        let (mut x, mut y) = ([0; 3], [0; 3]);
        let (mut near, mut far) = (i32::MAX, 0);
        for ((&[cx, cy, cz], x), y) in corners.into_iter().zip(&mut x).zip(&mut y) {
            let (dx, dy, dz) = ((i32::from(cx) << sx) - ex, (i32::from(cy) << sy) - ey, (i32::from(cz) << sz) - ez);
            let along = |&[a, b, c]: &[i32; 3]| {
                let product = |a: i32, b: i32| i64::from(a) * i64::from(b);
                ((product(a, dx) + product(b, dy) + product(c, dz)) >> 32) as i32
            };
            let [distance, column, row] = &self.rows;
            let distance = along(distance) >> FRACTION;
            if distance < NEAR {
                return ALL;
            }
            (*x, *y) = (along(column) / distance, along(row) / distance);
            near = near.min(distance);
            far = far.max(x.abs()).max(y.abs());
        }
        let [blur, by] = self.blur;
        let error = self.fuzz + (far >> 10) + (far * by + blur) / near.max(NEAR);
        let coarse = (32 - BITS).saturating_sub(far.leading_zeros());
        if coarse > FRACTION || error >> BITS != 0 {
            return ALL;
        }
        let error = (error >> coarse) + 2 * i32::from(coarse != 0);
        let unit = FRACTION - coarse;
        let ([ax, bx, cx], [ay, by, cy]) = (x.map(|x| x >> coarse), y.map(|y| y >> coarse));
        let within = |a: i32, b: i32, c: i32| {
            let first = (a.min(b).min(c) - error + (1 << unit) - 1) >> unit;
            (first.max(0), ((a.max(b).max(c) + error) >> unit).min(LAST_PIXEL))
        };
        let (left, end) = within(ax, bx, cx);
        let (top, bottom) = within(ay, by, cy);
        if left > end || top > bottom {
            return 0;
        }
        let turned = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax);
        // How far inside of an edge the first of these pixels is, and what that changes by to the right and down.
        let edge = |x: i32, y: i32, dx: i32, dy: i32| {
            let (dx, dy) = if turned { (-dx, -dy) } else { (dx, dy) };
            let inside = dx * ((top << unit) - y) - dy * ((left << unit) - x);
            (inside + error * (dx.abs() + dy.abs()), -dy << unit, dx << unit)
        };
        let (mut u, ux, uy) = edge(ax, ay, bx - ax, by - ay);
        let (mut v, vx, vy) = edge(bx, by, cx - bx, cy - by);
        let (mut w, wx, wy) = edge(cx, cy, ax - cx, ay - cy);
        let mut rays = 0;
        for row in top..=bottom {
            let (mut a, mut b, mut c) = (u, v, w);
            let mut inside = 0_u32;
            for column in left..=end {
                inside |= u32::from((a | b | c) >= 0) << (column & 7);
                (a, b, c) = (a + ux, b + vx, c + wx);
            }
            rays |= u64::from(inside) << (8 * (row & 7));
            (u, v, w) = (u + uy, v + vy, w + wy);
        }
        rays
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geometry::{Aabb, Screen},
        testing::cases,
    };

    /// Triangles some pixels large, in front of an eye, turned in all ways.
    #[test]
    fn candidates_are_the_hits_and_hardly_more() {
        let space = LatticeSpace::over(&Aabb::new(Vec3::ZERO, Vec3::new(1.0, 0.5, 2.0))).unwrap();
        let screen = Screen { forward: Vec3::Z, up: Vec3::Y * 0.36, right: Vec3::NEG_X * 0.36, half: [120.0; 2] };
        let pencil = Pencil::new(Vec3::new(0.4, 0.3, -3.0), screen, [96, 136], [8, 7], 1).unwrap();
        let rays = space.pencil(&pencil).unwrap();
        let mut state = 1_u32;
        let mut random = |size: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as i32 % (2 * size) - size
        };
        let (mut hits, mut candidates) = (0, 0);
        for _ in 0..cases(20_000) {
            let z = 32_768 + random(20_000);
            let middle = pencil.ray(4, 4).at(3.0 + z as f32 / 32_767.5);
            let (x, y) = ((middle.x * 65_535.0) as i32 + random(500), (middle.y * 131_070.0) as i32 + random(1000));
            let mut corner = || [x + random(5000), y + random(10_000), z + random(5000)].map(|number| number as u16);
            let corners = [corner(), corner(), corner()];
            let corners = corners.each_ref();
            let found = rays.projection.candidates(corners) & pencil.all();
            candidates += found.count_ones();
            for bit in (0..64).filter(|bit| pencil.all() >> bit & 1 != 0) {
                let sight = space.sight(&rays, &pencil, bit);
                if sight.is_some_and(|sight| sight.crossing(corners).is_some()) {
                    hits += 1;
                    assert_ne!(found >> bit & 1, 0, "{corners:?} {bit}");
                }
            }
        }
        assert!(hits > cases(50_000) && (cfg!(miri) || candidates < hits + hits / 8), "{hits} {candidates}");
    }
}
