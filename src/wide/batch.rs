//! Many rays in one loop: while one waits for memory, the others walk.
//!
//! Rays that are at nodes take a step each, then those that are at blocks, so that the processor hardly has to guess what
//! comes next; which of a node's children are met, and how many, decides about no branch.

use std::{vec, vec::Vec};

use fearless_simd::{Bytes, Simd, SimdBase, f32x8, u32x8};

use super::{
    node::{CHILDREN, Child, ORDERS, WIDTH},
    permute::permute,
    slabs::{Sides, Slabs, row},
    tree::Tree,
    walk::Query,
};
use crate::{
    geometry::{Aabb, PreparedRay, Ray, ShearLanes, beyond},
    primitives::Hit,
    query::end_of,
};

/// Rays that walk at a time.
pub(super) const RUNNERS: usize = 64;

/// A ray on its way.
#[derive(Clone, Copy)]
struct Runner {
    ray: PreparedRay,
    sides: Sides,
    best: Hit,
    /// The parameter behind which nothing counts.
    behind: f32,
    child: Child,
    /// How many children wait.
    waiting: usize,
    /// The number of the ray.
    index: usize,
}

/// The runners that are at nodes, or at blocks.
#[derive(Clone, Copy)]
struct Places {
    /// Twice as many as there are, so that an index of five bits needs no check.
    list: [u8; 2 * RUNNERS],
    len: usize,
}

impl Places {
    const NONE: Self = Self { list: [0; 2 * RUNNERS], len: 0 };

    /// Adds a runner, if so.
    #[inline(always)]
    const fn add(&mut self, place: u8, really: bool) {
        self.list[self.len % (2 * RUNNERS)] = place;
        self.len += really as usize;
    }
}

/// What a query wants of a ray's hits, and where it puts them.
pub(super) trait Answers {
    /// Whether one hit is as good as any other.
    const ANY: bool;

    /// The answer to a ray.
    fn put(&mut self, index: usize, hit: Option<Hit>);
}

impl Answers for &mut [Option<Hit>] {
    const ANY: bool = false;

    #[inline(always)]
    fn put(&mut self, index: usize, hit: Option<Hit>) {
        if let Some(place) = self.get_mut(index) {
            *place = hit;
        }
    }
}

impl Answers for &mut [bool] {
    const ANY: bool = true;

    #[inline(always)]
    fn put(&mut self, index: usize, hit: Option<Hit>) {
        if let Some(place) = self.get_mut(index) {
            *place = hit.is_some();
        }
    }
}

/// The children that wait, of one runner: where they are entered and what they are.
struct Waiting<'w> {
    enters: &'w mut [f32],
    children: &'w mut [u32],
}

impl Waiting<'_> {
    /// Adds eight, of which some count.
    #[inline(always)]
    fn push<S: Simd>(&mut self, at: usize, enters: f32x8<S>, children: u32x8<S>) {
        let to = self.enters.get_mut(at..).and_then(<[f32]>::first_chunk_mut::<WIDTH>);
        let and = self.children.get_mut(at..).and_then(<[u32]>::first_chunk_mut::<WIDTH>);
        if let (Some(to), Some(and)) = (to, and) {
            enters.store_array(to);
            children.store_array(and);
        }
    }

    /// The last of `count` that is not entered behind `limit`, and how many wait then.
    #[inline(always)]
    fn pop(&self, mut count: usize, limit: f32) -> Option<(Child, usize)> {
        loop {
            count = count.checked_sub(1)?;
            let (&enter, &child) = (self.enters.get(count)?, self.children.get(count)?);
            if !(enter > limit) {
                return Some((Child(child), count));
            }
        }
    }
}

impl Runner {
    #[inline(always)]
    fn new(ray: &Ray, root: Child, bounds: &Aabb, index: usize) -> Option<Self> {
        let ray = PreparedRay::here(ray)?;
        let (sides, best) = (Sides::of(&ray, bounds), end_of(&ray));
        Some(Self { ray, sides, best, behind: beyond(best.t), child: root, waiting: 0, index })
    }

    fn hit(&self) -> Option<Hit> {
        (self.best.primitive != u32::MAX).then_some(self.best)
    }

    /// Goes on with what waits; whether there is anything.
    #[inline(always)]
    fn next(&mut self, waiting: &Waiting<'_>, count: usize) -> bool {
        let next = waiting.pop(count, self.behind);
        (self.child, self.waiting) = next.unwrap_or((self.child, 0));
        next.is_some()
    }

