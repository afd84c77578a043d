//! A binary hierarchy by the binned surface area heuristic: Wald, *On fast construction of SAH-based bounding volume
//! hierarchies*, 2007.

use std::{vec, vec::Vec};

use super::binary::{Binary, BinaryNode, MAX_DEPTH};
use crate::geometry::{Aabb, Axis};

/// Intervals into which the middles of triangles are sorted along an axis.
const BINS: usize = 32;

/// Nodes this deep are halved, whatever it costs: the 2^28 references below end within [`MAX_DEPTH`].
const HALVED: u32 = MAX_DEPTH - 29;

/// Which references stand in the place of which node.
struct Task {
    node: usize,
    first: usize,
    end: usize,
    depth: u32,
}

/// What of the references is in a bin.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

const EMPTY: Bin = Bin { bounds: Aabb::EMPTY, count: 0 };

impl Bin {
    fn with(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(&other.bounds), count: self.count + other.count }
    }

    fn cost(&self) -> f32 {
        self.bounds.half_area() * self.count as f32
    }
}

/// Where a node's references are divided: what is in lower bins than this goes to the left.
struct Plane {
    axis: Axis,
    bin: usize,
}

/// The bins of the middles within `middles` along an axis.
struct Binning {
    axis: Axis,
    low: f32,
    scale: f32,
}

impl Binning {
    fn new(middles: &Aabb, axis: Axis) -> Option<Self> {
        let (low, size) = (axis.of(middles.min), axis.of(middles.size()));
        let scale = BINS as f32 * 0.999_999 / size;
        (size > 0.0 && scale.is_finite()).then_some(Self { axis, low, scale })
    }

    fn of(&self, bounds: &Aabb) -> usize {
        (((self.axis.of(bounds.center()) - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

/// The hierarchy over boxes with these bounds.
pub(super) fn build(boxes: &[Aabb]) -> Binary {
    let mut references: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = Vec::new();
    if boxes.is_empty() {
        return Binary { nodes, references };
    }
    nodes.push(BinaryNode { bounds: Aabb::EMPTY, first: 0, count: 0 });
    let mut tasks = vec![Task { node: 0, first: 0, end: boxes.len(), depth: 0 }];
    while let Some(Task { node, first, end, depth }) = tasks.pop() {
        let part = &mut references[first..end];
        let bounds = part.iter().fold(Aabb::EMPTY, |all, &i| all.union(&boxes[i as usize]));
        if part.len() == 1 {
            nodes[node] = BinaryNode { bounds, first: first as u32, count: 1 };
            continue;
        }
        let middle = first + divide(part, boxes, depth);
        let children = nodes.len();
        nodes[node] = BinaryNode { bounds, first: children as u32, count: 0 };
        nodes.extend([BinaryNode { bounds, first: 0, count: 0 }; 2]);
        tasks.push(Task { node: children + 1, first: middle, end, depth: depth + 1 });
        tasks.push(Task { node: children, first, end: middle, depth: depth + 1 });
    }
    Binary { nodes, references }
}

/// Puts the references of two children one behind the other; where the second begins.
fn divide(part: &mut [u32], boxes: &[Aabb], depth: u32) -> usize {
    let middles = Aabb::around(part.iter().map(|&i| boxes[i as usize].center()));
    if depth < HALVED
        && let Some(plane) = best_plane(part, boxes, &middles)
        && let Some(binning) = Binning::new(&middles, plane.axis)
    {
        let mut left = 0;
        for i in 0..part.len() {
            if binning.of(&boxes[part[i] as usize]) < plane.bin {
                part.swap(i, left);
                left += 1;
            }
        }
        if left > 0 && left < part.len() {
            return left;
        }
    }
    let (half, axis) = (part.len() / 2, Axis::of_largest(middles.size()));
    let key = |&i: &u32| axis.of(boxes[i as usize].center());
    part.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)));
    half
}

/// The plane of least cost; none if all middles are one.
fn best_plane(part: &[u32], boxes: &[Aabb], middles: &Aabb) -> Option<Plane> {
    let mut best = (f32::INFINITY, None);
    for axis in Axis::ALL {
        let Some(binning) = Binning::new(middles, axis) else { continue };
        let mut bins = [EMPTY; BINS];
        for &i in part {
            let bounds = boxes[i as usize];
            let bin = &mut bins[binning.of(&bounds)];
            *bin = bin.with(Bin { bounds, count: 1 });
        }
        let mut costs = [0.0; BINS];
        let mut right = EMPTY;
        for bin in (1..BINS).rev() {
            right = right.with(bins[bin]);
            costs[bin] = right.cost();
        }
        let mut left = EMPTY;
        for bin in 1..BINS {
            left = left.with(bins[bin - 1]);
            let cost = left.cost() + costs[bin];
            if cost < best.0 && left.count > 0 && left.count < part.len() {
                best = (cost, Some(Plane { axis, bin }));
            }
        }
    }
    best.1
}
