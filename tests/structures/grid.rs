//! Grids answer as the list does, fit into what they promise, and refuse what is not a grid.

use crate::common::meshes::{Triangles, crossing, hair, identical, random, separate};
use crate::common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise, seal::every_byte};
use hitscan::{
    Accelerator, Arena, Grid, Hit, List, Mesh, Primitives, Ray, Scene, Traversal,
    accel::{Cell, Hierarchy, Inside, MAX_LEVELS, Mailbox, Reason, Step},
    error::BuildError,
    from_fn,
    geometry::Aabb,
    glam::Vec3,
    grid::{Form, Options},
    query::Progress,
};

fn options(random: &mut Random) -> Options {
    Options {
        density: random.pick(&[0.3, 2.0, 8.0, 8.0, 50.0]),
        form: random.pick(&Form::ALL),
        clip: !random.one_in(4),
        bytes_per_primitive: random.pick(&[30, 200, 200]),
        max_bytes: random.pick(&[None, None, None, Some(900)]),
    }
}

#[test]
fn grids_answer_as_the_list() {
    let mut random = Random::new(1);
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut hits, mut cells, mut scenes) = (0, 0, 0, 0);
    while cast < crate::rays() {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let number = random.pick(&[0, 12]);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let corners: Vec<Vec3> =
            boxes.iter().flat_map(|b| [b.min, b.max, b.center()]).chain(vertices.iter().copied()).collect();
        let first = mesh.len();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i + first, ray)));
        let both = (mesh, others);
        let options = options(&mut random);
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let grid = Grid::build(&both, &mut Arena::new(&mut memory), &options)
            .unwrap_or_else(|error| panic!("{error}: {options:?}"));
        let grid = Grid::open(grid.as_words()).unwrap_or_else(|error| panic!("{error}: {options:?}"));
        let [nx, ny, nz] = grid.resolution().map(|n| n as usize);
        scenes += 1;
        cells += nx * ny * nz;
        let scene = Scene::new(grid, &both).unwrap();
        let mailed = Scene::new(Mailbox(grid), &both).unwrap();
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &corners);
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?}");
            assert_eq!(bits(mailed.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?}");
            assert_eq!(scene.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?}");
            assert_eq!(mailed.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single cells would be equal, too.
    assert!(scenes >= cast / 240 && cells > scenes * 50, "{cells} cells in {scenes} scenes");
}

#[test]
fn every_query_answers_as_the_list() {
    let mut random = Random::new(2);
    let mut memory = vec![0; 1 << 16];
    for _ in 0..crate::rays() / 4000 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let options = options(&mut random);
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let grid = Grid::build(&mesh, &mut Arena::new(&mut memory), &options).unwrap();
        let (plain, mailed) = (Scene::new(grid, &mesh).unwrap(), Scene::new(Mailbox(grid), &mesh).unwrap());
        for _ in 0..60 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let expected: Vec<Hit> = list.hits(&ray).collect();
            assert!(plain.hits(&ray).eq(expected.iter().copied()), "{ray:?} {options:?}");
            assert!(mailed.hits(&ray).eq(expected.iter().copied()), "{ray:?} {options:?}");
            let mut nearest: heapless::Vec<Hit, 3> = heapless::Vec::new();
            mailed.nearest_hits(&ray, &mut nearest);
            assert!(nearest.iter().eq(expected.iter().take(3)), "{ray:?} {options:?}");
            let keep = |hit: &Hit| hit.primitive % 3 == 1;
            let kept = expected.iter().copied().find(keep);
            assert_eq!(bits(plain.closest_hit_where(&ray, keep)), bits(kept));
            assert_eq!(bits(mailed.closest_hit_where(&ray, keep)), bits(kept));
            assert_eq!(mailed.any_hit_where(&ray, keep), kept.is_some());
            let first = expected.first().copied();
            let (mut a, mut b) = (plain.begin(&ray), mailed.begin(&ray));
            let budget = 1 + random.below(4) as u32;
            assert_eq!(finish(|| a.advance(budget)), first, "{ray:?} {options:?}");
            assert_eq!(finish(|| b.advance(budget)), first, "{ray:?} {options:?}");
        }
    }
}

/// Goes on until it is done.
fn finish(mut advance: impl FnMut() -> Progress) -> Option<Hit> {
    loop {
        if let Progress::Done(hit) = advance() {
            return hit;
        }
    }
}

