//! The compact kD-tree: answers as the list, fits its memory and bytes, refuses what it cannot walk.

use crate::common::meshes::{crossing, identical};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, seal::every_byte};
use hitscan::{
    Accelerator, Arena, CompactKdTree, KdTree, List, Mesh, Primitives, Ray, Scene, Traversal,
    accel::{Hierarchy, Inside, MAX_LEVELS, Plan, Reason, Step},
    arena::Full,
    error::BuildError,
    from_fn,
    geometry::Aabb,
    glam::Vec3,
    kdtree::{Options, Split},
};

fn options(random: &mut Random) -> Options {
    let preset = random.pick(&[Options::small(), Options::balanced(), Options::fast()]);
    Options {
        split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah, Split::Sah]),
        leaf_size: random.pick(&[1, 1, 2, 4]),
        max_depth: random.pick(&[None, None, Some(3), Some(40)]),
        intersection_cost: random.pick(&[preset.intersection_cost, 2.0, 20.0]),
        byte_cost: random.pick(&[preset.byte_cost, 0.0]),
        clip: !random.one_in(4),
        max_bytes: random.pick(&[None, None, Some(300)]),
        ..preset
    }
}

fn build<'m, P: Primitives>(
    primitives: &P,
    memory: &'m mut [u32],
    options: &Options,
) -> Result<CompactKdTree<'m>, BuildError> {
    CompactKdTree::build(primitives, &mut Arena::new(memory), options)
}

#[test]
fn compact_trees_answer_as_the_list() {
    let mut random = Random::new(41);
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut hits, mut nodes, mut scenes) = (0, 0, 0, 0);
    while cast < crate::rays() {
        let family = random.below(FAMILIES);
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let number = random.pick(&[0, 0, 12]);
        let mut boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let mut corners: Vec<Vec3> =
            boxes.iter().flat_map(|b| [b.min, b.max, b.center()]).chain(vertices.iter().copied()).collect();
        let (small, fast) = random.pick(&[(1.0, 1.0), (1.0, 1.0), (2.0_f32.powi(-60), 2.0_f32.powi(85))]);
        vertices.iter_mut().chain(&mut corners).for_each(|v| *v *= small);
        boxes.iter_mut().for_each(|b| *b = Aabb::new(b.min * small, b.max * small));
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i, ray)));
        let both = (mesh, others);
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let options = options(&mut random);
        let tree = match build(&both, &mut memory, &options) {
            Ok(tree) => tree,
            Err(BuildError::Budget { .. }) => continue,
            Err(error) => panic!("{error}: {options:?}"),
        };
        scenes += 1;
        nodes += tree.node_words();
        let tree = Scene::new(CompactKdTree::open(tree.as_words()).unwrap(), &both).unwrap();
        for _ in 0..240 {
            let mut ray = adversarial_ray(&mut random, family, &corners);
            ray.direction *= fast;
            if random.one_in(4)
                && let Some(hit) = list.closest_hit(&ray)
            {
                ray.t_min = hit.t;
            }
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(tree.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?} {boxes:?}");
            assert_eq!(tree.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?} {boxes:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(nodes > scenes * 10, "{nodes} words in {scenes} scenes");
}

#[test]
fn a_walk_goes_on_where_it_paused() {
    let mut random = Random::new(42);
    let mut memory = vec![0; 1 << 16];
    for _ in 0..300 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let tree = build(&mesh, &mut memory, &Options::fast()).unwrap();
        for _ in 0..20 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let Some(ray) = ray.prepare() else { continue };
            let mut whole = tree.traverse(&ray);
            let expected: Vec<Vec<u32>> =
                std::iter::from_fn(|| whole.next_leaf(&ray, ray.ray().t_max)).map(Iterator::collect).collect();
            let (mut walk, mut leaves, mut steps) = (tree.traverse(&ray), vec![], 0);
            loop {
                let mut budget = random.below(3) as u32;
                match walk.step(&ray, ray.ray().t_max, &mut budget) {
                    Step::Leaf(leaf) => leaves.push(leaf.collect::<Vec<u32>>()),
                    Step::Paused => steps += 1,
                    Step::Done => break,
                }
                assert!(steps < 10_000);
            }
            assert_eq!(leaves, expected);
        }
    }
}

