//! The dual-split tree: exact, bounded, checked when opened, and worth its bytes.

use crate::common::meshes::{separate, sheet};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, seal::every_byte};
use hitscan::{
    Accelerator, Arena, DualSplit, Hit, List, Mesh, Primitives, Ray, Scene, Span, Traversal,
    accel::{Hierarchy, Inside, MAX_LEVELS, Reason, Step},
    arena::Full,
    dualsplit::{MAX_DEPTH, Method, Options},
    from_fn,
    geometry::Aabb,
    glam::Vec3,
};

fn options(random: &mut Random) -> Options {
    let preset = random.pick(&[Options::small(), Options::balanced(), Options::fast()]);
    Options {
        method: random.pick(&[Method::Thorough, Method::Quick]),
        leaf_size: random.pick(&[0, 1, 1, 2, 4, 15, 99]),
        intersection_cost: random.pick(&[preset.intersection_cost, 2.0, 1.0e9, 0.0, f32::NAN, f32::INFINITY, -1.0]),
        carve_threshold: random.pick(&[preset.carve_threshold, 1.0, 0.0, f32::INFINITY, f32::NAN, -1.0]),
    }
}

fn build<'m, P: Primitives>(primitives: &P, memory: &'m mut [u32], options: &Options) -> DualSplit<'m> {
    DualSplit::build(primitives, &mut Arena::new(memory), options).unwrap()
}

/// The closest hit by a walk that pauses every few nodes; how many it visited.
fn paused<P: Primitives>(tree: &DualSplit, primitives: &P, ray: &Ray, share: u32) -> (Option<Hit>, usize) {
    let Some(ray) = &ray.prepare() else { return (None, 0) };
    let mut walk = tree.traverse(ray);
    let mut best = Hit { t: ray.ray().t_max, primitive: u32::MAX };
    let (mut found, mut visited) = (None, 0);
    let from = Hit { t: ray.ray().t_min, primitive: 0 };
    loop {
        let mut budget = share;
        let step = walk.step(ray, best.t, &mut budget);
        visited += (share - budget) as usize;
        match step {
            Step::Leaf(leaf) => {
                for index in leaf {
                    if let Some(hit) = primitives.intersect(index, ray, &Span::new(from, best)) {
                        best = hit;
                        found = Some(hit);
                    }
                }
            }
            Step::Paused => assert_eq!(budget, 0),
            Step::Done => return (found, visited),
        }
    }
}

#[test]
fn dual_split_trees_answer_as_the_list() {
    let mut random = Random::new(1);
    let (mut memory, mut other) =
        (vec![0; DualSplit::words(100, &Options::balanced())], vec![0; DualSplit::words(100, &Options::balanced())]);
    let (mut cast, mut hits, mut nodes, mut scenes) = (0, 0, 0, 0);
    while cast < crate::rays() {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        // Half of the scenes hold boxes that answer with noise, too.
        let number = random.pick(&[0, 24]);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let first = mesh.len();
        let others = from_fn(number, |i| boxes[i as usize], |i, ray| Some(noise(i + first, ray)));
        let both = (mesh, others);
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let options = options(&mut random);
        let tree = build(&both, &mut memory, &options);
        let tree = DualSplit::open(tree.as_words()).unwrap();
        scenes += 1;
        nodes += tree.as_words().len();

        // The same triangles in the order of the leaves.
        let sorted: Vec<[u32; 3]> = tree.order().filter_map(|i| triangles.get(i as usize).copied()).collect();
        let sorted = Mesh::new(&vertices, &sorted[..]).unwrap();
        let ordered = (number == 0).then(|| tree.ordered(&mut Arena::new(&mut other)).unwrap());
        let ordered_list = Scene::new(List::new(&sorted).unwrap(), &sorted).unwrap();

        let scene = Scene::new(tree, &both).unwrap();
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {boxes:?} {vertices:?}");
            assert_eq!(scene.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?}");
            if let Some(ordered) = &ordered {
                let (got, visited) = paused(ordered, &sorted, &ray, 1 + cast as u32 % 3);
                assert_eq!(bits(got), bits(ordered_list.closest_hit(&ray)), "{ray:?} {options:?} {vertices:?}");
                assert!(visited <= ordered.as_words().len());
            }
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(nodes > scenes * 30, "{nodes} words in {scenes} scenes");
}

#[test]
fn all_hits_come_in_order() {
    let mut random = Random::new(6);
    let mut memory = vec![0; DualSplit::words(40, &Options::balanced())];
    for _ in 0..300 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let scene = Scene::new(build(&mesh, &mut memory, &Options::fast()), &mesh).unwrap();
        for _ in 0..40 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            assert!(scene.hits(&ray).eq(list.hits(&ray)), "{ray:?} {vertices:?}");
        }
    }
}