/// Each half as large and as far from the corner as the one before.
fn series(count: usize) -> Triangles {
    separate(
        (0..count)
            .map(|i| 0.5_f32.powi(i as i32 % 120))
            .flat_map(|s| [Vec3::X * s, Vec3::Y * s, Vec3::Z * s])
            .collect(),
    )
}

fn all_options() -> impl Iterator<Item = Options> {
    let base = [Options::small(), Options::balanced(), Options::fast(), Options::quick()];
    base.into_iter().flat_map(|base| {
        Form::ALL.into_iter().flat_map(move |form| [true, false].map(|clip| Options { form, clip, ..base }))
    })
}

fn build<'m, P: Primitives>(primitives: &P, memory: &'m mut [u32], options: &Options) -> Result<Grid<'m>, BuildError> {
    Grid::build(primitives, &mut Arena::new(memory), options)
}

#[test]
fn bytes_and_memory_are_bounded_whatever_the_primitives() {
    let thousands = [crossing(1000), identical(1000), hair(1000), random(1000, 0.05), random(1001, 3.0), series(500)];
    for (vertices, triangles) in &thousands {
        let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
        for base in all_options() {
            for density in [base.density, f32::INFINITY, f32::NAN, -1.0] {
                let options = Options { density, ..base };
                let mut memory = vec![0; Grid::words(triangles.len(), &options)];
                let grid = build(&mesh, &mut memory, &options).unwrap_or_else(|error| panic!("{error}: {options:?}"));
                let rate = triangles.len() * options.bytes_per_primitive as usize + 256;
                assert!(grid.as_words().len() * 4 <= rate, "{options:?}");
                assert!(Grid::open(grid.as_words()).is_ok());
            }
        }
    }
}

#[test]
fn grids_fit_into_their_bytes() {
    for (vertices, triangles) in [separate(vec![]), random(1, 1.0), random(40, 0.3), identical(15), hair(60)] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for form in Form::ALL {
            let base = Options { form, ..Options::fast() };
            let mut memory = vec![0; Grid::words(triangles.len(), &base)];
            let most = build(&mesh, &mut memory, &base).unwrap().as_words().len() * 4;
            let one = Options { density: 0.0, ..base };
            let least = build(&mesh, &mut memory, &one).unwrap().as_words().len() * 4;
            for bytes in (0..most + 200).step_by(7) {
                let options = base.fit(bytes);
                let mut memory = vec![0; Grid::words(triangles.len(), &options)];
                match build(&mesh, &mut memory, &options) {
                    Ok(grid) => assert!(grid.as_words().len() * 4 <= bytes && bytes >= least, "{bytes}"),
                    Err(BuildError::Budget { at_least, allowed }) => {
                        assert!(bytes < least && allowed == bytes && at_least == least, "{bytes} {at_least} {least}");
                    }
                    Err(error) => panic!("{error}: {options:?}"),
                }
            }
        }
    }
}

#[test]
fn masses_of_the_worst_are_built_in_time() {
    // Narrow references end at 65,536 primitives.
    for count in [65_535, 65_536, 65_537] {
        let (vertices, triangles) = identical(count);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for options in [Options::small(), Options { clip: false, ..Options::fast() }] {
            let mut memory = vec![0; Grid::words(count, &options)];
            let grid = build(&mesh, &mut memory, &options).unwrap();
            let scene = Scene::new(Grid::open(grid.as_words()).unwrap(), &mesh).unwrap();
            let ray = Ray::new(Vec3::new(0.1, 0.2, 9.0), Vec3::NEG_Z);
            assert_eq!(scene.closest_hit(&ray).unwrap().primitive, 0);
            let last = scene.closest_hit_where(&ray, |hit| hit.primitive as usize == count - 1);
            assert_eq!(last.unwrap().primitive as usize, count - 1);
        }
    }
    for (vertices, triangles) in [hair(20_000), crossing(20_000), series(20_000)] {
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        for options in [Options::small(), Options { clip: false, ..Options::fast() }] {
            let mut memory = vec![0; Grid::words(triangles.len(), &options)];
            assert!(build(&mesh, &mut memory, &options).is_ok());
        }
    }
}

/// Walks it, if it opens: the walk must end within the cells, the search within the levels.
fn exercise(words: &[u32], primitives: &impl Primitives) -> Result<(), Reason> {
    let grid = Grid::open(words).map_err(|error| error.reason)?;
    let cells: u32 = grid.resolution().into_iter().product();
    let mut random = Random::new(9);
    if let Ok(scene) = Scene::new(grid, primitives) {
        for _ in 0..4 {
            let ray = Ray::new(crate::common::point(&mut random, 2), crate::common::point(&mut random, 2));
            assert!(matches!(scene.begin(&ray).advance(cells), Progress::Done(_)), "the walk visits a cell twice");
        }
    }
    Ok(())
}

