//! Bounding volume hierarchies: equal to the list, before and after their primitives move; memory; open; quality.

use crate::common::meshes::{crossing, identical, separate, sheet};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, point, seal::every_byte};
use hitscan::{
    Accelerator, Arena, Bvh, Error, List, Mesh, Primitives, Ray, Scene, Traversal,
    accel::{Hierarchy, Inside, Reason, Step},
    arena::Full,
    bvh::{Method, Options},
    error::BuildError,
    from_fn,
    geometry::Aabb,
    glam::Vec3,
    query::Progress,
};

const METHODS: [Method; 2] = [Method::Sah, Method::Ploc];

fn options(random: &mut Random) -> Options {
    let preset = random.pick(&[Options::small(), Options::balanced(), Options::fast()]);
    Options {
        method: random.pick(&METHODS),
        leaf_size: random.pick(&[1, 1, 2, preset.leaf_size, 15]),
        intersection_cost: random.pick(&[preset.intersection_cost, 2.0, 20.0]),
        reinsertions: random.below(4) as u32,
        bytes_per_primitive: random.pick(&[preset.bytes_per_primitive, 99.0]),
        max_bytes: None,
    }
}

fn all_options() -> impl Iterator<Item = Options> {
    let presets = [Options::small(), Options::balanced(), Options::fast()];
    presets.into_iter().flat_map(|preset| METHODS.map(|method| Options { method, ..preset }))
}

fn built<P: Primitives>(primitives: &P, options: &Options) -> Vec<u32> {
    let mut memory = vec![0; Bvh::words(primitives.len() as usize, options)];
    let used = Bvh::build(primitives, &mut Arena::new(&mut memory), options).unwrap().as_words().len();
    memory.truncate(used);
    memory
}

/// Triangles, and boxes that answer whatever they like.
fn mixed<'a>(mesh: Mesh<'a>, boxes: &'a [Aabb]) -> impl Primitives + 'a {
    let first = mesh.len();
    (mesh, from_fn(boxes.len() as u32, |i| boxes[i as usize], move |i, ray| Some(noise(i + first, ray))))
}

#[test]
fn hierarchies_answer_as_the_list() {
    let mut random = Random::new(1);
    let (mut cast, mut hits, mut pairs, mut scenes) = (0, 0, 0, 0);
    while cast < crate::rays() {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let number = random.pick(&[0, 0, 9]);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let shapes = mixed(Mesh::new(&vertices, &triangles[..]).unwrap(), &boxes);
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        let options = options(&mut random);
        let words = built(&shapes, &options);
        let tree = Scene::new(Bvh::open(&words).unwrap(), &shapes).unwrap();
        pairs += tree.accelerator().pair_count();
        scenes += 1;
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(tree.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?}");
            assert_eq!(tree.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(pairs > scenes * 8, "{pairs} pairs in {scenes} scenes");
}

#[test]
fn ordered_hierarchies_answer_as_the_list_in_their_order() {
    let mut random = Random::new(2);
    for _ in 0..crate::rays() / 4000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let words = built(&Mesh::new(&vertices, &triangles[..]).unwrap(), &options(&mut random));
        let bvh = Bvh::open(&words).unwrap();
        let sorted: Vec<[u32; 3]> = bvh.order().map(|number| triangles[number as usize]).collect();
        let ordered = Bvh::open(bvh.ordered().as_words()).unwrap();
        assert!(ordered.is_ordered() && !bvh.is_ordered() && ordered.order().eq(0..triangles.len() as u32));
        assert_eq!(bvh.as_words().len() - ordered.as_words().len(), triangles.len().div_ceil(2));
        let mesh = Mesh::new(&vertices, &sorted[..]).unwrap();
        let (list, tree) = (Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap(), Scene::new(ordered, &mesh).unwrap());
        for _ in 0..100 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            assert_eq!(bits(tree.closest_hit(&ray)), bits(list.closest_hit(&ray)), "{ray:?} {vertices:?}");
        }
    }
}

