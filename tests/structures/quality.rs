//! kD-trees are worth their bytes: equality alone would hold for a single leaf, too.

use crate::common::meshes::sheet;
use hitscan::{
    KdTree, Mesh,
    accel::Plan,
    bake,
    kdtree::{Options, Split},
};

/// Bytes per triangle, and nodes and tests expected per ray through the bounds.
fn measured(side: u32, options: &Options) -> (f32, f32, f32) {
    let (vertices, triangles) = sheet(side);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let words = bake::build(&mesh, &Plan::KdTree(*options)).unwrap();
    let (nodes, tests) = KdTree::open(&words).unwrap().expected_work();
    (words.len() as f32 * 4.0 / triangles.len() as f32, nodes, tests)
}

#[test]
fn presets_hold_their_bytes_and_their_order() {
    let (small_bytes, _, small_tests) = measured(100, &Options::small());
    let (balanced_bytes, balanced_nodes, balanced_tests) = measured(100, &Options::balanced());
    let (fast_bytes, fast_nodes, fast_tests) = measured(100, &Options::fast());
    assert!(small_bytes < 24.0 && balanced_bytes < 45.0, "{small_bytes} {balanced_bytes}");
    assert!(small_bytes < balanced_bytes && balanced_bytes < fast_bytes);
    assert!(fast_tests < balanced_tests && balanced_tests < small_tests);
    assert!(balanced_nodes < 120.0 && balanced_tests < 40.0, "{balanced_nodes} {balanced_tests}");
    assert!(fast_nodes < 140.0 && fast_tests < 20.0, "{fast_nodes} {fast_tests}");
}

#[test]
fn work_grows_with_the_surface_and_not_with_the_number() {
    let (_, few_nodes, few_tests) = measured(30, &Options::balanced());
    let (_, many_nodes, many_tests) = measured(240, &Options::balanced());
    // 64 times as many triangles; a list would do 64 times the tests.
    assert!(many_nodes < few_nodes * 6.0, "{few_nodes} {many_nodes}");
    assert!(many_tests < few_tests * 6.0, "{few_tests} {many_tests}");
}

#[test]
fn the_surface_area_heuristic_is_better_than_none() {
    let work = |split| {
        let (_, nodes, tests) = measured(80, &Options { split, leaf_size: 2, ..Options::balanced() });
        nodes + tests
    };
    let sah = work(Split::Sah);
    assert!(sah * 1.1 < work(Split::Median), "{sah} {}", work(Split::Median));
    assert!(sah * 1.1 < work(Split::Midpoint), "{sah} {}", work(Split::Midpoint));
}