#[test]
fn damaged_words_are_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for form in Form::ALL {
        let (vertices, triangles) = random(9, 1.0);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let mut memory = vec![0; 2000];
        let words = build(&mesh, &mut memory, &Options { form, ..Options::fast() }).unwrap().as_words().to_vec();
        assert_eq!(exercise(&words, &mesh), Ok(()));
        for length in 0..words.len() {
            assert_eq!(exercise(&words[..length], &mesh), Err(Reason::Length), "{length}");
        }
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
    let (vertices, triangles) = random(30, 0.5);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for form in Form::ALL {
        let mut memory = vec![0; 9000];
        let grid = build(&mesh, &mut memory, &Options { form, ..Options::fast() }).unwrap();
        let [nx, ny, nz] = grid.resolution();
        let references = grid.reference_count() as u32;
        assert!(nx > 2 && ny > 2 && nz > 2);
        let words = grid.as_words().to_vec();
        let reason = |change: &dyn Fn(&mut Vec<u32>)| {
            let mut words = words.clone();
            change(&mut words);
            Grid::open(&words).map(|_| ()).map_err(|error| error.reason)
        };
        assert_eq!(reason(&|_| {}), Ok(()));
        assert_eq!(reason(&|words| words.push(0)), Err(Reason::Length));
        assert_eq!(reason(&|words| words[0] = 1), Err(Reason::Primitive));
        assert!(form != Form::Full || reason(&|words| words[0] = 1 << 17).is_err(), "entries by more jumps");
        assert!(reason(&|words| words[1] = references - 1).is_err());
        assert!(reason(&|words| words[2] += 1).is_err());
        assert_eq!(reason(&|words| words[3] = 3), Err(Reason::Header));
        assert!(reason(&|words| words[3] ^= 1).is_err());
        assert_eq!(reason(&|words| words[4] = 0), Err(Reason::Header));
        assert_eq!(reason(&|words| words[5] = u32::MAX), Err(Reason::Header));
        assert_eq!(reason(&|words| words[4..7].fill(1 << 20)), Err(Reason::Header));
        assert_eq!(reason(&|words| words[7] = f32::NAN.to_bits()), Err(Reason::Bounds));
        assert_eq!(reason(&|words| words.swap(7, 10)), Err(Reason::Bounds));
        // Other cells of the same number are harmless.
        assert_eq!(reason(&|words| words.swap(4, 6)), Ok(()));
        let table = if form == Form::Bitmask {
            // A block's rank, its bits, and a bit behind the last cell.
            assert_eq!(reason(&|words| words[14] = 1), Err(Reason::Link));
            assert_eq!(reason(&|words| words[16] += 1), Err(Reason::Link));
            assert!(reason(&|words| words[13] ^= 1).is_err());
            let blocks = (nx * ny * nz).div_ceil(32) as usize;
            assert_ne!(nx * ny * nz % 32, 0);
            assert_eq!(reason(&|words| words[13 + blocks * 2 - 2] |= 1 << 31), Err(Reason::Link));
            13 + blocks * 2
        } else {
            13
        };
        assert_eq!(reason(&|words| words[table] |= 1), Err(Reason::References));
        assert_eq!(reason(&|words| words[table + 3] = 0xffff_ffff), Err(Reason::References));
    }
}

/// Each primitive lies in the cells of the leaves that name it, and the cells are in bounds.
#[test]
fn searches_find_every_primitive_where_it_is() {
    let mut random = Random::new(6);
    let mut memory = vec![0; 1 << 17];
    for _ in 0..300 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let grid = Grid::build(&mesh, &mut Arena::new(&mut memory), &options(&mut random)).unwrap();
        let mut parts = vec![Aabb::EMPTY; triangles.len()];
        let (mut leaves, mut stack) = (0, vec![(1, grid.root().unwrap())]);
        while let Some((level, cell)) = stack.pop() {
            assert!(level <= MAX_LEVELS && !cell.bounds.is_empty());
            match grid.open(&cell) {
                Inside::Cells(cells) => {
                    stack.extend(cells.into_iter().flatten().map(|cell: Cell<_>| (level + 1, cell)))
                }
                Inside::Leaf(leaf) => {
                    leaves += 1;
                    for number in leaf {
                        let part = &mut parts[number as usize];
                        *part = part.union(&mesh.bounds(number).intersection(&cell.bounds));
                    }
                }
            }
        }
        assert_eq!(leaves, grid.resolution().into_iter().product::<u32>());
        for (number, part) in parts.iter().enumerate() {
            // The outer planes may lie a little outside.
            assert_eq!(*part, mesh.bounds(number as u32));
        }
    }
}