#[test]
fn a_walk_can_pause_anywhere() {
    let mut random = Random::new(3);
    for _ in 0..300 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let words = built(&mesh, &options(&mut random));
        let bvh = Bvh::open(&words).unwrap();
        let scene = Scene::new(bvh, &mesh).unwrap();
        for _ in 0..30 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let mut query = scene.begin(&ray);
            let mut steps = 0;
            let found = loop {
                if let Progress::Done(hit) = query.advance(1) {
                    break hit;
                }
                steps += 1;
                assert!(steps <= bvh.pair_count(), "a pair is visited twice");
            };
            assert_eq!(bits(found), bits(scene.closest_hit(&ray)));
            // The leaves are those of a walk that does not pause.
            let Some(ray) = ray.prepare() else { continue };
            let (mut whole, mut paused) = (bvh.traverse(&ray), bvh.traverse(&ray));
            let mut slowly = || loop {
                match paused.step(&ray, ray.ray().t_max, &mut random.below(3).try_into().unwrap()) {
                    Step::Leaf(leaf) => break Some(leaf),
                    Step::Paused => {}
                    Step::Done => break None,
                }
            };
            loop {
                let (a, b) = (whole.next_leaf(&ray, ray.ray().t_max), slowly());
                assert!(a.into_iter().flatten().eq(b.into_iter().flatten()));
                if a.is_none() && b.is_none() {
                    break;
                }
            }
        }
    }
}

#[test]
fn a_refitted_hierarchy_answers_as_the_list_of_what_moved() {
    let mut random = Random::new(4);
    for _ in 0..crate::rays() / 2000 {
        let family = random.below(FAMILIES);
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mut boxes: Vec<Aabb> = (0..random.pick(&[0, 5])).map(|_| boxed(&mut random, family)).collect();
        let mut words = built(&mixed(Mesh::new(&vertices, &triangles[..]).unwrap(), &boxes), &options(&mut random));
        // Nothing has moved: nothing changes.
        let as_built = words.clone();
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        assert!(Bvh::refit(&mut words, &mixed(mesh, &boxes)).is_ok());
        assert_eq!(words, as_built);
        for _ in 0..3 {
            let other = random.below(FAMILIES);
            let all = random.one_in(2);
            for v in &mut vertices {
                *v = if all || random.one_in(4) { point(&mut random, other) } else { *v };
            }
            boxes.iter_mut().for_each(|aabb| *aabb = boxed(&mut random, other));
            let shapes = mixed(Mesh::new(&vertices, &triangles[..]).unwrap(), &boxes);
            Bvh::refit(&mut words, &shapes).unwrap();
            let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
            let tree = Scene::new(Bvh::open(&words).unwrap(), &shapes).unwrap();
            assert_eq!(tree.bounds(), list.bounds());
            for _ in 0..120 {
                let ray = adversarial_ray(&mut random, other, &vertices);
                assert_eq!(bits(tree.closest_hit(&ray)), bits(list.closest_hit(&ray)), "{ray:?} {vertices:?}");
            }
        }
    }
}

/// Each half as large and half as far as the one before.
fn halved(count: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let scale = |i: usize| 2.0_f32.powi(-((i % 140) as i32));
    separate((0..count).flat_map(|i| [Vec3::ONE, Vec3::X, Vec3::Y].map(|v| v * scale(i))).collect())
}

/// One within the other, each a little larger.
fn nested(count: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners = [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
    separate((0..count).flat_map(|i| corners.map(|v| v * (1.0 + i as f32))).collect())
}

/// Along a line, each a little longer than the one before: neighbours are nearest on one side only.
fn growing(count: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |i: usize| Vec3::X * (i * i) as f32 * 0.01;
    separate((0..count).flat_map(|i| [at(i), at(i + 1), at(i) + Vec3::Y * 1.0e-3]).collect())
}

#[test]
fn adversaries_are_built_within_their_bounds_and_answered() {
    for (name, (vertices, triangles)) in [
        ("identical", identical(65_537)),
        ("crossing", crossing(3000)),
        ("halved", halved(20_000)),
        ("nested", nested(20_000)),
        ("growing", growing(20_000)),
    ] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        for method in METHODS {
            let words = built(&mesh, &Options { method, ..Options::fast() });
            let bvh = Bvh::open(&words).unwrap();
            let bytes = bvh.ordered().as_words().len() * 4;
            assert!(bvh.depth() <= 32 && bytes < triangles.len() * 33, "{name} {method:?} {}", bvh.depth());
            let tree = Scene::new(bvh, &mesh).unwrap();
            let mut random = Random::new(6);
            for _ in 0..20 {
                let ray = adversarial_ray(&mut random, 2, &vertices);
                assert_eq!(bits(tree.closest_hit(&ray)), bits(list.closest_hit(&ray)), "{name} {method:?} {ray:?}");
            }
        }
    }
}

