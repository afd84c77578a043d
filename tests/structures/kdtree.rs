//! kD-trees: the words asked for suffice and the bytes allowed hold, whatever the options.

use crate::common::meshes::{crossing, hair, identical, random, separate};
use crate::common::{FAMILIES, Random, adversarial_mesh, seal::checksum};
use hitscan::{
    Arena, CompactKdTree, KdTree, Mesh, Primitives,
    error::BuildError,
    kdtree::{Options, Split},
};

fn all_options() -> impl Iterator<Item = Options> {
    let base = [Options::small(), Options::balanced(), Options::fast()];
    let splits = [Split::Midpoint, Split::Median, Split::Sah];
    base.into_iter().flat_map(move |base| {
        splits.into_iter().flat_map(move |split| [true, false].map(|clip| Options { split, clip, ..base }))
    })
}

fn build<'m, P: Primitives>(
    primitives: &P,
    memory: &'m mut [u32],
    options: &Options,
) -> Result<KdTree<'m>, BuildError> {
    KdTree::build(primitives, &mut Arena::new(memory), options)
}

#[test]
fn the_words_asked_for_always_suffice() {
    let meshes = [crossing(400), identical(1000), hair(300), random(500, 0.05), random(501, 3.0)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        for options in all_options() {
            for intersection_cost in [options.intersection_cost, 50.0] {
                let options = Options { intersection_cost, ..options };
                let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
                let tree = build(&mesh, &mut memory, &options).unwrap_or_else(|error| panic!("{error}: {options:?}"));
                let rate = triangles.len() * options.bytes_per_primitive as usize + 256;
                assert!(tree.as_words().len() * 4 <= rate, "{options:?}");
            }
        }
    }
    let mut random = Random::new(11);
    for _ in 0..3000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = Options {
            split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah]),
            leaf_size: random.below(4) as u32,
            intersection_cost: random.pick(&[0.3, 2.0, 1.0e9, f32::INFINITY, f32::NAN, -1.0]),
            byte_cost: random.pick(&[0.0, 0.2, 1.0e9, f32::INFINITY, f32::NAN, -1.0]),
            empty_bonus: random.pick(&[0.0, 0.2, 1.0, f32::NAN, -9.0]),
            max_depth: random.pick(&[None, Some(0), Some(2), Some(u32::MAX)]),
            bytes_per_primitive: random.below(400) as u32,
            clip: random.one_in(2),
            max_bytes: random.pick(&[None, None, Some(1000), Some(usize::MAX)]),
        };
        let mut memory = vec![0; KdTree::words(triangles.len(), &options)];
        match build(&mesh, &mut memory, &options) {
            Ok(tree) => assert!(KdTree::open(tree.as_words()).is_ok(), "{options:?}"),
            Err(BuildError::Budget { at_least, allowed: 1000 }) => assert!(at_least > 1000),
            Err(error) => panic!("{error}: {options:?} {vertices:?}"),
        }
    }
}

#[test]
fn trees_fit_into_their_bytes() {
    let meshes = [separate(vec![]), random(1, 1.0), random(3, 1.0), random(40, 0.3), identical(15), crossing(60)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        let one_leaf = Options { max_depth: Some(0), ..Options::balanced() };
        let mut memory = vec![0; KdTree::words(triangles.len(), &Options::fast())];
        let least = build(&mesh, &mut memory, &one_leaf).unwrap().as_words().len() * 4;
        for base in [Options::fast(), Options { split: Split::Median, ..Options::fast() }] {
            let mut best = f32::INFINITY;
            let most = build(&mesh, &mut memory, &base).unwrap().as_words().len() * 4;
            for bytes in 0..most + 50 {
                let options = base.fit(bytes);
                let words = KdTree::words(triangles.len(), &options);
                match build(&mesh, &mut memory[..words], &options) {
                    Ok(tree) => {
                        let size = tree.as_words().len() * 4;
                        assert!(size <= bytes, "{size} bytes instead of {bytes} for {}", triangles.len());
                        assert!(bytes >= least);
                        if base.split == Split::Sah {
                            let (nodes, tests) = tree.expected_work();
                            let work = nodes + tests * base.intersection_cost;
                            assert!(work <= best * 1.25, "{bytes}: {nodes} nodes, {tests} tests against {best}");
                            best = best.min(work);
                        }
                    }
                    Err(BuildError::Budget { at_least, allowed }) => {
                        assert!(bytes < least && allowed == bytes && at_least > bytes && at_least <= least, "{bytes}");
                    }
                    Err(error) => panic!("{error}: {options:?}"),
                }
            }
        }
    }
}

#[test]
fn bytes_that_are_allowed_are_used() {
    let (vertices, triangles) = random(600, 0.2);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let free = Options::fast();
    let mut memory = vec![0; KdTree::words(triangles.len(), &free.fit(1 << 20))];
    let most = build(&mesh, &mut memory, &free).unwrap().as_words().len() * 4;
    for bytes in [most * 3 / 4, most / 2, most / 4] {
        let size = build(&mesh, &mut memory, &free.fit(bytes)).unwrap().as_words().len() * 4;
        assert!(size <= bytes && size > bytes * 9 / 10, "{size} of {bytes}");
    }
}

#[test]
fn compact_cells_are_halved_as_they_always_were() {
    let (vertices, triangles) = random(300, 0.5);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let sums = [Split::Midpoint, Split::Median].map(|split| {
        let options = Options { split, ..Options::fast() };
        let mut memory = vec![0; CompactKdTree::words(triangles.len(), &options)];
        checksum(CompactKdTree::build(&mesh, &mut Arena::new(&mut memory), &options).unwrap().as_words())
    });
    assert_eq!(sums, [1_730_359_063, 1_181_372_736]);
}