    /// Looks at a node; whether there is more.
    #[inline(always)]
    fn cross<S: Simd, A: Answers>(&mut self, simd: S, tree: &Tree, waiting: &mut Waiting<'_>) -> bool {
        let Some(node) = tree.nodes.get(self.child.0 as usize) else { return false };
        let met = Slabs::new(simd, &self.ray, self.sides).meet(simd, node, f32x8::splat(simd, self.behind));
        let places = if A::ANY {
            u32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7])
        } else {
            // The nearest last: by the order of the ray's octant, in which every four bits name a lane.
            let order = u32x8::splat(simd, node.rows[ORDERS][self.sides.octant & 7]);
            simd.shrv_u32x8(order, u32x8::load_array(simd, [0, 4, 8, 12, 16, 20, 24, 28])) & 7
        };
        let met_there = simd.shrv_u32x8(u32x8::splat(simd, met.lanes), places) & 1;
        let lanes = places.compress(met_there.simd_eq(1));
        let children = permute(simd, row(simd, &node.rows[CHILDREN]).bitcast(), lanes);
        let enters = permute(simd, met.enter.bitcast(), lanes);
        waiting.push(self.waiting, enters.bitcast(), children);
        self.next(waiting, self.waiting + met.lanes.count_ones() as usize)
    }

    /// Looks at a block; whether there is more.
    #[inline(always)]
    fn test<S: Simd, A: Answers>(&mut self, simd: S, tree: &Tree, waiting: &Waiting<'_>) -> bool {
        if let Some(block) = tree.block(self.child) {
            let query = Query { simd, tree, asker: &self.ray, shear: ShearLanes::new(simd, &self.ray) };
            if !A::ANY {
                query.improve(block, &mut self.best);
                self.behind = beyond(self.best.t);
            } else if query.is_hit(block, self.best) {
                self.best.primitive = 0;
                return false;
            }
        }
        self.next(waiting, self.waiting)
    }
}

/// The rays that have not begun, and the answers to all.
struct Queue<'r, A> {
    rays: &'r [Ray],
    root: Child,
    bounds: &'r Aabb,
    next: usize,
    answers: A,
}

impl<A: Answers> Queue<'_, A> {
    /// The next ray that is valid.
    #[inline(always)]
    fn begin(&mut self) -> Option<Runner> {
        loop {
            let (ray, index) = (self.rays.get(self.next)?, self.next);
            self.next += 1;
            match Runner::new(ray, self.root, self.bounds, index) {
                None => self.answers.put(index, None),
                runner => return runner,
            }
        }
    }
}

/// All that walks.
struct Batch<'b, S: Simd, A> {
    simd: S,
    tree: &'b Tree,
    queue: Queue<'b, A>,
    runners: Vec<Runner>,
    /// Of each runner this much.
    room: usize,
    enters: Vec<f32>,
    children: Vec<u32>,
    nodes: Places,
    blocks: Places,
    /// How many blocks rays have looked at.
    tested: usize,
}

impl<S: Simd, A: Answers> Batch<'_, S, A> {
    /// One step of a runner, and of the ray that takes its place if it is done.
    #[inline(always)]
    fn step(&mut self, place: u8, at_block: bool) -> Option<()> {
        let (runner, from) = (self.runners.get_mut(usize::from(place))?, usize::from(place) * self.room);
        let enters = self.enters.get_mut(from..)?.get_mut(..self.room)?;
        let children = self.children.get_mut(from..)?.get_mut(..self.room)?;
        let mut waiting = Waiting { enters, children };
        let goes_on = if at_block {
            runner.test::<S, A>(self.simd, self.tree, &waiting)
        } else {
            runner.cross::<S, A>(self.simd, self.tree, &mut waiting)
        };
        if !goes_on {
            self.queue.answers.put(runner.index, runner.hit());
            *runner = self.queue.begin()?;
        }
        let is_block = runner.child.is_block();
        self.nodes.add(place, !is_block);
        self.blocks.add(place, is_block);
        Some(())
    }

    /// Reads a word of each line that runners will look at, so that memory is asked for all of them at once.
    #[inline(always)]
    fn touch(&self, places: &Places) {
        let mut touched = 0;
        for &place in places.list.iter().take(places.len) {
            let Some(&Runner { child, .. }) = self.runners.get(usize::from(place)) else { break };
            touched ^= self.tree.touch(child);
        }
        core::hint::black_box(touched);
    }

    #[inline(always)]
    fn run(&mut self) {
        while self.nodes.len + self.blocks.len > 0 {
            let at_nodes = core::mem::replace(&mut self.nodes, Places::NONE);
            self.touch(&at_nodes);
            for &place in at_nodes.list.iter().take(at_nodes.len) {
                self.step(place, false);
            }
            let at_blocks = core::mem::replace(&mut self.blocks, Places::NONE);
            self.touch(&at_blocks);
            self.tested += at_blocks.len;
            for &place in at_blocks.list.iter().take(at_blocks.len) {
                self.step(place, true);
            }
        }
    }
}

/// Asks all rays, some at a time; how many blocks they have looked at.
#[inline(always)]
pub(super) fn run<S: Simd, A: Answers>(simd: S, tree: &Tree, rays: &[Ray], mut answers: A) -> usize {
    let Some(root) = tree.root else {
        (0..rays.len()).for_each(|index| answers.put(index, None));
        return 0;
    };
    let mut queue = Queue { rays, root, bounds: &tree.bounds, next: 0, answers };
    let mut runners = Vec::with_capacity(RUNNERS);
    let (mut nodes, mut blocks) = (Places::NONE, Places::NONE);
    while runners.len() < RUNNERS {
        let Some(runner) = queue.begin() else { break };
        nodes.add(runners.len() as u8, !root.is_block());
        blocks.add(runners.len() as u8, root.is_block());
        runners.push(runner);
    }
    let room = tree.stack + WIDTH;
    let (enters, children) = (vec![0.0; room * runners.len()], vec![0; room * runners.len()]);
    let mut batch = Batch { simd, tree, queue, runners, room, enters, children, nodes, blocks, tested: 0 };
    batch.run();
    batch.tested
}