#[test]
fn the_words_asked_for_are_just_enough() {
    let (others, corners) = crossing(3);
    let other = Mesh::new(&others, &corners[..]).unwrap();
    let meshes = [separate(vec![]), crossing(1), crossing(2), crossing(7), identical(20), halved(60), crossing(100)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        for options in all_options() {
            let enough = Bvh::words(triangles.len(), &options);
            let mut large = vec![7; enough];
            let expected = Bvh::build(&mesh, &mut Arena::new(&mut large), &options).unwrap().as_words();
            for free in (0..enough).step_by(1 + enough / 40).chain([enough - 1, enough, enough + 1, enough + 99]) {
                // Behind an earlier tenant, who is left alone.
                let keeps = built(&other, &options);
                let mut memory = vec![9; keeps.len() + free.max(Bvh::words(3, &options))];
                let mut arena = Arena::new(&mut memory);
                let tenant = Bvh::build(&other, &mut arena, &options).unwrap();
                let available = arena.available();
                match Bvh::build(&mesh, &mut arena, &options) {
                    Ok(bvh) => {
                        assert!(available >= enough && bvh.as_words() == expected);
                        assert_eq!(arena.available(), available - expected.len());
                    }
                    Err(BuildError::Full(full)) => {
                        assert_eq!(full, Full { at_least: enough, available });
                        assert!(available < enough && arena.available() == available);
                    }
                    Err(error) => panic!("{error}"),
                }
                assert_eq!(tenant.as_words(), keeps);
            }
        }
    }
    for options in all_options() {
        assert!(Bvh::words(usize::MAX, &options) > usize::MAX / 2);
    }
}

#[test]
fn any_options_are_good_for_something() {
    let mut random = Random::new(11);
    for _ in 0..3000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let absurd = [0.0, 0.3, 1.0e9, f32::INFINITY, f32::NAN, -1.0];
        let options = Options {
            method: random.pick(&METHODS),
            reinsertions: random.below(5) as u32,
            leaf_size: random.pick(&[0, 1, 7, 15, 16, u32::MAX]),
            intersection_cost: random.pick(&absurd),
            bytes_per_primitive: random.pick(&absurd),
            max_bytes: random.pick(&[None, None, Some(0), Some(500), Some(usize::MAX)]),
        };
        let mut memory = vec![0; Bvh::words(triangles.len(), &options)];
        match Bvh::build(&mesh, &mut Arena::new(&mut memory), &options) {
            Ok(bvh) => {
                assert!(Bvh::open(bvh.as_words()).is_ok(), "{options:?}");
                assert!(options.max_bytes.is_none_or(|bytes| bvh.ordered().as_words().len() * 4 <= bytes));
            }
            Err(BuildError::Budget { at_least, allowed }) => assert!(at_least > allowed),
            Err(error) => panic!("{error}: {options:?} {vertices:?}"),
        }
    }
}

