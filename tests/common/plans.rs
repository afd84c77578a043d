//! Structures of every kind, with options from sensible to absurd.

use hitscan::{
    Arena, Primitives,
    accel::{Plan, Structure},
    bvh, dualsplit,
    error::BuildError,
    grid, kdtree, octree,
};

use super::Random;

/// A few plans of every structure, for tests that try them all.
pub fn presets() -> Vec<(&'static str, Plan)> {
    let ploc = bvh::Options { method: bvh::Method::Ploc, ..bvh::Options::balanced() };
    let split = |split| kdtree::Options { split, ..kdtree::Options::balanced() };
    vec![
        ("grid small", Plan::Grid(grid::Options::small())),
        ("grid balanced", Plan::Grid(grid::Options::balanced())),
        ("grid fast", Plan::Grid(grid::Options::fast())),
        ("grid quick", Plan::Grid(grid::Options::quick())),
        ("octree small", Plan::Octree(octree::Options::small())),
        ("octree balanced", Plan::Octree(octree::Options::balanced())),
        ("octree fast", Plan::Octree(octree::Options::fast())),
        ("kD-tree small", Plan::KdTree(kdtree::Options::small())),
        ("kD-tree balanced", Plan::KdTree(kdtree::Options::balanced())),
        ("kD-tree fast", Plan::KdTree(kdtree::Options::fast())),
        ("kD-tree midpoint", Plan::KdTree(split(kdtree::Split::Midpoint))),
        ("kD-tree median", Plan::KdTree(split(kdtree::Split::Median))),
        ("compact kD-tree small", Plan::CompactKdTree(kdtree::Options::small())),
        ("compact kD-tree balanced", Plan::CompactKdTree(kdtree::Options::balanced())),
        ("compact kD-tree fast", Plan::CompactKdTree(kdtree::Options::fast())),
        ("BVH small", Plan::Bvh(bvh::Options::small())),
        ("BVH balanced", Plan::Bvh(bvh::Options::balanced())),
        ("BVH fast", Plan::Bvh(bvh::Options::fast())),
        ("BVH ploc", Plan::Bvh(ploc)),
        ("dual-split small", Plan::DualSplit(dualsplit::Options::small())),
        ("dual-split balanced", Plan::DualSplit(dualsplit::Options::balanced())),
        ("dual-split fast", Plan::DualSplit(dualsplit::Options::fast())),
        ("dual-split quick", Plan::DualSplit(dualsplit::Options::quick())),
    ]
}

/// How many kinds of structures [`random`] knows.
pub const KINDS: usize = 6;

/// A plan of a kind with options at random.
pub fn random(random: &mut Random, kind: usize) -> Plan {
    let max_bytes = random.pick(&[None, None, None, Some(1600)]);
    let clip = !random.one_in(4);
    let leaf_size = random.pick(&[1, 1, 2, 4]);
    let cost = |random: &mut Random, own: f32| random.pick(&[own, 2.0, 20.0]);
    match kind {
        0 => Plan::Grid(grid::Options {
            density: random.pick(&[0.3, 2.0, 8.0, 8.0, 50.0]),
            form: random.pick(&grid::Form::ALL),
            clip,
            bytes_per_primitive: random.pick(&[30, 200, 200]),
            max_bytes,
        }),
        1 => {
            let preset = random.pick(&[octree::Options::small(), octree::Options::fast()]);
            Plan::Octree(octree::Options {
                split: random.pick(&[octree::Split::Middle, octree::Split::Sah, octree::Split::Sah]),
                leaf_size,
                max_depth: random.pick(&[16, 16, 3, 40]),
                intersection_cost: cost(random, preset.intersection_cost),
                clip,
                max_bytes,
                ..preset
            })
        }
        2 | 3 => {
            let preset = random.pick(&[kdtree::Options::small(), kdtree::Options::fast()]);
            let options = kdtree::Options {
                split: random.pick(&[kdtree::Split::Midpoint, kdtree::Split::Median, kdtree::Split::Sah]),
                leaf_size,
                max_depth: random.pick(&[None, None, Some(3), Some(40)]),
                intersection_cost: cost(random, preset.intersection_cost),
                clip,
                max_bytes,
                ..preset
            };
            if kind == 2 { Plan::KdTree(options) } else { Plan::CompactKdTree(options) }
        }
        4 => {
            use dualsplit::Options;
            let preset = random.pick(&[Options::small(), Options::fast(), Options::quick()]);
            Plan::DualSplit(Options { leaf_size, ..preset })
        }
        _ => {
            let preset = random.pick(&[bvh::Options::small(), bvh::Options::fast()]);
            Plan::Bvh(bvh::Options {
                method: random.pick(&[bvh::Method::Sah, bvh::Method::Ploc]),
                leaf_size,
                intersection_cost: cost(random, preset.intersection_cost),
                reinsertions: random.below(4) as u32,
                bytes_per_primitive: random.pick(&[preset.bytes_per_primitive, 99.0]),
                max_bytes,
            })
        }
    }
}

/// Builds by a plan of a kind at random; none if that allows too few bytes for so many primitives.
pub fn build<'m, P: Primitives>(
    numbers: &mut Random,
    kind: usize,
    primitives: &P,
    memory: &'m mut [u32],
) -> Option<(Plan, Structure<'m>)> {
    let plan = random(numbers, kind);
    match Structure::build(primitives, &mut Arena::new(memory), &plan) {
        Ok(structure) => Some((plan, structure)),
        Err(BuildError::Budget { .. }) => None,
        Err(error) => panic!("{error}: {plan:?}"),
    }
}
