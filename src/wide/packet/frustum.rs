use fearless_simd::{Select, Simd, SimdBase, SimdMask, f32x8, f32x16};

use super::rays::{Group, Lanes, ROWS, Rays, Rows, load, of_row};
use crate::{
    geometry::{Wedge, ray::WIDENING, slack},
    wide::{
        node::Node,
        slabs::{Met, row},
    },
};

/// What bounds a group of rays: by axis the interval of their origins and of their reciprocals.
///
/// What is computed of it bounds, bit for bit, what is computed of each ray, because roundings keep order. The rays begin at 0 or
/// later, so that a bound on entries need not be one where it is negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frustum<S: Simd> {
    /// The rows of the planes that are met first; those met then are beside them.
    near: [usize; 3],
    /// The origin farthest along the way, from which planes are entered first.
    ahead: [f32x8<S>; 3],
    /// The origin from which they are left last.
    back: [f32x8<S>; 3],
    /// The reciprocal of least magnitude, for entries and for exits.
    entry: [f32x8<S>; 3],
    slow: [f32x8<S>; 3],
    /// That of the greatest magnitude, for exits.
    fast: [f32x8<S>; 3],
    t_min: f32x8<S>,
}

/// The least and the greatest number of some rays.
#[inline(always)]
fn range<S: Simd>(simd: S, rows: &Rows, lanes: Lanes) -> (f32, f32) {
    let (mut least, mut greatest) = (f32x16::splat(simd, f32::INFINITY), f32x16::splat(simd, f32::NEG_INFINITY));
    for row in 0..ROWS {
        let (of_row, numbers) = (of_row(lanes, row), load(simd, rows, row));
        if of_row != 0 {
            let those = fearless_simd::mask32x16::from_bitmask(simd, of_row.into());
            least = those.select(numbers.min(least), least);
            greatest = those.select(numbers.max(greatest), greatest);
        }
    }
    (least.reduce_min(), greatest.reduce_max())
}

/// The greatest number of some rays.
#[inline(always)]
pub(super) fn greatest<S: Simd>(simd: S, rows: &Rows, lanes: Lanes) -> f32 {
    range(simd, rows, lanes).1
}

/// An axis: the row of the planes met first, then what [`Frustum`] has of it.
#[inline(always)]
fn axis<S: Simd>(simd: S, rays: &Rays, group: &Group, axis: usize) -> (usize, [f32; 5]) {
    let (first, last) = range(simd, &rays.origin[axis], group.lanes);
    let (least, greatest) = range(simd, &rays.entry[axis], group.lanes);
    // Along the way, and by magnitude. Exits are wider by a factor, and rounding keeps order.
    let wider = 1.0 + WIDENING;
    if group.descends[axis] {
        (2 * axis + 1, [first, last, greatest, greatest * wider, least * wider])
    } else {
        (2 * axis, [last, first, least, least * wider, greatest * wider])
    }
}

impl<S: Simd> Frustum<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, rays: &Rays, group: &Group) -> Self {
        let [x, y, z] = [axis(simd, rays, group, 0), axis(simd, rays, group, 1), axis(simd, rays, group, 2)];
        let of = |i: usize| [f32x8::splat(simd, x.1[i]), f32x8::splat(simd, y.1[i]), f32x8::splat(simd, z.1[i])];
        let t_min = f32x8::splat(simd, range(simd, &rays.t_min, group.lanes).0);
        Self { near: [x.0, y.0, z.0], ahead: of(0), back: of(1), entry: of(2), slow: of(3), fast: of(4), t_min }
    }

    /// What bounds the rays before a triangle.
    #[inline(always)]
    pub(super) fn wedge(&self, simd: S, rays: &Rays, group: &Group) -> Wedge<S> {
        let [x, y, z] = group.axes;
        let origin = [self.origins(group, x % 3), self.origins(group, y % 3), self.origins(group, z % 3)];
        let slope = [range(simd, &rays.slope[0], group.lanes), range(simd, &rays.slope[1], group.lanes)];
        let [(x0, x1), (y0, y1)] = slope;
        let slope =
            [[f32x8::splat(simd, x0), f32x8::splat(simd, x1)], [f32x8::splat(simd, y0), f32x8::splat(simd, y1)]];
        Wedge { axes: group.axes, origin, slope }
    }

    /// The least and the greatest origin along an axis.
    #[inline(always)]
    const fn origins(&self, group: &Group, axis: usize) -> [f32x8<S>; 2] {
        let (ahead, back) = (self.ahead[axis], self.back[axis]);
        if group.descends[axis] { [ahead, back] } else { [back, ahead] }
    }

    /// When an axis' planes are passed.
    #[inline(always)]
    fn along(&self, simd: S, node: &Node, axis: usize) -> (f32x8<S>, f32x8<S>) {
        let near = row(simd, &node.rows[self.near[axis] & 7]);
        let far = row(simd, &node.rows[(self.near[axis] ^ 1) & 7]);
        let left = far - self.back[axis];
        let slow = left * self.slow[axis];
        // Behind the last origin the slowest ray leaves last.
        let exit = slow.simd_lt(0.0).select(slow, left * self.fast[axis]);
        ((near - self.ahead[axis]) * self.entry[axis], exit)
    }

    /// Which boxes rays of the group may meet, not behind `limit`, and before where none enters.
    #[inline(always)]
    pub(super) fn meet(&self, simd: S, node: &Node, limit: f32) -> Met<S> {
        let ((x0, x1), (y0, y1), (z0, z1)) =
            (self.along(simd, node, 0), self.along(simd, node, 1), self.along(simd, node, 2));
        // As in `Slabs`.
        let enter = z0.max(y0.max(x0.max(self.t_min)));
        let exit = (z1.min(y1.min(x1.min(f32::INFINITY))) + slack(0.0)).min(limit);
        Met { enter, lanes: !enter.simd_gt(exit).to_bitmask() as u32 & 0xff }
    }
}
