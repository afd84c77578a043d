use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdMask, f32x8, f32x16, mask32x16};

use crate::{
    geometry::{
        MAX_COORDINATE, Ray, ShearLanes, beyond,
        ray::{LONG, SHORT, TINY, WIDENING},
    },
    primitives::Hit,
    wide::batch::Answers,
};

/// Rays of a row.
pub(super) const LANES: usize = 16;

/// Rows of a packet.
pub(super) const ROWS: usize = 4;

/// The most rays of a packet.
pub(super) const RAYS: usize = LANES * ROWS;

/// A number of each ray in a row.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Row<T = f32>(pub [T; LANES]);

/// A number of each ray.
pub(super) type Rows<T = f32> = [Row<T>; ROWS];

/// A bit for each ray.
pub(super) type Lanes = u64;

/// The bits of a row.
#[inline(always)]
pub(super) const fn of_row(lanes: Lanes, row: usize) -> u32 {
    (lanes >> (LANES * (row % ROWS))) as u32 & 0xffff
}

/// A row's numbers.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, rows: &Rows, row: usize) -> f32x16<S> {
    f32x16::load_array_ref(simd, &rows[row % ROWS].0)
}

/// One ray's number in all lanes.
#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, rows: &Rows, lane: usize) -> f32x8<S> {
    f32x8::splat(simd, of_lane(rows, lane))
}

/// One ray's number.
#[inline(always)]
pub(super) const fn of_lane<T: Copy>(rows: &Rows<T>, lane: usize) -> T {
    rows[lane / LANES % ROWS].0[lane % LANES]
}

/// Up to 64 rays as they were given and with what their tests want, number by number; the bits are those of
/// [`PreparedRay`](crate::geometry::PreparedRay).
#[derive(Debug)]
pub(super) struct Rays {
    pub origin: [Rows; 3],
    pub direction: [Rows; 3],
    pub entry: [Rows; 3],
    pub exit: [Rows; 3],
    pub t_min: Rows,
    pub slope: [Rows; 2],
    /// The parameter of the best hit, or where the ray ends.
    pub t: Rows,
    /// The number of what is hit.
    pub primitive: Rows<u32>,
    /// The parameter behind which nothing counts.
    pub limit: Rows,
    /// Bits of the rays that go towards lower coordinates along an axis.
    descending: [Lanes; 3],
    /// Bits of the rays whose direction is largest along an axis.
    major: [Lanes; 3],
}

/// Rays that go the same way along all axes, and are largest along the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// Which they are.
    pub lanes: Lanes,
    /// Whether they go towards lower coordinates.
    pub descends: [bool; 3],
    /// The axes in the order of the shear.
    pub axes: [usize; 3],
}

impl Rays {
    pub(super) const fn new() -> Self {
        const EMPTY: Rows = [Row([0.0; LANES]); ROWS];
        Self {
            origin: [EMPTY; 3],
            direction: [EMPTY; 3],
            entry: [EMPTY; 3],
            exit: [EMPTY; 3],
            t_min: EMPTY,
            slope: [EMPTY; 2],
            t: EMPTY,
            primitive: [Row([u32::MAX; LANES]); ROWS],
            limit: EMPTY,
            descending: [0; 3],
            major: [0; 3],
        }
    }

    /// Takes rays in, and says which of them can go together: those that are valid, begin at 0 or later and whose reciprocals do
    /// not overflow.
    #[inline(always)]
    pub(super) fn fill<S: Simd>(&mut self, simd: S, rays: &[Ray]) -> Lanes {
        let mut plain = 0;
        (self.descending, self.major) = ([0; 3], [0; 3]);
        for (row, rays) in rays.chunks(LANES).enumerate().take(ROWS) {
            let mut seeing = 0;
            for (lane, ray) in rays.iter().enumerate().take(LANES) {
                let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
                for axis in 0..3 {
                    self.origin[axis][row].0[lane] = origin[axis];
                    self.direction[axis][row].0[lane] = direction[axis];
                }
                self.t_min[row].0[lane] = ray.t_min;
                self.t[row].0[lane] = ray.t_max;
                seeing |= u64::from(ray.mask != 0) << lane;
            }
            plain |= (self.prepare(simd, row) & seeing) << (LANES * row);
        }
        plain
    }

    /// Finds out what there is to know of an axis, and how large the directions are along it.
    #[inline(always)]
    fn axis<S: Simd>(&mut self, simd: S, row: usize, axis: usize) -> f32x16<S> {
        let direction = load(simd, &self.direction[axis], row);
        let entry = f32x16::splat(simd, 1.0) / direction;
        entry.store_array(&mut self.entry[axis][row].0);
        (entry * (1.0 + WIDENING)).store_array(&mut self.exit[axis][row].0);
        self.descending[axis] |= (entry.simd_lt(0.0).to_bitmask() & 0xffff) << (LANES * row);
        direction.abs()
    }