/// The primitives below a cell, and that they lie in it as far as they are there.
fn gather(tree: &CompactKdTree, found: &mut [bool]) -> usize {
    let mut stack: Vec<_> = tree.root().map(|cell| (cell, 1)).into_iter().collect();
    let mut deepest = 0;
    while let Some((cell, level)) = stack.pop() {
        deepest = deepest.max(level);
        match Hierarchy::open(tree, &cell) {
            Inside::Cells(cells) => stack.extend(cells.into_iter().flatten().map(|cell| (cell, level + 1))),
            Inside::Leaf(leaf) => leaf.for_each(|i| found[i as usize] = true),
        }
    }
    deepest
}

#[test]
fn the_hierarchy_names_every_primitive() {
    let mut random = Random::new(43);
    let mut memory = vec![0; 1 << 16];
    for _ in 0..500 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = options(&mut random);
        let Ok(tree) = build(&mesh, &mut memory, &options) else { continue };
        let mut found = vec![false; triangles.len()];
        assert!(gather(&tree, &mut found) <= MAX_LEVELS);
        // A tree of clipped parts may leave out what has none.
        assert!(options.clip || found.iter().all(|&found| found));
    }
}

fn soup(count: usize, size: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut random = Random::new(count as u64);
    let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
    let vertices = (0..count).flat_map(|_| [point(2.0); 3].map(|v| v + point(size))).collect();
    (vertices, (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Triangles at 2^-i: most of them are smaller than a step of the lattice.
fn shrinking(count: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners = |i: usize| [Vec3::X, Vec3::Y, Vec3::Z].map(|v| (Vec3::ONE + v * 0.5) * 0.5_f32.powi(i as i32 % 120));
    ((0..count).flat_map(corners).collect(), (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

#[test]
fn every_arena_is_large_enough_or_refused() {
    let nothing = (vec![], vec![]);
    for (vertices, triangles) in [nothing, soup(1, 1.0), soup(2, 1.0), soup(40, 0.5), identical(300), crossing(30)] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for options in [Options::small(), Options::fast(), Options::fast().fit(700)] {
            let enough = CompactKdTree::words(triangles.len(), &options);
            let mut large = vec![0; enough];
            let expected = build(&mesh, &mut large, &options).expect("`words` suffice").as_words().to_vec();
            let mut memory = vec![7; enough];
            let mut promised = 0;
            let first = (0..=enough)
                .find(|&k| {
                    let mut arena = Arena::new(&mut memory[..k]);
                    match CompactKdTree::build(&mesh, &mut arena, &options) {
                        Ok(tree) => {
                            assert_eq!(tree.as_words(), expected);
                            assert_eq!(arena.available(), k - expected.len());
                            true
                        }
                        Err(BuildError::Full(Full { at_least, available })) => {
                            assert!(available == k && at_least > k && arena.available() == k);
                            promised = promised.max(at_least);
                            false
                        }
                        Err(error) => panic!("{error}"),
                    }
                })
                .unwrap();
            assert!(promised <= first, "{promised} {first}");
        }
    }
}

#[test]
fn the_words_asked_for_and_the_bytes_allowed_always_suffice() {
    let mut random = Random::new(44);
    let meshes = [crossing(400), identical(1000), soup(500, 0.05), soup(501, 3.0), shrinking(300)];
    for (vertices, triangles) in meshes.into_iter().chain((0..2000).map(|_| {
        let family = random.below(FAMILIES);
        adversarial_mesh(&mut random, family, 60)
    })) {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let mut random = Random::new(vertices.len() as u64);
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
        let mut memory = vec![0; CompactKdTree::words(triangles.len(), &options)];
        match build(&mesh, &mut memory, &options) {
            Ok(tree) => {
                assert!(CompactKdTree::open(tree.as_words()).is_ok(), "{options:?}");
                let bytes = tree.as_words().len() * 4;
                let rate = triangles.len() * options.bytes_per_primitive.max(2) as usize + 256;
                assert!(bytes <= rate && bytes <= options.max_bytes.unwrap_or(rate), "{bytes} {options:?}");
            }
            Err(BuildError::Budget { at_least, allowed: 1000 }) => assert!(at_least > 1000),
            Err(error) => panic!("{error}: {options:?} {vertices:?}"),
        }
    }
}

/// Boxes in a row: sparse ones make a tree whose subtrees are too long for 16 bits.
fn row(count: u32) -> impl Primitives {
    let boxes = |i: u32| {
        let corner = Vec3::new((i % 300) as f32, (i / 300 % 300) as f32, (i / 90_000) as f32);
        Aabb::new(corner, corner + 0.5)
    };
    from_fn(count, boxes, |i, _| Some(i as f32))
}

#[test]
fn trees_of_any_size_keep_their_links() {
    // Past 65,536 primitives references are wide; past 65,535 words links are long.
    for count in [20_000, 65_536, 65_537, 200_000] {
        let shapes = row(count);
        let options = Options { byte_cost: 0.0, ..Options::fast() };
        let mut memory = vec![0; CompactKdTree::words(count as usize, &options)];
        let tree = build(&shapes, &mut memory, &options).unwrap();
        let mut found = vec![false; count as usize];
        gather(&CompactKdTree::open(tree.as_words()).unwrap(), &mut found);
        assert!(found.iter().all(|&found| found));
        assert!(tree.node_words() > count as usize && tree.reference_count() < count as usize / 4);
        let scene = Scene::new(tree, &shapes).unwrap();
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        for (y, z) in [(0.2, 0.2), (250.2, 0.2), (17.3, 1.4)] {
            for (origin, direction) in [(Vec3::new(-1.0, y, z), Vec3::X), (Vec3::new(301.0, y, z), Vec3::NEG_X)] {
                let ray = Ray::new(origin, direction);
                assert_eq!(scene.closest_hit(&ray), list.closest_hit(&ray));
                assert_eq!(scene.hits(&ray).last(), list.hits(&ray).last());
            }
        }
    }
}

#[test]
fn large_leaves_spill_their_counts() {
    for count in [254, 255, 256, 70_000] {
        let (vertices, triangles) = identical(count);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let mut memory = vec![0; CompactKdTree::words(count, &Options::small())];
        let tree = build(&mesh, &mut memory, &Options::small()).unwrap();
        assert_eq!(tree.reference_count(), count);
        let mut found = vec![false; count];
        gather(&CompactKdTree::open(tree.as_words()).unwrap(), &mut found);
        assert!(found.iter().all(|&found| found));
        let scene = Scene::new(tree, &mesh).unwrap();
        assert_eq!(scene.closest_hit(&Ray::new(Vec3::Z * 9.0, Vec3::NEG_Z)).unwrap().primitive, 0);
        assert_eq!(scene.hits(&Ray::new(Vec3::Z * 9.0, Vec3::NEG_Z)).count(), count);
    }
}

/// Opens words and walks them: the walk must end within the nodes.
fn exercise(words: &[u32]) -> Result<(), Reason> {
    let tree = CompactKdTree::open(words).map_err(|error| error.reason)?;
    let mut random = Random::new(9);
    for _ in 0..4 {
        let ray = Ray::new(crate::common::point(&mut random, 2), crate::common::point(&mut random, 2));
        let Some(ray) = ray.prepare() else { continue };
        let (mut walk, mut budget) = (tree.traverse(&ray), tree.node_words() as u32);
        loop {
            match walk.step(&ray, ray.ray().t_max, &mut budget) {
                Step::Leaf(leaf) => leaf.for_each(|i| assert!(i < tree.primitives())),
                Step::Paused => panic!("the walk visits a node twice"),
                Step::Done => break,
            }
        }
    }
    let mut found = vec![false; tree.primitives() as usize];
    assert!(gather(&tree, &mut found) <= MAX_LEVELS);
    Ok(())
}

fn built(seed: u64, most: usize, options: &Options) -> Vec<u32> {
    let (vertices, triangles) = adversarial_mesh(&mut Random::new(seed), 2, most);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut memory = vec![0; CompactKdTree::words(triangles.len(), options)];
    build(&mesh, &mut memory, options).unwrap().as_words().to_vec()
}

#[test]
fn truncations_and_extensions_are_refused() {
    let words = built(1, 30, &Options::fast());
    assert_eq!(exercise(&words), Ok(()));
    for length in 0..words.len() {
        assert!(exercise(&words[..length]).is_err(), "{length}");
    }
    let mut longer = words;
    longer.push(0);
    assert_eq!(exercise(&longer), Err(Reason::Length));
}

#[test]
fn every_byte_set_to_every_value_is_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for seed in 0..6 {
        let words = built(seed, 10, &Options { leaf_size: 1 + seed as u32 % 3, ..Options::fast() });
        for damaged in every_byte(&words) {
            // A damaged count of primitives is only a number: nothing is that many.
            if damaged[2] > 1 << 20 {
                continue;
            }
            *(if exercise(&damaged).is_ok() { &mut harmless } else { &mut refused }) += 1;
        }
    }
    assert!(refused > 10_000 && harmless > 10_000, "{refused} {harmless}");
}

#[test]
fn structured_lies_are_refused() {
    let words = built(2, 40, &Options::fast());
    let tree = CompactKdTree::open(&words).unwrap();
    assert!(tree.node_words() > 8 && tree.depth() > 2);
    let with = |changes: &[(usize, u32)]| {
        let mut words = words.clone();
        changes.iter().for_each(|&(index, word)| words[index] = word);
        CompactKdTree::open(&words).map(|_| ()).map_err(|error| error.reason)
    };
    // The first inner node with two children.
    let root = (10..10 + tree.node_words()).find(|&i| words[i] & 3 != 3 && words[i] >> 16 > 1).unwrap();
    let link = words[root] >> 16;
    for lie in [0, 1, link - 1, link + 1, tree.node_words() as u32, 65_534, 65_535] {
        assert!(with(&[(root, words[root] & 0xffff | lie << 16)]).is_err(), "{lie} instead of {link}");
    }
    assert_eq!(with(&[(3, tree.depth() - 1)]), Err(Reason::Depth));
    assert_eq!(with(&[(3, 33)]), Err(Reason::Depth));
    assert_eq!(with(&[(4, f32::NAN.to_bits())]), Err(Reason::Bounds));
    assert_eq!(with(&[(4, words[7]), (7, words[4])]), Err(Reason::Bounds));
    assert_eq!(with(&[(0, words[0] + 1)]), Err(Reason::Length));
    assert_eq!(with(&[(1, words[1] + 2)]), Err(Reason::Length));
    assert_eq!(with(&[(2, 1)]), Err(Reason::Primitive));
    assert!(KdTree::open(&words).is_err());
}

#[cfg(feature = "alloc")]
#[test]
fn what_is_baked_is_read_back() {
    use hitscan::{asset::Asset, bake};
    let (vertices, triangles) = soup(60, 0.5);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let words = bake::build(&mesh, &Plan::CompactKdTree(Options::small())).unwrap();
    let tree = CompactKdTree::open(&words).unwrap();
    let asset = bake::Baker::new().mesh(&mesh).structure(tree).finish();
    let asset = Asset::from_words(&asset).unwrap();
    let scene: Scene<CompactKdTree, Mesh> = asset.scene().unwrap();
    assert_eq!(scene.accelerator().as_words(), words);
    assert!(asset.scene::<KdTree, Mesh>().is_err());
}

#[test]
fn nothing_can_be_built_and_missed() {
    let nothing = Mesh::new(&[], &[[0_u16; 3]; 0]).unwrap();
    let mut memory = vec![0; CompactKdTree::words(0, &Options::fast())];
    let tree = build(&nothing, &mut memory, &Options::fast()).unwrap();
    let scene = Scene::new(CompactKdTree::open(tree.as_words()).unwrap(), &nothing).unwrap();
    assert!(scene.closest_hit(&Ray::new(Vec3::ZERO, Vec3::Z)).is_none());
}

#[test]
fn compact_trees_are_worth_their_bytes() {
    let (vertices, triangles) = soup(4000, 0.08);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut memory = vec![0; CompactKdTree::words(4000, &Options::fast())];
    let mut work = |options: &Options| {
        let tree = build(&mesh, &mut memory, options).unwrap();
        let mut random = Random::new(45);
        let (mut nodes, mut tests) = (0, 0);
        for _ in 0..500 {
            let mut point = || Vec3::from_array([0; 3].map(|_| random.unit() * 2.0 - 1.0));
            let ray = Ray::new(point(), point()).prepare().unwrap();
            let (mut walk, mut budget) = (tree.traverse(&ray), u32::MAX);
            while let Step::Leaf(leaf) = walk.step(&ray, f32::MAX, &mut budget) {
                tests += leaf.count();
            }
            nodes += u32::MAX - budget;
        }
        (tree.as_words().len(), nodes / 500, tests / 500)
    };
    let (bytes, nodes, tests) = work(&Options::balanced());
    let plain = Options { split: Split::Median, leaf_size: 4, ..Options::balanced() };
    let (_, median_nodes, median_tests) = work(&plain);
    assert!(bytes < 4000 * 10, "{bytes} words");
    assert!(nodes < 250 && tests < 120, "{nodes} nodes, {tests} tests");
    assert!(nodes as usize + tests < (median_nodes as usize + median_tests) * 9 / 10, "{median_nodes} {median_tests}");
}
