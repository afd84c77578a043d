//! Options of every structure, from outside.

use hitscan::{accel::Plan, bvh, dualsplit, grid, kdtree, octree};

use crate::input::{float, word};

/// A plan of any kind with any options.
pub fn any() -> Plan {
    match word() {
        0 => Plan::List,
        1 => Plan::Grid(grid()),
        2 => Plan::Octree(octree()),
        3 => Plan::KdTree(kdtree()),
        4 => Plan::CompactKdTree(kdtree()),
        5 => Plan::Bvh(bvh()),
        _ => Plan::DualSplit(dualsplit()),
    }
}

/// One of some presets.
fn one_of<O: Copy + Default>(presets: &[O]) -> O {
    presets.get(word() as usize).copied().unwrap_or_default()
}

fn grid() -> grid::Options {
    use grid::{Form, Options};
    let preset = one_of(&[Options::small(), Options::balanced(), Options::fast().fit(word() as usize)]);
    let form = Form::ALL.get(word() as usize).copied().unwrap_or(Form::Bitmask);
    Options { form, density: float(), clip: word() == 0, bytes_per_primitive: word(), ..preset }
}

fn octree() -> octree::Options {
    use octree::{Options, Split};
    Options {
        split: if word() == 0 { Split::Middle } else { Split::Sah },
        leaf_size: word(),
        max_depth: word(),
        intersection_cost: float(),
        clip: word() == 0,
        bytes_per_primitive: word(),
        ..one_of(&[Options::small(), Options::balanced(), Options::fast().fit(word() as usize)])
    }
}

fn kdtree() -> kdtree::Options {
    use kdtree::{Options, Split};
    Options {
        split: match word() {
            0 => Split::Midpoint,
            1 => Split::Median,
            _ => Split::Sah,
        },
        leaf_size: word(),
        max_depth: if word() == 0 { None } else { Some(word()) },
        intersection_cost: float(),
        byte_cost: float(),
        empty_bonus: float(),
        clip: word() == 0,
        bytes_per_primitive: word(),
        ..one_of(&[Options::small(), Options::balanced(), Options::fast().fit(word() as usize)])
    }
}

fn bvh() -> bvh::Options {
    use bvh::{Method, Options};
    Options {
        method: if word() == 0 { Method::Sah } else { Method::Ploc },
        reinsertions: word(),
        leaf_size: word(),
        intersection_cost: float(),
        bytes_per_primitive: float(),
        ..one_of(&[Options::small(), Options::balanced(), Options::fast().fit(word() as usize)])
    }
}

fn dualsplit() -> dualsplit::Options {
    use dualsplit::Options;
    let preset = one_of(&[Options::small(), Options::balanced(), Options::fast(), Options::quick()]);
    Options { leaf_size: word(), intersection_cost: float(), carve_threshold: float(), ..preset }
}
