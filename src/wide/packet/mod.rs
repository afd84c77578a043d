//! Rays that go nearly the same way, through the tree together.
//!
//! Of a node's children, those are looked at that the rays' common bounds meet (Reshetov, Soupikov and Hurley, *Multi-level ray
//! tracing algorithm*, 2005; Boulos et al., *Interactive distribution ray tracing*, 2006), the nearest first, and of these the
//! rays that meet them. Where few rays are left, they go on one by one (Benthin et al., *Combining single and packet ray
//! tracing for arbitrary ray distributions on the Intel MIC architecture*, 2012).

mod frustum;
mod rays;

use fearless_simd::{Select, Simd, SimdBase, SimdMask, f32x16, mask32x16, u32x16};

use self::{
    frustum::{Frustum, greatest},
    rays::{Group, LANES, Lanes, RAYS, ROWS, Rays, load, of_lane, of_row},
};
use super::{
    batch::Answers,
    block::Block,
    node::{CHILDREN, Child, Node, WIDTH},
    slabs::Slabs,
    stack::ROOM,
    tree::Tree,
    walk::{self, Query},
};
use crate::{
    geometry::{Ray, ShearLanes, Wedge, parameters, slack},
    primitives::{Hit, Sides, Span},
};

/// So few rays for each row that they are in go on one by one from a node.
const FEW: u32 = 4;

/// And so small a share of their group: one ray in so many.
const SHARE: u32 = 3;

/// So few rays of a row are tested one by one with a block of triangles.
const FEW_OF_ROW: u32 = 3;

/// A child that waits: some rays may enter it.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    lanes: Lanes,
    /// None does before this.
    enter: f32,
    node: u32,
    place: u32,
}

/// What is kept from packet to packet.
pub(super) struct Packet<'p, S: Simd> {
    simd: S,
    tree: &'p Tree,
    given: &'p [Ray],
    rays: Rays,
    stack: heapless::Vec<Waiting, ROOM>,
}

/// In how many rows there are rays.
#[inline(always)]
fn rows_of(lanes: Lanes) -> u32 {
    (0..ROWS).map(|row| u32::from(of_row(lanes, row) != 0)).sum()
}

/// A point as each ray of a row sees it.
#[inline(always)]
fn seen<S: Simd>(simd: S, shear: &ShearLanes<S, f32x16<S>>, point: [f32; 3]) -> [f32x16<S>; 3] {
    let along = |axis: usize| f32x16::splat(simd, point[axis % 3]);
    let [x, y, z] = shear.axes;
    shear.shear([along(x), along(y), along(z)])
}

/// The lowest lane.
#[inline(always)]
const fn lowest(lanes: Lanes) -> usize {
    lanes.trailing_zeros() as usize % RAYS
}

