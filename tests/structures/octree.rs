//! Octrees: they answer as the list, fit their memory, refuse what is not an octree, and are worth their bytes.

use std::f32::consts::{PI, TAU};

use crate::common::meshes::{Triangles, crossing, hair, identical, random, separate, shrinking};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, seal::every_byte};
use hitscan::{
    Accelerator, Arena, Hit, List, Mesh, Octree, Primitives, Ray, Scene, Span, Traversal,
    accel::{Hierarchy, Inside, MAX_LEVELS, Reason, Step},
    error::BuildError,
    from_fn,
    geometry::Aabb,
    glam::Vec3,
    octree::{MAX_DEPTH, Options, Split},
    query::Progress,
};

fn options(random: &mut Random) -> Options {
    let preset = random.pick(&[Options::small(), Options::balanced(), Options::fast()]);
    Options {
        split: random.pick(&[Split::Middle, Split::Sah, Split::Sah]),
        leaf_size: random.pick(&[1, 1, 2, 4]),
        max_depth: random.pick(&[16, 16, 3, 40]),
        intersection_cost: random.pick(&[preset.intersection_cost, 2.0, 20.0]),
        clip: !random.one_in(4),
        max_bytes: random.pick(&[None, None, Some(400)]),
        ..preset
    }
}

fn build<'m, P: Primitives>(
    primitives: &P,
    memory: &'m mut [u32],
    options: &Options,
) -> Result<Octree<'m>, BuildError> {
    Octree::build(primitives, &mut Arena::new(memory), options)
}

/// As an owner of words would: the memory that always suffices.
fn baked<P: Primitives>(primitives: &P, options: &Options) -> Vec<u32> {
    let mut memory = vec![0; Octree::words(primitives.len() as usize, options)];
    build(primitives, &mut memory, options).unwrap_or_else(|error| panic!("{error}: {options:?}")).as_words().to_vec()
}

#[test]
fn octrees_answer_as_the_list() {
    let mut random = Random::new(1);
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut hits, mut nodes, mut scenes) = (0, 0, 0, 0);
    while cast < crate::rays() {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        // Some scenes hold shapes that may not be clipped.
        let number = random.pick(&[0, 0, 12]);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i, ray)));
        let both = (mesh, others);
        let corners: Vec<Vec3> =
            boxes.iter().flat_map(|b| [b.min, b.max, b.center()]).chain(vertices.iter().copied()).collect();
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let options = options(&mut random);
        let tree = match build(&both, &mut memory, &options) {
            Ok(tree) => tree,
            Err(error) => panic!("{error}: {options:?}"),
        };
        scenes += 1;
        nodes += tree.node_count();
        let tree = Scene::new(Octree::open(tree.as_words()).unwrap(), &both).unwrap();
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &corners);
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(tree.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?} {boxes:?}");
            assert_eq!(tree.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?} {boxes:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(scenes >= cast / 240 && nodes > scenes * 10, "{nodes} nodes in {scenes} scenes");
}