#[test]
fn ordering_takes_the_words_of_the_ordered_tree() {
    let words = some_words(5, 40, 2);
    let tree = DualSplit::open(&words).unwrap();
    let most = tree.ordered_words().count();
    for k in 0..most {
        let mut memory = vec![0; k];
        let refused = tree.ordered(&mut Arena::new(&mut memory)).map(|tree| tree.depth());
        assert_eq!(refused, Err(Full { at_least: most, available: k }));
    }
}

#[test]
fn the_quick_builder_takes_a_kilobyte_beside_the_tree() {
    let mut random = Random::new(8);
    for most in [30, 300, 3000] {
        for family in 0..FAMILIES {
            let (vertices, triangles) = adversarial_mesh(&mut random, family, most);
            let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
            let mut memory = vec![0; DualSplit::words(triangles.len(), &Options::quick())];
            let words = build(&mesh, &mut memory, &Options::quick()).as_words().to_vec();
            // Beside a tree so small that codes take more, a little more.
            let mut memory = vec![0; words.len().max(triangles.len() * 9 / 8) + 256];
            assert_eq!(build(&mesh, &mut memory, &Options::quick()).as_words(), words);
        }
    }
    const { assert!(DualSplit::words(1000, &Options::quick()) < 1850) };
    const { assert!(DualSplit::words(1000, &Options::balanced()) < 5000) };
}

/// Every primitive once, within its cell, and no cell deeper than allowed.
fn check_cells<P: Primitives>(tree: &DualSplit, primitives: &P) {
    let mut seen = vec![0; primitives.len() as usize];
    let mut stack: Vec<_> = tree.root().into_iter().map(|cell| (cell, 0)).collect();
    while let Some((cell, depth)) = stack.pop() {
        assert!(depth <= tree.depth() as usize && depth < MAX_LEVELS);
        match tree.open(&cell) {
            Inside::Cells(cells) => stack.extend(cells.into_iter().flatten().map(|cell| (cell, depth + 1))),
            Inside::Leaf(leaf) => {
                for index in leaf {
                    seen[index as usize] += 1;
                    let bounds = primitives.bounds(index);
                    assert!(cell.bounds.union(&bounds) == cell.bounds, "{bounds:?} in {:?}", cell.bounds);
                }
            }
        }
    }
    assert!(seen.iter().all(|&count| count == 1));
    let mut order: Vec<u32> = tree.order().collect();
    assert_eq!(order.len(), seen.len());
    order.sort_unstable();
    assert!(order.into_iter().eq(0..primitives.len()));
}

#[test]
fn adversaries_stay_bounded() {
    let mut random = Random::new(2);
    let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
    let identical = [Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, -2.0, 1.0), Vec3::new(0.0, 2.0, 0.5)].repeat(65_537);
    let through_one_point = (0..20_000).map(|_| [point(2.0), point(2.0)]).flat_map(|[a, b]| [a, b, -a - b]).collect();
    let series = (0..6000).flat_map(|i| {
        let x = 2.0_f32.powi(-(i % 120));
        [Vec3::new(x, 0.0, 0.0), Vec3::new(x, x, i as f32), Vec3::new(x * 0.5, x, x)]
    });
    let on_a_line = (0..9000).map(|i| Vec3::splat(i as f32 * 0.5)).collect();
    let needles = (0..20_000).flat_map(|i| {
        let a = point(1.0);
        [a, a + Vec3::X * 1.0e30 * (i % 2) as f32, a + Vec3::Y * 1.0e-30]
    });
    for vertices in [identical, through_one_point, series.collect(), on_a_line, needles.collect()] {
        let (vertices, triangles) = separate(vertices);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let finest = Options { leaf_size: 1, carve_threshold: 0.0, ..Options::fast() };
        for options in [Options::small(), finest, Options::quick(), Options { method: Method::Quick, ..finest }] {
            let mut memory = vec![0; DualSplit::words(triangles.len(), &Options::balanced())];
            let tree = build(&mesh, &mut memory, &options);
            assert!(tree.depth() as usize <= MAX_DEPTH);
            assert!(tree.as_words().len() * 4 <= triangles.len() * 17 + 1000);
            check_cells(&DualSplit::open(tree.as_words()).unwrap(), &mesh);
        }
    }
}