#[test]
fn hierarchies_fit_into_their_bytes() {
    let (vertices, triangles) = sheet(30);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut least = usize::MAX;
    let mut work = 0.0;
    for allowed in (0..30_000).step_by(611).rev() {
        let options = Options { leaf_size: 15, ..Options::fast() }.fit(allowed);
        let mut memory = vec![0; Bvh::words(triangles.len(), &options)];
        match Bvh::build(&mesh, &mut Arena::new(&mut memory), &options) {
            Ok(bvh) => {
                let bytes = bvh.ordered().as_words().len() * 4;
                assert!(bytes <= allowed && least == usize::MAX, "{bytes} instead of {allowed}");
                // The budget is used, and fewer bytes are more work.
                let (steps, tests) = bvh.expected_work();
                assert!(bytes * 5 > allowed * 4 || allowed > 20_000, "{bytes} of {allowed}");
                assert!(steps + tests >= work, "{allowed}");
                work = steps + tests;
            }
            Err(BuildError::Budget { at_least, .. }) => {
                assert!(at_least > allowed && (least == usize::MAX || at_least == least));
                least = at_least;
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!((2000..8000).contains(&least), "{least}");
}

#[test]
fn primitives_without_valid_bounds_are_named() {
    for bad in [Aabb::EMPTY, Aabb::new(Vec3::NAN, Vec3::ONE), Aabb::new(Vec3::ZERO, Vec3::splat(1.0e38))] {
        let good = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let fine = from_fn(9, |_| good, |_, _| Some(1.0));
        let shapes = from_fn(9, |i| if i == 5 || i == 7 { bad } else { good }, |_, _| Some(1.0));
        let mut memory = vec![7; Bvh::words(9, &Options::small())];
        let refused = Bvh::build(&shapes, &mut Arena::new(&mut memory), &Options::small()).map(|bvh| bvh.depth());
        assert_eq!(refused, Err(BuildError::Bounds { primitive: 5 }));
        // The same if they move there; the words are as they were.
        let mut words = built(&fine, &Options::small());
        let before = words.clone();
        let refused = Bvh::refit(&mut words, &shapes).map(|bvh| bvh.depth());
        assert_eq!(refused, Err(Error::Build(BuildError::Bounds { primitive: 5 })));
        let other = from_fn(8, |_| good, |_, _| Some(1.0));
        assert!(matches!(Bvh::refit(&mut words, &other), Err(Error::Malformed(_))));
        assert!(matches!(Bvh::refit(&mut words[..9], &fine), Err(Error::Malformed(_))));
        assert_eq!(words, before);
    }
}

#[test]
fn numbers_of_primitives_grow_to_32_bits() {
    // 65,536 is the last count with two numbers to a word.
    for count in [65_535, 65_536, 65_537] {
        let boxes = |i: u32| Aabb::new(Vec3::splat((i / 3) as f32), Vec3::splat((i / 3 + 1) as f32));
        let shapes = from_fn(count, boxes, |i, _| Some(i as f32));
        let words = built(&shapes, &Options { reinsertions: 1, ..Options::small() });
        let scene = Scene::new(Bvh::open(&words).unwrap(), &shapes).unwrap();
        let list = Scene::new(List::new(&shapes).unwrap(), &shapes).unwrap();
        let along = Ray::new(Vec3::splat(((count - 20) / 3) as f32 + 0.5), Vec3::ONE);
        assert_eq!(scene.closest_hit(&along), list.closest_hit(&along));
        assert_eq!(scene.hits(&along).last(), list.hits(&along).last());
        let mut order: Vec<u32> = scene.accelerator().order().collect();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..count));
    }
}

/// Walks a hierarchy that opened: it must end within its pairs.
fn exercise(words: &[u32]) -> Result<(), Reason> {
    let bvh = Bvh::open(words).map_err(|error| error.reason)?;
    let shapes = from_fn(bvh.primitives(), |_| bvh.bounds(), |_, _| None);
    let scene = Scene::new(bvh, shapes).unwrap();
    let mut random = Random::new(9);
    for _ in 0..4 {
        let ray = Ray::new(point(&mut random, 2), point(&mut random, 2));
        let mut query = scene.begin(&ray);
        assert!(matches!(query.advance(bvh.pair_count() as u32), Progress::Done(_)), "a pair is visited twice");
    }
    let mut seen = vec![];
    let mut cells: Vec<_> = bvh.root().into_iter().collect();
    while let Some(cell) = cells.pop() {
        match Hierarchy::open(&bvh, &cell) {
            Inside::Cells(inside) => cells.extend(inside.into_iter().flatten()),
            Inside::Leaf(leaf) => seen.extend(leaf),
        }
    }
    assert_eq!(seen.len(), bvh.primitives() as usize);
    Ok(())
}

#[test]
fn every_byte_set_to_every_value_is_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for seed in 0..4 {
        let (vertices, triangles) = adversarial_mesh(&mut Random::new(seed + 20), 2, 9);
        let words = built(&Mesh::new(&vertices, &triangles[..]).unwrap(), &Options::fast());
        for length in 0..words.len() {
            // But for the list, which may be missing as a whole.
            let whole = length == Bvh::open(&words).unwrap().ordered().as_words().len();
            assert_eq!(exercise(&words[..length]).is_ok(), whole, "{length} of {}", words.len());
        }
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
    let (vertices, triangles) = crossing(20);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let words = built(&mesh, &Options { leaf_size: 1, ..Options::fast() });
    let bvh = Bvh::open(&words).unwrap();
    assert!(bvh.pair_count() == 19 && bvh.depth() > 3);
    let reason = |change: &dyn Fn(&mut Vec<u32>)| {
        let mut words = words.clone();
        change(&mut words);
        exercise(&words)
    };
    assert_eq!(reason(&|_| {}), Ok(()));
    // Word 3 is the root's link, words 10 to 13 the first node and its link, 14 to 17 the second.
    let inner = (0..19).find(|pair| words[13 + pair * 8] & 15 == 0).map(|pair| 13 + pair * 8).unwrap();
    let pair = words[inner] >> 4;
    for number in [0, pair - 1, pair + 1, 19, (1 << 28) - 1] {
        assert_eq!(reason(&|words| words[inner] = number << 4), Err(Reason::Link), "{number}");
    }
    let leaf = (0..19).find(|pair| words[13 + pair * 8] & 15 == 1).map(|pair| 13 + pair * 8).unwrap();
    for change in [16, 1, 14, 0xffff_ff00] {
        assert_eq!(reason(&|words| words[leaf] ^= change).err().map(|_| ()), Some(()), "{change}");
    }
    assert_eq!(reason(&|words| words[3] = 16), Err(Reason::Link));
    assert_eq!(reason(&|words| words[10] = 0x0001_0002), Err(Reason::Plane));
    assert_eq!(reason(&|words| words[2] = bvh.depth() - 1), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[2] = 33), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[4] = f32::NAN.to_bits()), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words.swap(4, 7)), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words[0] += 1), Err(Reason::Length));
    assert_eq!(reason(&|words| words[1] += 2), Err(Reason::Length));
    assert_eq!(reason(&|words| words.push(0)), Err(Reason::Length));
    let list = words.len() - 10;
    assert_eq!(reason(&|words| words[list] = words[list + 1]), Err(Reason::Primitive));
    assert_eq!(reason(&|words| words[list] |= 0x8000), Err(Reason::Primitive));
    let nothing = built(&Mesh::new(&[], &[[0_u16; 3]; 0]).unwrap(), &Options::fast());
    assert_eq!(exercise(&nothing), Ok(()));
    for word in [0, 1, 3] {
        let mut words = nothing.clone();
        words[word] = 17;
        assert!(exercise(&words).is_err());
    }
}