impl<S: Simd> Packet<'_, S> {
    /// Whether vectors are long enough.
    pub(super) const PAYS: bool = <S::f32s as SimdBase<S>>::LEN >= WIDTH;

    /// When a row of rays passes two planes of an axis.
    #[inline(always)]
    fn along(&self, row: usize, axis: usize, near: f32, far: f32) -> (f32x16<S>, f32x16<S>) {
        let (simd, rays) = (self.simd, &self.rays);
        let origin = load(simd, &rays.origin[axis], row);
        let enter = (f32x16::splat(simd, near) - origin) * load(simd, &rays.entry[axis], row);
        (enter, (f32x16::splat(simd, far) - origin) * load(simd, &rays.exit[axis], row))
    }

    /// Which of these rays meet the box in this place of a node.
    #[inline(always)]
    fn meet(&self, node: &Node, place: usize, group: &Group, lanes: Lanes) -> Lanes {
        let (simd, rays) = (self.simd, &self.rays);
        let plane = |axis: usize, far: bool| {
            f32::from_bits(node.rows[2 * axis + usize::from(group.descends[axis] != far)][place % WIDTH])
        };
        let near = [plane(0, false), plane(1, false), plane(2, false)];
        let far = [plane(0, true), plane(1, true), plane(2, true)];
        let mut met = 0;
        for row in 0..ROWS {
            if of_row(lanes, row) == 0 {
                continue;
            }
            let (x0, x1) = self.along(row, 0, near[0], far[0]);
            let (y0, y1) = self.along(row, 1, near[1], far[1]);
            let (z0, z1) = self.along(row, 2, near[2], far[2]);
            // As in `Slabs`.
            let enter = z0.max(y0.max(x0.max(load(simd, &rays.t_min, row))));
            let exit = (z1.min(y1.min(x1.min(f32::INFINITY))) + slack(0.0)).min(load(simd, &rays.limit, row));
            met |= (!enter.simd_gt(exit).to_bitmask() & 0xffff) << (LANES * row);
        }
        met & lanes
    }

    /// Tests rays of a row with the triangles of a block.
    #[inline(always)]
    fn test_row<A: Answers>(
        &mut self,
        block: Block<'_>,
        group: &Group,
        (row, lanes): (usize, u32),
        mut triangles: u32,
    ) {
        let (simd, tree) = (self.simd, self.tree);
        let shear = self.rays.shear(simd, group, row);
        let mut t = load(simd, &self.rays.t, row);
        let mut primitive = u32x16::load_array_ref(simd, &self.rays.primitive[row % ROWS].0);
        let t_min = load(simd, &self.rays.t_min, row);
        let of = &self.rays.origin;
        let origin = [load(simd, &of[0], row), load(simd, &of[1], row), load(simd, &of[2], row)];
        let of = &self.rays.direction;
        let direction = [load(simd, &of[0], row), load(simd, &of[1], row), load(simd, &of[2], row)];
        while triangles != 0 {
            let triangle = triangles.trailing_zeros() as usize % WIDTH;
            triangles &= triangles - 1;
            let [a, b, c] = [block.corner(triangle, 0), block.corner(triangle, 1), block.corner(triangle, 2)];
            let sheared = [seen(simd, &shear, a), seen(simd, &shear, b), seen(simd, &shear, c)];
            let possible = shear.test(sheared);
            let lanes = possible.lanes & lanes;
            if lanes == 0 {
                continue;
            }
            let crossings = shear.place(simd, &possible, lanes, (t_min, t), A::ANY);
            let (mut found, mut proven, mut open) = (crossings.t, crossings.proven, crossings.open);
            if A::ANY {
                proven |= crossings.certain;
                open &= !crossings.certain;
            }
            let decided = open & crossings.decided;
            if decided != 0 {
                let (exact, certain) = simd.vectorize(
                    #[inline(always)]
                    || parameters(simd, &block.triangle(triangle), origin, direction),
                );
                let certain = certain & decided;
                found = mask32x16::from_bitmask(simd, certain.into()).select(exact, found);
                proven |= certain & found.simd_ge(t_min).to_bitmask() as u32;
                open &= !certain;
            }
            if tree.sides == Sides::Front {
                proven &= crossings.front();
            }
            let number = block.number(triangle);
            if !tree.masks.is_empty() {
                for lane in 0..LANES {
                    let seen = self.given.get(LANES * row + lane).is_some_and(|ray| tree.is_seen(number, ray.mask));
                    proven &= !(u32::from(!seen) << lane);
                }
            }
            if proven != 0 {
                let lower = u32x16::splat(simd, number).simd_lt(primitive);
                let precedes = found.simd_lt(t) | (found.simd_eq(t) & lower);
                let better = precedes & mask32x16::from_bitmask(simd, proven.into());
                t = better.select(found, t);
                primitive = better.select(u32x16::splat(simd, number), primitive);
            }
            while open != 0 {
                let lane = open.trailing_zeros() as usize % LANES;
                open &= open - 1;
                let Some(ray) = self.given.get(LANES * row + lane) else { break };
                let best = Hit { t: t.as_array()[lane], primitive: primitive.as_array()[lane] };
                let span = Span::new(Hit { t: ray.t_min, primitive: 0 }, best);
                let front = crossings.is_front(lane);
                if let Some(hit) = tree.certify(simd, (block, triangle), front, ray, &span) {
                    (t.as_mut_array()[lane], primitive.as_mut_array()[lane]) = (hit.t, hit.primitive);
                }
            }
        }
        let behind = if A::ANY { primitive.simd_ne(u32::MAX) } else { mask32x16::splat(simd, false) };
        self.rays.set_ends(row, t, behind);
        primitive.store_array(&mut self.rays.primitive[row % ROWS].0);
    }

    /// One ray by itself, as the walks want it.
    #[inline(always)]
    fn query<'q>(&'q self, group: &Group, lane: usize) -> Option<Query<'q, S, Ray>> {
        let shear = self.rays.shear_one(self.simd, group, lane);
        Some(Query { simd: self.simd, tree: self.tree, asker: self.given.get(lane)?, shear })
    }

    /// Tests rays with a block of triangles.
    #[inline(always)]
    fn test<A: Answers>(&mut self, child: Child, group: &Group, wedge: &Wedge<S>, lanes: Lanes) {
        let simd = self.simd;
        let Some(block) = self.tree.block(child) else { return };
        let triangles = block.may_hit(simd, wedge);
        if triangles == 0 {
            return;
        }
        for row in 0..ROWS {
            let of_row = of_row(lanes, row);
            if of_row.count_ones() > FEW_OF_ROW {
                simd.vectorize(
                    #[inline(always)]
                    || self.test_row::<A>(block, group, (row, of_row), triangles),
                );
                continue;
            }
            let mut left = of_row;
            while left != 0 {
                let lane = LANES * row + left.trailing_zeros() as usize % LANES;
                left &= left - 1;
                let mut best = self.rays.best(lane);
                let Some(query) = self.query(group, lane) else { break };
                if !A::ANY {
                    query.improve(block, &mut best);
                } else if query.is_hit(block, best) {
                    best.primitive = 0;
                }
                self.rays.set_best::<A>(lane, best);
            }
        }
    }

    /// Lets rays go on one by one.
    #[inline(always)]
    fn part<A: Answers>(&mut self, child: Child, group: &Group, mut lanes: Lanes) {
        while lanes != 0 {
            let lane = lowest(lanes);
            lanes &= lanes - 1;
            let best = self.rays.best(lane);
            let Some(query) = self.query(group, lane) else { break };
            let axes = [0, 1, 2].map(|axis| {
                [&self.rays.origin, &self.rays.entry, &self.rays.exit].map(|rows| of_lane(&rows[axis], lane))
            });
            let slabs = Slabs::of(self.simd, group.descends, axes, of_lane(&self.rays.t_min, lane));
            let hit = if !A::ANY {
                walk::closest_below(&query, &slabs, child, best)
            } else if walk::any_below(&query, &slabs, child, best) {
                Hit { primitive: 0, ..best }
            } else {
                continue;
            };
            self.rays.set_best::<A>(lane, hit);
        }
    }

    /// Takes a group through the tree.
    #[inline(always)]
    fn walk<A: Answers>(&mut self, root: Child, group: &Group) {
        let (simd, tree) = (self.simd, self.tree);
        let (frustum, wedge) = simd.vectorize(
            #[inline(always)]
            || {
                let frustum = Frustum::new(simd, &self.rays, group);
                (frustum, frustum.wedge(simd, &self.rays, group))
            },
        );
        let mut limit = greatest(simd, &self.rays.limit, group.lanes);
        let (mut child, mut lanes) = (root, group.lanes);
        let few = group.lanes.count_ones() / SHARE;
        self.stack.clear();
        loop {
            if child.is_block() {
                simd.vectorize(
                    #[inline(always)]
                    || self.test::<A>(child, group, &wedge, lanes),
                );
                limit = greatest(simd, &self.rays.limit, group.lanes);
            } else if lanes.count_ones() <= few.max(FEW * rows_of(lanes)) {
                simd.vectorize(
                    #[inline(always)]
                    || self.part::<A>(child, group, lanes),
                );
                limit = greatest(simd, &self.rays.limit, group.lanes);
            } else if let Some(node) = tree.nodes.get(child.0 as usize) {
                let met = frustum.meet(simd, node, limit);
                let from = self.stack.len();
                let (enter, mut places) = (met.enter.as_array(), met.lanes);
                while places != 0 {
                    let place = places.trailing_zeros() % WIDTH as u32;
                    places &= places - 1;
                    let waiting = Waiting { lanes, enter: enter[place as usize], node: child.0, place };
                    let _ = self.stack.push(waiting);
                    // The nearest last.
                    let mut at = self.stack.len();
                    while at > from + 1
                        && let [.., below, above] = &mut self.stack[..at]
                    {
                        if !(below.enter < above.enter) {
                            break;
                        }
                        core::mem::swap(below, above);
                        at -= 1;
                    }
                }
            }
            loop {
                let Some(next) = self.stack.pop() else { return };
                if next.enter > limit {
                    continue;
                }
                let Some(node) = tree.nodes.get(next.node as usize) else { continue };
                lanes = self.meet(node, next.place as usize, group, next.lanes);
                if lanes != 0 {
                    child = Child(node.rows[CHILDREN][next.place as usize % WIDTH]);
                    break;
                }
            }
        }
    }
}

/// Asks all rays, neighbours together.
#[inline(always)]
pub(super) fn run<S: Simd, A: Answers>(simd: S, tree: &Tree, rays: &[Ray], mut answers: A) {
    let Some(root) = tree.root else {
        (0..rays.len()).for_each(|index| answers.put(index, None));
        return;
    };
    let mut packet = Packet { simd, tree, given: &[], rays: Rays::new(), stack: heapless::Vec::new() };
    for (number, given) in rays.chunks(RAYS).enumerate() {
        packet.given = given;
        let together = simd.vectorize(
            #[inline(always)]
            || packet.rays.fill(simd, given),
        );
        let mut left = together;
        while left != 0 {
            let group = packet.rays.group(simd, left);
            left &= !group.lanes;
            simd.vectorize(
                #[inline(always)]
                || packet.walk::<A>(root, &group),
            );
        }
        for (lane, ray) in given.iter().enumerate() {
            let hit = if together >> lane & 1 == 0 {
                simd.vectorize(
                    #[inline(always)]
                    || walk::closest(simd, tree, ray),
                )
            } else {
                let best = packet.rays.best(lane);
                (best.primitive != u32::MAX).then_some(best)
            };
            answers.put(RAYS * number + lane, hit);
        }
    }
}