#[test]
fn cells_hold_their_primitives() {
    let mut random = Random::new(4);
    let mut memory = vec![0; DualSplit::words(300, &Options::balanced())];
    for _ in 0..2000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 300);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = options(&mut random);
        check_cells(&build(&mesh, &mut memory, &options), &mesh);
    }
}

/// Opens words, and if they open, walks them: the walk must end within the nodes.
fn exercise(words: &[u32]) -> Result<(), Reason> {
    let tree = DualSplit::open(words).map_err(|error| error.reason)?;
    let mut random = Random::new(9);
    let all = from_fn(tree.primitives(), |_| Aabb::EMPTY, |_, _| None);
    for _ in 0..4 {
        let ray = Ray::new(crate::common::point(&mut random, 2), crate::common::point(&mut random, 2));
        let (_, visited) = paused(&tree, &all, &ray, 7);
        assert!(visited <= words.len(), "the walk visits a node twice");
    }
    let mut cells: Vec<_> = tree.root().into_iter().collect();
    while let Some(cell) = cells.pop() {
        match tree.open(&cell) {
            Inside::Cells(inside) => cells.extend(inside.into_iter().flatten()),
            Inside::Leaf(leaf) => leaf.for_each(|index| assert!(index < tree.primitives())),
        }
    }
    Ok(())
}

fn some_words(seed: u64, most: usize, leaf_size: u32) -> Vec<u32> {
    let (vertices, triangles) = adversarial_mesh(&mut Random::new(seed), 2, most);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let options = Options { leaf_size, carve_threshold: 1.0, ..Options::fast() };
    build(&mesh, &mut vec![0; DualSplit::words(most, &Options::balanced())], &options).as_words().to_vec()
}

#[test]
fn truncations_and_extensions_are_refused() {
    for words in [some_words(1, 30, 2), some_words(2, 30, 1)] {
        assert_eq!(exercise(&words), Ok(()));
        for length in 0..words.len() {
            assert!(DualSplit::open(&words[..length]).is_err(), "{length}");
            // Even if the header was made to fit.
            for count in 0..words.len() as u32 {
                let mut shorter = words[..length].to_vec();
                if let Some(word) = shorter.first_mut() {
                    *word = count;
                }
                assert!(exercise(&shorter).is_err(), "{length}");
            }
        }
        let longer: Vec<u32> = words.iter().copied().chain([0]).collect();
        assert_eq!(exercise(&longer), Err(Reason::Length));
    }
}

#[test]
fn every_byte_set_to_every_value_is_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for seed in 0..6 {
        let words = some_words(seed, 12, 1 + seed as u32 % 3);
        for damaged in every_byte(&words) {
            match exercise(&damaged) {
                Ok(()) => harmless += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 10_000 && harmless > 10_000, "{refused} {harmless}");
}

#[test]
fn structured_lies_are_refused() {
    let words = some_words(4, 60, 2);
    let tree = DualSplit::open(&words).unwrap();
    let reason = |change: &dyn Fn(&mut Vec<u32>)| {
        let mut words = words.clone();
        change(&mut words);
        exercise(&words)
    };
    assert_eq!(reason(&|_| {}), Ok(()));
    assert!(tree.depth() > 2 && !tree.is_ordered());
    // The first split; carves may stand before it.
    let split = (10..).step_by(2).find(|&at| words[at] & 4 == 0).unwrap();
    assert!(words[split] & 3 < 3);
    let right = words[split] >> 4;
    for number in [0, 1, right - 1, right + 1, words[0], (1 << 28) - 1] {
        assert_eq!(reason(&|words| words[split] = words[split] & 15 | number << 4), Err(Reason::Link), "{number}");
    }
    // The first leaf.
    let leaf = (10..).find(|&at| words[at] & 3 == 3 && words[at] >> 6 == 0 && DualSplit::open(&words).is_ok()).unwrap();
    assert!(reason(&|words| words[leaf] += 1 << 6).is_err());
    assert_eq!(reason(&|words| words[2] = tree.depth() - 1), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[2] = 33), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[3] = 2), Err(Reason::Header));
    assert_eq!(reason(&|words| words[3] = 0), Err(Reason::Length));
    assert_eq!(reason(&|words| words[4] = f32::NAN.to_bits()), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words.swap(4, 7)), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words[0] += 1), Err(Reason::Length));
    assert_eq!(reason(&|words| words[1] += 2), Err(Reason::Length));
    assert_eq!(reason(&|words| *words.last_mut().unwrap() = u32::MAX), Err(Reason::Primitive));
}