    /// Finds out the rest of a row, and which of its rays can go together.
    #[inline(always)]
    fn prepare<S: Simd>(&mut self, simd: S, row: usize) -> Lanes {
        let shift = LANES * row;
        let (x, y, z) = (self.axis(simd, row, 0), self.axis(simd, row, 1), self.axis(simd, row, 2));
        let beats_x = y.simd_gt(x);
        let is_z = z.simd_gt(beats_x.select(y, x)).to_bitmask();
        let beats_x = beats_x.to_bitmask();
        for (bits, is_major) in self.major.iter_mut().zip([!beats_x & !is_z, beats_x & !is_z, is_z]) {
            *bits |= (is_major & 0xffff) << shift;
        }
        let (t_min, t_max) = (load(simd, &self.t_min, row), load(simd, &self.t, row));
        let end = t_max.min(f32::MAX);
        self.set_ends(row, end, mask32x16::splat(simd, false));
        self.primitive[row].0 = [u32::MAX; LANES];
        let mut plain = t_min.simd_ge(0.0) & t_min.simd_le(t_max) & t_min.simd_le(f32::MAX);
        for axis in 0..3 {
            plain &= load(simd, &self.origin[axis], row).abs().simd_le(MAX_COORDINATE);
        }
        for size in [x, y, z] {
            plain &= size.simd_le(LONG) & (size.simd_ge(f32::MIN_POSITIVE) | size.simd_eq(0.0));
        }
        let large = x.simd_ge(SHORT) | y.simd_ge(SHORT) | z.simd_ge(SHORT);
        (plain & large).to_bitmask() & 0xffff
    }

    /// Looks no farther than this, and no further at all for rays that are `done`.
    #[inline(always)]
    pub(super) fn set_ends<S: Simd>(&mut self, row: usize, t: f32x16<S>, done: mask32x16<S>) {
        t.store_array(&mut self.t[row % ROWS].0);
        // As `beyond`.
        let limit = t + t.abs() * (4.0 * WIDENING) + 4.0 * TINY;
        let limit = done.select(-f32x16::splat(t.token(), f32::INFINITY), limit);
        limit.store_array(&mut self.limit[row % ROWS].0);
    }

    /// All of these rays that go the way of the first of them, prepared for triangles.
    #[inline(always)]
    pub(super) fn group<S: Simd>(&mut self, simd: S, lanes: Lanes) -> Group {
        let first = lanes & lanes.wrapping_neg();
        let mut group = Group { lanes, descends: [false; 3], axes: [0; 3] };
        for axis in 0..3 {
            group.descends[axis] = self.descending[axis] & first != 0;
            group.lanes &= if group.descends[axis] { self.descending[axis] } else { !self.descending[axis] };
            if self.major[axis] & first != 0 {
                group.lanes &= self.major[axis];
                group.axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
            }
        }
        let [x, y, z] = group.axes;
        for row in 0..ROWS {
            let inverse = load(simd, &self.entry[z], row);
            (load(simd, &self.direction[x], row) * inverse).store_array(&mut self.slope[0][row].0);
            (load(simd, &self.direction[y], row) * inverse).store_array(&mut self.slope[1][row].0);
        }
        group
    }

    /// A row of the group, to test it with a triangle.
    #[inline(always)]
    pub(super) fn shear<S: Simd>(&self, simd: S, group: &Group, row: usize) -> ShearLanes<S, f32x16<S>> {
        let [x, y, z] = group.axes;
        let origin = [&self.origin[x % 3], &self.origin[y % 3], &self.origin[z % 3]];
        let origin = [load(simd, origin[0], row), load(simd, origin[1], row), load(simd, origin[2], row)];
        let slope = [load(simd, &self.slope[0], row), load(simd, &self.slope[1], row)];
        let inverse = (load(simd, &self.entry[z % 3], row), group.descends[z % 3]);
        ShearLanes::of(group.axes, origin, slope, inverse)
    }

    /// A ray of the group, to test it with eight triangles.
    #[inline(always)]
    pub(super) fn shear_one<S: Simd>(&self, simd: S, group: &Group, lane: usize) -> ShearLanes<S> {
        let [x, y, z] = group.axes;
        let origin = [&self.origin[x % 3], &self.origin[y % 3], &self.origin[z % 3]];
        let origin = [splat(simd, origin[0], lane), splat(simd, origin[1], lane), splat(simd, origin[2], lane)];
        let slope = [splat(simd, &self.slope[0], lane), splat(simd, &self.slope[1], lane)];
        let inverse = (splat(simd, &self.entry[z % 3], lane), group.descends[z % 3]);
        ShearLanes::of(group.axes, origin, slope, inverse)
    }

    /// A ray's best hit, or its end.
    #[inline(always)]
    pub(super) const fn best(&self, lane: usize) -> Hit {
        Hit { t: of_lane(&self.t, lane), primitive: of_lane(&self.primitive, lane) }
    }

    /// Changes it.
    #[inline(always)]
    pub(super) fn set_best<A: Answers>(&mut self, lane: usize, hit: Hit) {
        let (row, lane) = (lane / LANES % ROWS, lane % LANES);
        (self.t[row].0[lane], self.primitive[row].0[lane]) = (hit.t, hit.primitive);
        let is_done = A::ANY && hit.primitive != u32::MAX;
        self.limit[row].0[lane] = if is_done { f32::NEG_INFINITY } else { beyond(hit.t) };
    }
}