#[test]
fn pauses_change_nothing() {
    let mut random = Random::new(4);
    for _ in 0..200 {
        let (vertices, triangles) = adversarial_mesh(&mut random, 2, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let words = baked(&mesh, &Options::fast());
        let scene = Scene::new(Octree::open(&words).unwrap(), &mesh).unwrap();
        for _ in 0..20 {
            let ray = adversarial_ray(&mut random, 2, &vertices);
            let mut query = scene.begin(&ray);
            let paused = loop {
                match query.advance(random.below(3) as u32) {
                    Progress::Done(hit) => break hit,
                    Progress::Paused => {}
                }
            };
            assert_eq!(bits(paused), bits(scene.closest_hit(&ray)));
        }
    }
}

fn all_options() -> impl Iterator<Item = Options> {
    let base = [Options::small(), Options::balanced(), Options::fast()];
    let splits = [Split::Middle, Split::Sah];
    base.into_iter().flat_map(move |base| {
        splits.into_iter().flat_map(move |split| [true, false].map(|clip| Options { split, clip, ..base }))
    })
}

#[test]
fn the_words_asked_for_always_suffice() {
    let meshes = [crossing(400), identical(1000), hair(300), random(500, 0.05), random(501, 3.0), shrinking(300)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        for options in all_options() {
            for intersection_cost in [options.intersection_cost, 50.0] {
                let options = Options { intersection_cost, ..options };
                let words = baked(&mesh, &options);
                let rate = triangles.len() * options.bytes_per_primitive as usize + 256;
                assert!(words.len() * 4 <= rate, "{options:?}");
            }
        }
    }
    let mut random = Random::new(11);
    for _ in 0..3000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 60);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = Options {
            split: random.pick(&[Split::Middle, Split::Sah]),
            leaf_size: random.below(4) as u32,
            intersection_cost: random.pick(&[0.3, 2.0, 1.0e9, f32::INFINITY, f32::NAN, -1.0]),
            max_depth: random.pick(&[16, 0, 2, u32::MAX]),
            bytes_per_primitive: random.below(400) as u32,
            clip: random.one_in(2),
            max_bytes: random.pick(&[None, None, Some(1000), Some(usize::MAX)]),
        };
        let mut memory = vec![0; Octree::words(triangles.len(), &options)];
        match build(&mesh, &mut memory, &options) {
            Ok(tree) => assert!(Octree::open(tree.as_words()).is_ok(), "{options:?}"),
            Err(error) => panic!("{error}: {options:?} {vertices:?}"),
        }
    }
}

#[test]
fn trees_fit_into_their_bytes() {
    let meshes = [separate(vec![]), random(1, 1.0), random(3, 1.0), random(40, 0.3), identical(150), crossing(60)];
    for (vertices, triangles) in &meshes {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        let least = baked(&mesh, &Options { max_depth: 0, ..Options::balanced() }).len() * 4;
        let mut memory = vec![0; Octree::words(triangles.len(), &Options::fast())];
        let most = baked(&mesh, &Options::fast()).len() * 4;
        let mut best = f32::INFINITY;
        for bytes in 0..most + 50 {
            let options = Options::fast().fit(bytes);
            let words = Octree::words(triangles.len(), &options);
            match build(&mesh, &mut memory[..words], &options) {
                Ok(tree) => {
                    let size = tree.as_words().len() * 4;
                    assert!(size <= bytes, "{size} bytes instead of {bytes} for {}", triangles.len());
                    assert!(bytes >= least);
                    let (nodes, tests) = tree.expected_work();
                    let work = nodes + tests * options.intersection_cost;
                    assert!(work <= best * 1.25, "{bytes}: {nodes} nodes, {tests} tests against {best}");
                    best = best.min(work);
                }
                Err(BuildError::Budget { at_least, allowed }) => {
                    assert!(bytes < least && allowed == bytes && at_least > bytes && at_least <= least, "{bytes}");
                }
                Err(error) => panic!("{error}: {options:?}"),
            }
        }
    }
}

#[test]
fn hostile_scenes_stay_small_and_correct() {
    for (vertices, triangles) in [identical(65_537), crossing(3000), hair(3000), shrinking(3000)] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        for options in [Options::balanced(), Options { split: Split::Middle, ..Options::fast() }] {
            let words = baked(&mesh, &options);
            assert!(words.len() * 4 <= triangles.len() * 200 + 256);
            let scene = Scene::new(Octree::open(&words).unwrap(), &mesh).unwrap();
            let mut random = Random::new(2);
            for _ in 0..20 {
                let ray = adversarial_ray(&mut random, 2, &vertices);
                assert_eq!(bits(scene.closest_hit(&ray)), bits(list.closest_hit(&ray)));
            }
        }
    }
}

