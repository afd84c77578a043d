use fearless_simd::{Simd, SimdBase, SimdMask, f32x8};

use super::node::{Node, WIDTH};
use crate::geometry::{PreparedRay, beyond, slack};

/// A ray as the test of eight boxes wants it (rules R1, R2 and R4 of ARCHITECTURE.md).
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs<S: Simd> {
    /// The rows of the planes that the ray meets first; those it meets then are beside them.
    near: [usize; 3],
    origin: [f32x8<S>; 3],
    entry: [f32x8<S>; 3],
    exit: [f32x8<S>; 3],
    t_min: f32x8<S>,
    slack: f32x8<S>,
}

/// Eight boxes and a ray.
#[derive(Clone, Copy)]
pub(super) struct Met<S: Simd> {
    /// Where the ray enters.
    pub enter: f32x8<S>,
    /// A bit for each box that is not missed.
    pub lanes: u32,
}

/// A row of a node or a block.
#[inline(always)]
pub(super) fn row<S: Simd>(simd: S, words: &[u32; WIDTH]) -> f32x8<S> {
    f32x8::load_array_ref(simd, bytemuck::must_cast_ref(words))
}

/// What [`Slabs`] need besides the ray: found out once for each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    near: [usize; 3],
    /// A bit for each axis along which the ray meets higher coordinates first.
    pub octant: usize,
    slack: f32,
}

impl Sides {
    #[inline(always)]
    pub(super) fn of(ray: &PreparedRay) -> Self {
        let [x, y, z, _] = &ray.views;
        let (x, y, z) = (usize::from(!x.ascends()), usize::from(!y.ascends()), usize::from(!z.ascends()));
        Self { near: [x, 2 + y, 4 + z], octant: x | y << 1 | z << 2, slack: slack(ray.ray().t_min) }
    }
}

impl<S: Simd> Slabs<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, ray: &PreparedRay, sides: Sides) -> Self {
        let [x, y, z, _] = &ray.views;
        Self {
            near: sides.near,
            origin: splat(simd, [x.origin, y.origin, z.origin]),
            entry: splat(simd, [x.entry, y.entry, z.entry]),
            exit: splat(simd, [x.exit, y.exit, z.exit]),
            t_min: f32x8::splat(simd, ray.ray().t_min),
            slack: f32x8::splat(simd, sides.slack),
        }
    }

    /// A ray from `t_min`, 0 or later, by its axes: whether it goes towards lower coordinates; origin, entry and exit.
    #[inline(always)]
    pub(super) fn of(simd: S, [dx, dy, dz]: [bool; 3], [x, y, z]: [[f32; 3]; 3], t_min: f32) -> Self {
        Self {
            near: [usize::from(dx), 2 + usize::from(dy), 4 + usize::from(dz)],
            origin: splat(simd, [x[0], y[0], z[0]]),
            entry: splat(simd, [x[1], y[1], z[1]]),
            exit: splat(simd, [x[2], y[2], z[2]]),
            t_min: f32x8::splat(simd, t_min),
            slack: f32x8::splat(simd, slack(0.0)),
        }
    }

    /// Where the ray enters and leaves along an axis.
    #[inline(always)]
    fn along(&self, simd: S, node: &Node, axis: usize) -> (f32x8<S>, f32x8<S>) {
        let near = row(simd, &node.rows[self.near[axis] & 7]);
        let far = row(simd, &node.rows[(self.near[axis] ^ 1) & 7]);
        let origin = self.origin[axis];
        ((near - origin) * self.entry[axis], (far - origin) * self.exit[axis])
    }

    /// Which boxes the ray meets, not behind `limit`.
    #[inline(always)]
    pub(super) fn meet(&self, simd: S, node: &Node, limit: f32x8<S>) -> Met<S> {
        let ((x0, x1), (y0, y1), (z0, z1)) =
            (self.along(simd, node, 0), self.along(simd, node, 1), self.along(simd, node, 2));
        // Where lanes are NaN, the second operand stays on x86; elsewhere the box is entered, which is as right. Pairs, because
        // nodes wait for each other, and no operation more than needed may stand between them.
        let enter = z0.max(y0).max(x0.max(self.t_min));
        let exit = z1.min(y1).min(x1.min(limit)) + self.slack;
        Met { enter, lanes: !enter.simd_gt(exit).to_bitmask() as u32 & 0xff }
    }
}

/// Each number in all lanes.
// Written out: what arrays' `map` makes is not inlined into kernels, and has not their instructions.
#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x8<S>; 3] {
    [f32x8::splat(simd, x), f32x8::splat(simd, y), f32x8::splat(simd, z)]
}

/// The parameter behind which nothing counts, in all lanes.
#[inline(always)]
pub(super) fn limit<S: Simd>(simd: S, t: f32) -> f32x8<S> {
    f32x8::splat(simd, beyond(t))
}
