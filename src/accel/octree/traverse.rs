use super::{
    MAX_DEPTH, Octree,
    node::{Node, Point, behind},
};
use crate::{
    accel::{Leaf, Step, Traversal},
    geometry::{Axis, PreparedRay, beyond, slack},
    math::{greatest, least},
};

/// The walk through an [`Octree`]: front to back, a stack of nodes with octants that wait.
#[derive(Clone, Debug)]
pub struct OctreeTraversal<'a> {
    body: &'a [u32],
    wide: bool,
    slack: f32,
    /// The node to go on with: the root at first, after a pause the one before which it was; none behind a leaf.
    next: Option<Visit>,
    /// Nodes with octants that wait, the nearest on top.
    stack: heapless::Vec<Wait, MAX_DEPTH>,
}

/// A node with the entry and exit of its cell.
#[derive(Clone, Copy, Debug)]
struct Visit {
    node: Node,
    enter: f32,
    exit: f32,
}

/// A node that was visited, some octants of which wait.
#[derive(Clone, Copy, Debug)]
struct Wait {
    visit: Visit,
    /// The octants that wait, as the ray sees them: numbered so that a set bit is the far side.
    octants: u32,
    /// How far the planes lie from the ray's origin.
    distances: [f32; 3],
}

/// Where the ray crosses the three planes of a node.
struct Planes {
    entry: [f32; 3],
    exit: [f32; 3],
}

/// The octants on the far side across each axis, as the ray sees them.
const FAR: [u32; 3] = [behind(Axis::X), behind(Axis::Y), behind(Axis::Z)];

impl Planes {
    /// The planes that lie at these distances from the ray's origin.
    #[inline(always)]
    fn new(ray: &PreparedRay, [x, y, z]: [f32; 3], slack: f32) -> Self {
        let [a, b, c, _] = &ray.views;
        Self {
            entry: [x * a.entry, y * b.entry, z * c.entry],
            exit: [x * a.exit + slack, y * b.exit + slack, z * c.exit + slack],
        }
    }

    /// The octants that the ray does not meet within an interval.
    ///
    /// Twelve comparisons without a branch: which octants are met is anyone's guess. Written so that NaN, the ray in a
    /// plane, leaves out none.
    #[inline(always)]
    fn missed(&self, enter: f32, exit: f32) -> u32 {
        let ([a, b, c], [x, y, z], [i, j, k]) = (self.entry, self.exit, FAR);
        let skip = |missed: bool, octants: u32| if missed { octants } else { 0 };
        let far = skip(a > exit, i) | skip(b > exit, j) | skip(c > exit, k);
        let near = skip(x < enter, !i) | skip(y < enter, !j) | skip(z < enter, !k);
        let across = skip(a > y, i & !j) | skip(b > z, j & !k) | skip(c > x, k & !i);
        let back = skip(a > z, i & !k) | skip(b > x, j & !i) | skip(c > y, k & !j);
        far | near | across | back
    }

    /// The part of an interval within an octant.
    #[inline(always)]
    fn narrow(&self, octant: u32, mut enter: f32, mut exit: f32) -> (f32, f32) {
        for (axis, (entry, leave)) in self.entry.into_iter().zip(self.exit).enumerate() {
            // All ones on the far side: choosing by bits needs no branch.
            let far = 0_u32.wrapping_sub(octant >> axis & 1);
            enter = greatest(f32::from_bits(entry.to_bits() & far | f32::NEG_INFINITY.to_bits() & !far), enter);
            exit = least(f32::from_bits(leave.to_bits() & !far | f32::INFINITY.to_bits() & far), exit);
        }
        (enter, exit)
    }
}

/// The octants of a node, mirrored along the axes that the ray descends.
#[inline(always)]
fn mirrored(node: Node, descending: u32) -> u32 {
    FAR.into_iter().enumerate().fold(node.octants(), |octants, (axis, far)| {
        let by = (descending >> axis & 1) << axis;
        (octants & !far) << by | (octants & far) >> by
    })
}

/// The first of a node's `octants`, with its interval.
#[inline(always)]
fn child(body: &[u32], ray: &PreparedRay, visit: Visit, octants: u32, planes: &Planes) -> Option<Visit> {
    let octant = octants.trailing_zeros();
    let &word = body.get(visit.node.child(octant ^ ray.descending) as usize)?;
    let (enter, exit) = planes.narrow(octant, visit.enter, visit.exit);
    Some(Visit { node: Node(word), enter, exit })
}

impl<'a> OctreeTraversal<'a> {
    #[inline]
    pub(super) fn new(tree: &Octree<'a>, ray: &PreparedRay) -> Self {
        // Not filled here, so that it is made where it stays.
        let mut traversal =
            Self { body: tree.body, wide: tree.is_wide(), slack: 0.0, next: None, stack: heapless::Vec::new() };
        if let Some((enter, exit)) = tree.bounds.interval(ray)
            && let Some(node) = tree.node(0)
        {
            let enter = greatest(enter, ray.ray().t_min);
            let exit = least(exit, beyond(ray.ray().t_max));
            traversal.slack = slack(enter);
            traversal.next = if enter > exit { None } else { Some(Visit { node, enter, exit }) };
        }
        traversal
    }

    /// The nearest octant that waits and begins before `end`.
    #[inline(always)]
    fn pop(&mut self, ray: &PreparedRay, end: f32) -> Option<Visit> {
        loop {
            let wait = self.stack.last_mut()?;
            let Wait { visit, octants, distances } = *wait;
            wait.octants = octants & (octants - 1);
            if wait.octants == 0 {
                let _ = self.stack.pop();
            }
            let planes = Planes::new(ray, distances, self.slack);
            let visit = child(self.body, ray, visit, octants, &planes)?;
            if !(visit.enter > end) {
                return Some(visit);
            }
        }
    }

    #[inline(always)]
    fn advance<const BOUNDED: bool>(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        let (body, slack, end) = (self.body, self.slack, beyond(t_max));
        let Some(mut visit) = self.next.take().or_else(|| self.pop(ray, end)) else { return Step::Done };
        loop {
            if BOUNDED {
                if *budget == 0 {
                    self.next = Some(visit);
                    return Step::Paused;
                }
                *budget -= 1;
            }
            if visit.node.is_leaf() {
                return Step::Leaf(visit.node.leaf_in(body, self.wide));
            }
            let Some(point) = body.get(visit.node.block() as usize..).and_then(Point::from_words) else {
                return Step::Done;
            };
            let (Point([x, y, z]), [a, b, c, _]) = (point, &ray.views);
            let distances = [x - a.origin, y - b.origin, z - c.origin];
            let planes = Planes::new(ray, distances, slack);
            let live = mirrored(visit.node, ray.descending) & !planes.missed(visit.enter, visit.exit);
            let octants = live & live.wrapping_sub(1);
            if octants != 0 {
                // Cannot fail: the tree is no deeper than the stack.
                let _ = self.stack.push(Wait { visit, octants, distances });
            }
            let next = if live == 0 { self.pop(ray, end) } else { child(body, ray, visit, live, &planes) };
            match next {
                Some(next) => visit = next,
                None => return Step::Done,
            }
        }
    }
}

impl<'a> Traversal for OctreeTraversal<'a> {
    type Leaf = Leaf<'a>;

    fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<Leaf<'a>> {
        match self.advance::<false>(ray, t_max, &mut 0) {
            Step::Leaf(leaf) => Some(leaf),
            Step::Paused | Step::Done => None,
        }
    }

    fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<Leaf<'a>> {
        self.advance::<true>(ray, t_max, budget)
    }
}