/// Opens words, and if they open, walks them and takes them apart: both must end within the nodes.
fn exercise(words: &[u32], mesh: &Mesh) -> Result<(), Reason> {
    let tree = Octree::open(words).map_err(|error| error.reason)?;
    let mut random = Random::new(9);
    for _ in 0..4 {
        let ray = adversarial_ray(&mut random, 2, mesh.vertices());
        let Some(ray) = ray.prepare() else { continue };
        let (mut walk, mut budget) = (tree.traverse(&ray), tree.node_count() as u32);
        while let Step::Leaf(leaf) = walk.step(&ray, f32::MAX, &mut budget) {
            leaf.for_each(|primitive| assert!(primitive < tree.primitives()));
        }
        assert!(matches!(walk.step(&ray, f32::MAX, &mut 1), Step::Done), "the walk visits a node twice");
    }
    take_apart(&tree);
    Ok(())
}

/// Goes through all cells; how often each primitive was named.
fn take_apart(tree: &Octree) -> Vec<u32> {
    let mut named = vec![0; tree.primitives() as usize];
    let mut stack: Vec<_> = tree.root().into_iter().map(|cell| (cell, 1)).collect();
    while let Some((cell, level)) = stack.pop() {
        assert!(level <= MAX_LEVELS);
        match tree.open(&cell) {
            Inside::Cells(cells) => stack.extend(cells.into_iter().flatten().map(|cell| (cell, level + 1))),
            Inside::Leaf(leaf) => leaf.for_each(|primitive| named[primitive as usize] += 1),
        }
    }
    named
}

fn soup(seed: u64, most: usize) -> Triangles {
    adversarial_mesh(&mut Random::new(seed), 2, most)
}

#[test]
fn every_truncation_and_every_extension_is_refused() {
    let (vertices, triangles) = soup(1, 12);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let mut words = baked(&mesh, &Options::fast());
    assert_eq!(exercise(&words, &mesh), Ok(()));
    for length in 0..words.len() {
        assert!(exercise(&words[..length], &mesh).is_err(), "{length}");
    }
    words.push(0);
    assert_eq!(exercise(&words, &mesh), Err(Reason::Length));
}

#[test]
fn every_byte_set_to_every_value_is_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for seed in 0..6 {
        let (vertices, triangles) = soup(seed, 6);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let words = baked(&mesh, &Options { leaf_size: 1 + seed as u32 % 3, ..Options::fast() });
        for damaged in every_byte(&words) {
            match exercise(&damaged, &mesh) {
                Ok(()) => harmless += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 10_000 && harmless > 10_000, "{refused} {harmless}");
}

#[test]
fn structured_lies_are_refused() {
    let (vertices, triangles) = soup(2, 40);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let original = baked(&mesh, &Options::fast());
    let tree = Octree::open(&original).unwrap();
    let reason = |change: &dyn Fn(&mut Vec<u32>)| {
        let mut words = original.clone();
        change(&mut words);
        exercise(&words, &mesh)
    };
    assert!(tree.node_count() > 8 && tree.depth() > 1);
    // Word 10 is the root, an inner node; its point begins at word 11, the first of the body after it.
    let root = original[10];
    assert_eq!((root >> 31, root & 0x7f_ffff), (0, 1));
    assert_eq!(reason(&|_| {}), Ok(()));
    for block in [0, 2, original.len() as u32 - 10, 0x7f_ffff] {
        assert_eq!(reason(&|words| words[10] = root & !0x7f_ffff | block), Err(Reason::Link));
    }
    assert_eq!(reason(&|words| words[10] = 1), Err(Reason::Link), "no octants");
    for plane in [f32::NAN, f32::NEG_INFINITY] {
        assert_eq!(reason(&|words| words[11] = plane.to_bits()), Err(Reason::Plane));
    }
    assert_eq!(reason(&|words| words[0] += 1), Err(Reason::Header));
    assert_eq!(reason(&|words| words[1] += 1), Err(Reason::References));
    assert_eq!(reason(&|words| words[2] = 1), Err(Reason::Primitive));
    assert_eq!(reason(&|words| words[2] = 0), Err(Reason::Length));
    assert_eq!(reason(&|words| words[3] = tree.depth() - 1), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[3] = MAX_DEPTH as u32 + 1), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[4] = f32::NAN.to_bits()), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words.swap(4, 7)), Err(Reason::Bounds));
}