/// Bytes per triangle in the ordered form, and nodes and tests per ray from above and along the sheet.
fn measured(side: u32, options: &Options) -> (f32, f32, f32) {
    let (vertices, triangles) = sheet(side);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut memory = vec![0; DualSplit::words(triangles.len(), &Options::balanced())];
    let tree = build(&mesh, &mut memory, options);
    let bytes = tree.ordered_words().count() as f32 * 4.0 / triangles.len() as f32;
    let mut random = Random::new(7);
    let (mut nodes, mut tests) = (0, 0_usize);
    let counted = from_fn(mesh.len(), |i| mesh.bounds(i), |_, _| None);
    for _ in 0..2000 {
        let mut target = |y: f32| Vec3::new(random.unit() * side as f32, y, random.unit() * side as f32);
        let ray = Ray::between(target(5.0), target(-1.0));
        let prepared = ray.prepare().unwrap();
        let mut walk = tree.traverse(&prepared);
        while let Some(leaf) = walk.next_leaf(&prepared, 1.0) {
            tests += leaf.count();
        }
        nodes += paused(&tree, &counted, &ray, u32::MAX).1;
    }
    (bytes, nodes as f32 / 2000.0, tests as f32 / 2000.0)
}

#[test]
fn presets_hold_their_bytes_and_their_order() {
    let (small_bytes, small_nodes, small_tests) = measured(100, &Options::small());
    let (balanced_bytes, balanced_nodes, balanced_tests) = measured(100, &Options::balanced());
    let (fast_bytes, fast_nodes, fast_tests) = measured(100, &Options::fast());
    let found = [small_bytes, small_nodes, small_tests, balanced_bytes, balanced_nodes, balanced_tests, fast_bytes];
    assert!(small_bytes < balanced_bytes && balanced_bytes <= fast_bytes, "{found:?} {fast_nodes} {fast_tests}");
    assert!(balanced_tests < small_tests && fast_tests < small_tests, "{found:?} {fast_nodes} {fast_tests}");
    assert!(small_bytes < 4.5 && balanced_bytes < 7.0 && fast_bytes < 9.0, "{found:?} {fast_nodes} {fast_tests}");
    assert!(balanced_nodes < 110.0 && balanced_tests < 45.0, "{found:?} {fast_nodes} {fast_tests}");
}

#[test]
fn work_grows_with_the_length_and_not_with_the_number() {
    let (_, few_nodes, few_tests) = measured(30, &Options::balanced());
    let (_, many_nodes, many_tests) = measured(240, &Options::balanced());
    // 64 times as many triangles; a list would do 64 times the tests.
    assert!(
        many_nodes < few_nodes * 10.0 && many_tests < few_tests * 10.0,
        "{few_nodes} {many_nodes} {few_tests} {many_tests}"
    );
}

#[test]
fn the_quick_builder_makes_nearly_as_good_a_tree() {
    let (bytes, nodes, tests) = measured(100, &Options::balanced());
    let (quick_bytes, quick_nodes, quick_tests) = measured(100, &Options::quick());
    assert!(quick_bytes < bytes * 1.1, "{bytes} {quick_bytes}");
    assert!(quick_nodes + quick_tests < (nodes + tests) * 1.25, "{nodes} {quick_nodes} {tests} {quick_tests}");
}

#[test]
fn building_gives_the_same_words_everywhere() {
    let (vertices, triangles) = sheet(20);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut memory = vec![0; DualSplit::words(triangles.len(), &Options::balanced())];
    // Changes when the format or the preset does.
    for (options, expected) in [(Options::balanced(), 216_787_549), (Options::quick(), 4_054_135_870)] {
        let words = build(&mesh, &mut memory, &options).as_words();
        let step = |sum: u32, word: &u32| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(13);
        assert_eq!(words.iter().fold(0x811c_9dc5, step), expected, "{options:?}");
    }
}
