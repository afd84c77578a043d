//! What is built on the device.

use hitscan::{accel::Plan, bvh, dualsplit, grid, kdtree, octree};

/// Every structure by name, with the options for little memory.
pub const BUILDS: [(&str, Plan); 6] = [
    ("grid", Plan::Grid(grid::Options::small())),
    ("octree", Plan::Octree(octree::Options::small())),
    ("kdtree", Plan::KdTree(kdtree::Options::small())),
    ("kdtree-compact", Plan::CompactKdTree(kdtree::Options::small())),
    ("bvh", Plan::Bvh(bvh::Options::small())),
    ("dual-split", Plan::DualSplit(dualsplit::Options::small())),
];