/// Bytes per triangle without the list, and the steps and tests expected of a ray through the bounds.
fn measured(side: u32, options: &Options) -> (f32, f32, f32) {
    let (vertices, triangles) = sheet(side);
    let words = built(&Mesh::new(&vertices, &triangles[..]).unwrap(), options);
    let bvh = Bvh::open(&words).unwrap();
    let (steps, tests) = bvh.expected_work();
    (bvh.ordered().as_words().len() as f32 * 4.0 / triangles.len() as f32, steps, tests)
}

#[test]
fn presets_hold_their_bytes_and_their_order() {
    let (small_bytes, _, small_tests) = measured(60, &Options::small());
    let (balanced_bytes, balanced_steps, balanced_tests) = measured(60, &Options::balanced());
    let (fast_bytes, fast_steps, fast_tests) = measured(60, &Options::fast());
    assert!(small_bytes < 6.1 && balanced_bytes < 10.7 && fast_bytes < 20.1, "{small_bytes} {balanced_bytes}");
    assert!(fast_tests < balanced_tests && balanced_tests < small_tests);
    assert!(balanced_steps < 40.0 && balanced_tests < 20.0, "{balanced_steps} {balanced_tests}");
    assert!(fast_steps < 42.0 && fast_tests < 13.0, "{fast_steps} {fast_tests}");
}

#[test]
fn work_grows_with_the_surface_and_not_with_the_number() {
    for method in METHODS {
        let options = Options { method, reinsertions: 1, ..Options::balanced() };
        let (_, few_steps, few_tests) = measured(20, &options);
        let (_, many_steps, many_tests) = measured(160, &options);
        // 64 times as many triangles; a list would do 64 times the tests.
        assert!(many_steps < few_steps * 6.0, "{few_steps} {many_steps}");
        assert!(many_tests < few_tests * 6.0, "{few_tests} {many_tests}");
    }
}

#[test]
fn reinsertion_makes_up_for_a_cheap_beginning() {
    let steps = |method, reinsertions| measured(50, &Options { method, reinsertions, ..Options::balanced() }).1;
    let (none, thrice) = (steps(Method::Ploc, 0), steps(Method::Ploc, 3));
    assert!(thrice < none * 0.97, "{none} {thrice}");
    let (down, up) = (steps(Method::Sah, 3), steps(Method::Ploc, 3));
    assert!(up < down * 1.1 && down < up * 1.1, "{down} {up}");
}

#[test]
fn work_stays_sane_while_a_sheet_waves() {
    let (mut vertices, triangles) = sheet(60);
    let mut words = built(&Mesh::new(&vertices, &triangles[..]).unwrap(), &Options::balanced());
    let (steps, tests) = Bvh::open(&words).unwrap().expected_work();
    for frame in 1..=4 {
        for v in &mut vertices {
            v.y += ((v.x as i32 / 8 + frame) % 5) as f32 * 0.5;
        }
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let refitted = Bvh::refit(&mut words, &mesh).unwrap().expected_work();
        let fresh = built(&mesh, &Options::balanced());
        let rebuilt = Bvh::open(&fresh).unwrap().expected_work();
        assert!(refitted.0 < rebuilt.0 * 1.4 && refitted.1 < rebuilt.1 * 1.4, "{refitted:?} {rebuilt:?}");
        assert!(refitted.0 < steps * 3.0 && refitted.1 < tests * 3.0, "{refitted:?}");
    }
}