/// A ball of triangles.
fn ball(side: u32) -> Triangles {
    let point = |i: u32, j: u32| {
        let (z, turn) = (j as f32 / side as f32 * 2.0 - 1.0, i as f32 / side as f32 * std::f32::consts::TAU);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(radius * turn.cos(), radius * turn.sin(), z)
    };
    let squares = (0..side * side).map(|i| (i % side, i / side));
    separate(
        squares
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i, j + 1), point(i + 1, j + 1)];
                [a, b, c, b, d, c]
            })
            .collect(),
    )
}

/// Cells visited and primitives tested on the way to the closest hit.
fn work<A: Accelerator>(accelerator: &A, mesh: &Mesh, ray: &Ray) -> (u32, u32) {
    let Some(ray) = ray.prepare() else { return (0, 0) };
    let mut walk = accelerator.traverse(&ray);
    let (mut budget, mut tests) = (u32::MAX, 0);
    let mut best = Hit { t: ray.ray().t_max, primitive: u32::MAX };
    while let Step::Leaf(leaf) = walk.step(&ray, best.t, &mut budget) {
        for number in leaf {
            tests += 1;
            let span = hitscan::Span::new(Hit { t: ray.ray().t_min, primitive: 0 }, best);
            best = mesh.intersect(number, &ray, &span).unwrap_or(best);
        }
    }
    (u32::MAX - budget, tests)
}

#[test]
fn walks_are_short_and_the_mailbox_makes_them_shorter() {
    let (vertices, triangles) = ball(50);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for options in all_options().filter(|options| options.clip) {
        let mut memory = vec![0; Grid::words(triangles.len(), &options)];
        let grid = build(&mesh, &mut memory, &options).unwrap();
        let [nx, ny, nz] = grid.resolution();
        let bytes = grid.as_words().len() as f32 * 4.0 / triangles.len() as f32;
        let cells = nx * ny * nz;
        assert!(cells as f32 > triangles.len() as f32 * options.density * 0.7, "{cells}");
        let per_cell = match options.form {
            Form::Full => 5.0,
            Form::Octants => 4.3,
            Form::Bitmask => 0.9,
        };
        assert!(bytes < options.density * per_cell + 9.0, "{bytes}");
        let mut random = Random::new(4);
        let (mut visits, mut tests, mut fewer) = (0, 0, 0);
        for _ in 0..1000 {
            let mut point = || Vec3::from_array([0; 3].map(|_| random.unit() * 2.0 - 1.0));
            let (from, to) = (point() * 2.0, point());
            let ray = Ray::new(from, to - from);
            let (visited, tested) = work(&grid, &mesh, &ray);
            // From near by, hardly more than the planes that are crossed.
            assert!(visited <= 2 * (nx + ny + nz), "{visited} of {nx} {ny} {nz}");
            visits += visited;
            tests += tested;
            let (again, mailed) = work(&Mailbox(grid), &mesh, &ray);
            assert!(again == visited && mailed <= tested);
            fewer += mailed;
        }
        // In sixteen times as many cells without octants there would be as many.
        let most = if options.density < 2.0 { 12_000 } else { 9_000 };
        assert!(visits < 1000 * (nx + ny + nz) && tests < most, "{visits} {tests}");
        assert!(fewer * 10 < tests * 9, "{fewer} {tests}");
    }
}

#[test]
fn no_ray_visits_a_cell_twice() {
    let mut random = Random::new(12);
    let mut memory = vec![0; 1 << 17];
    for _ in 0..400 {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 30);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let grid = Grid::build(&mesh, &mut Arena::new(&mut memory), &options(&mut random)).unwrap();
        let cells: u32 = grid.resolution().into_iter().product();
        for _ in 0..100 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let Some(prepared) = ray.prepare() else { continue };
            let (mut walk, mut budget) = (grid.traverse(&prepared), u32::MAX);
            while let Step::Leaf(_) = walk.step(&prepared, f32::MAX, &mut budget) {}
            assert!(u32::MAX - budget <= cells, "{ray:?}");
            assert!(matches!(walk.step(&prepared, f32::MAX, &mut budget), Step::Done));
        }
    }
}