#[test]
fn cells_contain_what_they_name() {
    let mut random = Random::new(6);
    for family in [0, 2, 7] {
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 200);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for split in [Split::Middle, Split::Sah] {
            let words = baked(&mesh, &Options { split, ..Options::fast() });
            let tree = Octree::open(&words).unwrap();
            let named = take_apart(&tree);
            let mut stack: Vec<_> = tree.root().into_iter().collect();
            while let Some(cell) = stack.pop() {
                match tree.open(&cell) {
                    Inside::Cells(cells) => {
                        for part in cells.into_iter().flatten() {
                            assert_eq!(part.bounds.union(&cell.bounds), cell.bounds, "children lie within");
                            stack.push(part);
                        }
                    }
                    Inside::Leaf(leaf) => leaf.for_each(|primitive| {
                        assert!(mesh.clip(primitive, &cell.bounds).is_some(), "{primitive} is not in its leaf");
                    }),
                }
            }
            // Only what clipping finds nowhere is named nowhere: triangles that no ray can hit.
            for (primitive, &times) in named.iter().enumerate() {
                assert!(times > 0 || mesh.triangle(primitive as u32).normal().length() == 0.0);
            }
        }
    }
}

/// Nodes and tests per ray.
fn work(tree: &Octree, mesh: &Mesh, rays: &[Ray]) -> (f64, f64) {
    let (mut nodes, mut tests) = (0_u64, 0_u64);
    for ray in rays.iter().filter_map(Ray::prepare) {
        let (mut walk, mut budget) = (tree.traverse(&ray), u32::MAX);
        let mut best = Hit { t: ray.ray().t_max, primitive: u32::MAX };
        while let Step::Leaf(leaf) = walk.step(&ray, best.t, &mut budget) {
            for primitive in leaf {
                tests += 1;
                let span = Span::new(Hit { t: ray.ray().t_min, primitive: 0 }, best);
                best = mesh.intersect(primitive, &ray, &span).unwrap_or(best);
            }
        }
        nodes += u64::from(u32::MAX - budget);
    }
    (nodes as f64 / rays.len() as f64, tests as f64 / rays.len() as f64)
}

/// A sphere of 2 n² triangles, and rays from its inside and outside.
fn sphere(n: u32) -> (Triangles, Vec<Ray>) {
    let at = |i: u32, j: u32| {
        let (a, b) = ((i % n) as f32 / n as f32 * TAU, j as f32 / n as f32 * PI);
        Vec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos())
    };
    let vertices = (0..=n).flat_map(|j| (0..n).map(move |i| at(i, j))).collect();
    let corner = |i: u32, j: u32| j * n + i % n;
    let triangles = (0..n * n)
        .map(|k| (k % n, k / n))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect();
    let mut random = Random::new(3);
    let mut point = |scale: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * scale));
    let rays = (0..2000).map(|i| Ray::new(point(if i % 2 == 0 { 1.0 } else { 6.0 }), point(2.0))).collect();
    ((vertices, triangles), rays)
}

#[test]
fn trees_are_worth_their_bytes() {
    let ((vertices, triangles), rays) = sphere(60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for (options, most_bytes, most_nodes, most_tests) in [
        (Options::small(), 15, 6.5, 5.5),
        (Options::balanced(), 22, 7.0, 3.5),
        (Options::fast(), 48, 7.2, 2.4),
        (Options { split: Split::Middle, ..Options::balanced() }, 24, 7.0, 7.5),
    ] {
        let words = baked(&mesh, &options);
        let (nodes, tests) = work(&Octree::open(&words).unwrap(), &mesh, &rays);
        let bytes = words.len() * 4 / triangles.len();
        println!("{bytes} bytes, {nodes} nodes, {tests} tests");
        assert!(bytes <= most_bytes && nodes <= most_nodes && tests <= most_tests, "{bytes} {nodes} {tests}");
    }
}
