//! The walk of `hitscan::KdTree` as it would be written if there were no cursor: one loop around an inlined closure.
//!
//! The same nodes in the same order by the same rules as in `src/accel/kdtree/traverse.rs`, for rays with `t >= 0`. It
//! reads the tree's words itself, so that it needs no more than what the library makes public.

use hitscan::{Accelerator, Hit, KdTree, Mesh, PreparedRay, Primitives, Ray, Span, geometry::Aabb, kdtree::MAX_DEPTH};

/// Words before the nodes.
const HEADER_WORDS: usize = 10;

/// 2^-16, by which exits are widened.
const WIDENING: f32 = 1.0 / 65536.0;

/// A ray as one axis sees it.
#[derive(Clone, Copy, Debug)]
pub struct View {
    origin: f32,
    entry: f32,
    exit: f32,
}

/// What the library keeps of a ray for its trees, but does not show: made before anything is counted.
///
/// For rays whose direction has no component that is almost 0.
pub fn views(ray: &Ray) -> [View; 3] {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    [0, 1, 2].map(|axis| {
        let entry = 1.0 / direction[axis];
        View { origin: origin[axis], entry, exit: entry * (1.0 + WIDENING) }
    })
}

/// A kD-tree's words, for at most 2^16 primitives.
#[derive(Clone, Copy, Debug)]
pub struct InlinedTree<'a> {
    nodes: &'a [[u32; 2]],
    references: &'a [u32],
    bounds: Aabb,
}

impl<'a> InlinedTree<'a> {
    /// The same tree.
    pub fn new(tree: &KdTree<'a>) -> Self {
        let (nodes, references) = tree.as_words()[HEADER_WORDS..].split_at(tree.node_count() * 2);
        Self { nodes: bytemuck::cast_slice(nodes), references, bounds: tree.bounds() }
    }

    /// The first hit of the ray with a triangle of `mesh`.
    pub fn closest_hit(&self, mesh: &Mesh<'_>, ray: &Ray, views: &[View; 3]) -> Option<Hit> {
        let prepared = ray.prepare();
        let ray = prepared.as_ref()?;
        let from = Hit { t: ray.ray().t_min, primitive: 0 };
        let mut best = Hit { t: ray.ray().t_max, primitive: u32::MAX };
        self.walk(ray, views, best.t, |index| {
            if mesh.mask(index) & ray.ray().mask != 0
                && let Some(hit) = mesh.intersect(index, ray, &Span::new(from, best))
            {
                best = hit;
            }
            best.t
        });
        (best.primitive != u32::MAX).then_some(best)
    }

    /// Calls `test` with the numbers of primitives that the ray may meet, front to back, up to the `t` it returns.
    #[inline(always)]
    fn walk(&self, ray: &PreparedRay, views: &[View; 3], mut t_max: f32, mut test: impl FnMut(u32) -> f32) {
        let beyond = |t: f32| t + t.abs() * (4.0 * WIDENING) + 4.0 * f32::MIN_POSITIVE;
        let Some((enter, exit)) = self.bounds.interval(ray) else { return };
        let mut enter = if enter > ray.ray().t_min { enter } else { ray.ray().t_min };
        let last = beyond(t_max);
        let mut exit = if exit < last { exit } else { last };
        if enter > exit {
            return;
        }
        // The nearest far child that begins before the best hit; no plane's parameter is NaN here.
        let pop = |stack: &mut heapless::Vec<(u32, f32, f32), MAX_DEPTH>, t_max: f32| loop {
            let entry = stack.pop()?;
            if entry.1 <= beyond(t_max) {
                return Some(entry);
            }
        };
        let mut stack = heapless::Vec::new();
        let mut index = 0;
        loop {
            let Some(&[payload, link]) = self.nodes.get(index as usize) else { return };
            if let Some(view) = views.get(link as usize & 3) {
                // An inner node: the child on the ray's side first.
                let (left, right) = (index + 1, link >> 4);
                let descended = view.entry.is_sign_negative();
                let (near, far) = if descended { (right, left) } else { (left, right) };
                let distance = f32::from_bits(payload) - view.origin;
                let plane_entry = distance * view.entry;
                let plane_exit = distance * view.exit + 2.0 * f32::MIN_POSITIVE;
                if link & 12 != 0 {
                    // A cut: one child, on the side that is not empty.
                    let passed = if (link & 8 != 0) != descended {
                        exit = if plane_exit < exit { plane_exit } else { exit };
                        plane_exit < enter
                    } else {
                        enter = if plane_entry > enter { plane_entry } else { enter };
                        plane_entry > exit
                    };
                    index = left;
                    if passed {
                        let Some(entry) = pop(&mut stack, t_max) else { return };
                        (index, enter, exit) = entry;
                    }
                } else if plane_entry > exit {
                    index = near;
                } else if plane_exit < enter {
                    index = far;
                } else {
                    let _ = stack.push((far, if plane_entry > enter { plane_entry } else { enter }, exit));
                    index = near;
                    exit = if plane_exit < exit { plane_exit } else { exit };
                }
                continue;
            }
            // A leaf: a primitive, or references to some.
            let count = link >> 4;
            for place in payload..payload + count {
                let reference = self.references.get(place as usize / 2).map(|word| word >> (16 * (place % 2)) & 0xffff);
                let Some(index) = (if count == 1 { Some(payload) } else { reference }) else { break };
                t_max = test(index);
            }
            let Some(entry) = pop(&mut stack, t_max) else { return };
            (index, enter, exit) = entry;
        }
    }
}
