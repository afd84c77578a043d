//! Many rays in one loop: while one waits for memory, the others walk.

use std::vec::Vec;

use fearless_simd::Simd;

use super::{
    node::Child,
    slabs::{Sides, Slabs, limit},
    stack::Stack,
    tree::Tree,
    walk::{Query, descend, descend_anyhow},
};
use crate::{
    geometry::{PreparedRay, Ray, ShearLanes, beyond},
    primitives::Hit,
    query::end_of,
};

/// Rays that walk at a time.
const RUNNERS: usize = 8;

/// A ray on its way.
struct Runner {
    ray: PreparedRay,
    sides: Sides,
    best: Hit,
    child: Child,
    /// The number of the ray.
    index: usize,
}

/// What a query wants of a ray's hits, and where it puts them.
trait Answers {
    /// Whether one hit is as good as any other.
    const ANY: bool;

    /// How many there are.
    fn len(&self) -> usize;

    /// The answer to a ray.
    fn put(&mut self, index: usize, hit: Option<Hit>);
}

impl Answers for &mut [Option<Hit>] {
    const ANY: bool = false;

    fn len(&self) -> usize {
        <[_]>::len(self)
    }

    #[inline(always)]
    fn put(&mut self, index: usize, hit: Option<Hit>) {
        if let Some(place) = self.get_mut(index) {
            *place = hit;
        }
    }
}

impl Answers for &mut [bool] {
    const ANY: bool = true;

    fn len(&self) -> usize {
        <[_]>::len(self)
    }

    #[inline(always)]
    fn put(&mut self, index: usize, hit: Option<Hit>) {
        if let Some(place) = self.get_mut(index) {
            *place = hit.is_some();
        }
    }
}

impl Runner {
    fn new(ray: &Ray, root: Child, index: usize) -> Option<Self> {
        let ray = PreparedRay::here(ray)?;
        let (sides, best) = (Sides::of(&ray), end_of(&ray));
        Some(Self { ray, sides, best, child: root, index })
    }

    fn hit(&self) -> Option<Hit> {
        (self.best.primitive != u32::MAX).then_some(self.best)
    }

    /// Looks at a node or a block; whether there is more.
    #[inline(always)]
    fn step<S: Simd, A: Answers>(&mut self, simd: S, tree: &Tree, stack: &mut Stack) -> bool {
        if !self.child.is_block() {
            let Some(node) = tree.nodes.get(self.child.0 as usize) else { return false };
            let met = Slabs::new(simd, &self.ray, self.sides).meet(simd, node, limit(simd, self.best.t));
            if met.lanes != 0 {
                self.child = if A::ANY { descend_anyhow(node, met.lanes, stack) } else { descend(node, &met, stack) };
                return true;
            }
        } else {
            let Some(block) = tree.block(self.child) else { return false };
            let query = Query { simd, tree, ray: &self.ray, shear: ShearLanes::new(simd, &self.ray) };
            query.improve(block, self.child.count(), &mut self.best);
            if A::ANY && self.best.primitive != u32::MAX {
                return false;
            }
        }
        let next = stack.pop(beyond(self.best.t));
        self.child = next.unwrap_or(self.child);
        next.is_some()
    }
}

/// Asks all rays, some at a time.
#[inline(always)]
fn run<S: Simd, A: Answers>(simd: S, tree: &Tree, rays: &[Ray], mut answers: A) {
    let count = rays.len().min(answers.len());
    let Some(root) = tree.root else {
        (0..count).for_each(|index| answers.put(index, None));
        return;
    };
    let mut next = 0;
    let mut begin = |answers: &mut A| {
        while next < count {
            let index = next;
            next += 1;
            match rays.get(index).and_then(|ray| Runner::new(ray, root, index)) {
                None => answers.put(index, None),
                runner => return runner,
            }
        }
        None
    };
    let mut runners: Vec<Runner> = (0..RUNNERS).map_while(|_| begin(&mut answers)).collect();
    let mut stacks = [const { Stack::new() }; RUNNERS];
    while !runners.is_empty() {
        let mut finished = None;
        for (place, (runner, stack)) in runners.iter_mut().zip(&mut stacks).enumerate() {
            if !runner.step::<S, A>(simd, tree, stack) {
                answers.put(runner.index, runner.hit());
                stack.clear();
                match begin(&mut answers) {
                    Some(ray) => *runner = ray,
                    None => {
                        finished = Some(place);
                        break;
                    }
                }
            }
        }
        if let Some(place) = finished {
            stacks.swap(place, runners.len() - 1);
            runners.swap_remove(place);
        }
    }
}

/// The least hits of `rays`.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, tree: &Tree, rays: &[Ray], hits: &mut [Option<Hit>]) {
    run(simd, tree, rays, hits);
}

/// Whether `rays` have hits.
#[inline(always)]
pub(super) fn any<S: Simd>(simd: S, tree: &Tree, rays: &[Ray], hits: &mut [bool]) {
    run(simd, tree, rays, hits);
}
