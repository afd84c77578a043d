use hitscan::{accel::Plan, bvh, dualsplit, grid, kdtree, octree};

/// The options of a preset: 0 for `small`, 2 for `fast`, else `balanced`.
macro_rules! tuned {
    ($preset:expr, $options:ty) => {
        match $preset {
            0 => <$options>::small(),
            2 => <$options>::fast(),
            _ => <$options>::balanced(),
        }
    };
}

/// The structure of this number in the page's list, built for a preset.
#[must_use]
pub fn plan(structure: u32, preset: u32) -> Option<Plan> {
    Some(match structure {
        0 => Plan::List,
        1 => Plan::Grid(tuned!(preset, grid::Options)),
        2 => Plan::Octree(tuned!(preset, octree::Options)),
        3 => Plan::KdTree(tuned!(preset, kdtree::Options)),
        4 => Plan::CompactKdTree(tuned!(preset, kdtree::Options)),
        5 => Plan::Bvh(tuned!(preset, bvh::Options)),
        6 => Plan::DualSplit(tuned!(preset, dualsplit::Options)),
        _ => return None,
    })
}
