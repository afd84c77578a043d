//! Rays along the planes of a grid answer as the list does, and take no more work than others.

use core::cell::Cell;

use crate::common::{
    Random, bits,
    meshes::{self, separate},
    noise, seed,
};
use hitscan::{
    Accelerator, Arena, Grid, List, Mesh, Ray, Scene,
    accel::Mailbox,
    from_fn,
    geometry::{Aabb, Axis, Lattice},
    glam::Vec3,
    grid::{Form, Options},
    primitives::Counted,
};

/// The planes of a grid: those between its cells and those in the middle of each.
fn planes(grid: &Grid) -> Lattice {
    Lattice::over(&grid.bounds(), grid.resolution().map(|count| 2 * count))
}

/// A plane of an axis, and perhaps one that is before the first or behind the last.
fn plane(random: &mut Random, lattice: &Lattice, axis: Axis) -> f32 {
    let last = lattice.last(axis);
    match random.below(24) {
        0 | 3 | 4 => lattice.position(axis, 0),
        1 => lattice.position(axis, last),
        2 => 2.0 * lattice.position(axis, 0) - lattice.position(axis, last),
        _ => lattice.position(axis, random.below(last as usize + 1) as u32),
    }
}

/// A number or one of its neighbours, or one of those around a part of the distance to the next plane away.
fn beside(random: &mut Random, x: f32, step: f32) -> f32 {
    match random.below(6) {
        0 | 1 => x,
        2 => x.next_up(),
        3 => x.next_down(),
        4 => x + step * random.pick(&[1.0e-6, -1.0e-6, 1.0e-3, -1.0e-3]),
        _ => x + step * random.unit(),
    }
}

fn on_planes(random: &mut Random, lattice: &Lattice) -> Vec3 {
    let numbers = Axis::ALL.map(|axis| {
        let x = plane(random, lattice, axis);
        let step = lattice.position(axis, 1) - lattice.position(axis, 0);
        beside(random, x, step)
    });
    Vec3::from_array(numbers)
}

/// A ray along one or two axes, or nearly.
fn along(random: &mut Random, lattice: &Lattice, size: f32) -> Ray {
    let mut direction = Vec3::from_array([0; 3].map(|_| random.pick(&[1.0, -1.0, 0.3, -0.7]) * (random.unit() + 0.1)));
    let zero = |random: &mut Random| {
        random.pick(&[0.0, 0.0, -0.0, -0.0, 1.0e-40, -1.0e-42, 1.0e-45, -2.0_f32.powi(-128), 2.0_f32.powi(-127)])
    };
    let moving = random.below(3);
    for axis in (0..3).filter(|&axis| axis != moving) {
        if axis == (moving + 1) % 3 || random.one_in(2) {
            direction[axis] = zero(random);
        }
    }
    let mut origin = on_planes(random, lattice);
    if random.one_in(2) {
        let back = random.pick(&[0.3, 1.0, 3.0, -2.0, 1.0e4]) * size;
        for axis in (0..3).filter(|&axis| direction[axis].abs() > 1.0e-30) {
            origin[axis] -= direction[axis] * back;
        }
    }
    let t_min = random.pick(&[0.0, 0.0, 0.0, -1.0, 0.3, -1.0e9, f32::NEG_INFINITY]);
    let t_max = random.pick(&[f32::INFINITY, f32::INFINITY, 1.0, 0.0]);
    let ray = Ray::new(origin, direction * random.pick(&[1.0, 1.0, 2.0_f32.powi(-40), 1.0e20]));
    ray.starting_at(t_min * size).up_to(t_max * size)
}

#[test]
fn rays_on_planes_and_beside_them_answer_as_the_list() {
    let mut random = Random::new(31 + 1000 * seed());
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut hits) = (0, 0);
    while cast < crate::rays() {
        let size = random.pick(&[1.0, 1.0, 1.0e-3, 1.0e6, 2.0_f32.powi(-60)]);
        let middle = size * random.pick(&[0.0, 0.0, 1.0, -300.0]);
        let edge = random.pick(&[0.5, 1.5]);
        let points = |random: &mut Random, scale: f32| Vec3::from_array([0; 3].map(|_| random.unit() * scale));
        let mut vertices: Vec<Vec3> = (0..40)
            .flat_map(|_| {
                let corner = points(&mut random, 1.0);
                [corner, corner + points(&mut random, edge), corner + points(&mut random, edge)]
            })
            .map(|point| Vec3::splat(middle) + point * size)
            .collect();
        // Beside planes at 0 roundings are finest: some rays cross those that have no reciprocal.
        if random.one_in(2) {
            let min = Aabb::around(vertices.iter().copied()).min;
            vertices.iter_mut().for_each(|vertex| *vertex -= min);
        }
        let form = random.pick(&Form::ALL);
        let options = Options { density: random.pick(&[1.0, 6.0]), form, clip: !random.one_in(4), ..Options::fast() };
        // Some of the corners go where planes are about to be.
        let (_, triangles) = separate(vertices.clone());
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let first = planes(&Grid::build(&mesh, &mut Arena::new(&mut memory), &options).unwrap());
        for vertex in &mut vertices {
            for axis in Axis::ALL {
                if random.one_in(3) {
                    let number = if random.one_in(4) { 0 } else { first.below(axis, vertex[axis as usize]) };
                    vertex[axis as usize] = first.position(axis, number);
                }
            }
        }
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let bounds = Aabb::around(vertices.iter().copied());
        let boxes: Vec<Aabb> = (0..random.pick(&[0, 10]))
            .map(|_| Aabb::around([0; 2].map(|_| on_planes(&mut random, &first).clamp(bounds.min, bounds.max))))
            .collect();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i + 40, ray) * size));
        let both = (mesh, others);
        let grid = Grid::build(&both, &mut Arena::new(&mut memory), &options).unwrap();
        let lattice = planes(&grid);
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let (plain, mailed) = (Scene::new(grid, &both).unwrap(), Scene::new(Mailbox(grid), &both).unwrap());
        for _ in 0..200 {
            let ray = along(&mut random, &lattice, size);
            let expected = list.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(bits(plain.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?} {boxes:?}");
            assert_eq!(bits(mailed.closest_hit(&ray)), bits(expected), "{ray:?} {options:?} {vertices:?} {boxes:?}");
            assert_eq!(plain.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?} {boxes:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
}

/// Tests on the way to the closest hits of rays whose directions are these along two axes.
fn tests(mesh: &Mesh, grid: Grid, tilts: [f32; 2]) -> u64 {
    let count = Cell::new(0);
    let scene = Scene::new(grid, Counted::new(mesh, &count)).unwrap();
    let mut random = Random::new(32);
    for _ in 0..3000 {
        let axis = random.below(3);
        let mut direction = Vec3::splat(random.pick(&[1.0, -1.0]));
        direction[(axis + 1) % 3] = tilts[0];
        direction[(axis + 2) % 3] = tilts[1];
        let origin = Vec3::from_array([0; 3].map(|_| random.unit()));
        let _ = scene.closest_hit(&Ray::new(origin, direction));
    }
    count.get()
}

#[test]
fn rays_along_axes_take_no_more_tests_than_tilted_ones() {
    let (vertices, triangles) = meshes::random(2000, 0.1);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for form in [Form::Octants, Form::Bitmask] {
        let options = Options { form, ..Options::fast() };
        let mut memory = vec![0; Grid::words(triangles.len(), &options)];
        let grid = Grid::build(&mesh, &mut Arena::new(&mut memory), &options).unwrap();
        let tilted = tests(&mesh, grid, [1.0e-4, -1.0e-4]);
        for tilts in [[0.0, 0.0], [-0.0, 1.0e-4], [1.0e-40, -1.0e-40], [1.0e-42, 0.0]] {
            let along = tests(&mesh, grid, tilts);
            println!("{form:?} {tilts:?}: {along} tests, {tilted} tilted");
            assert!(along * 100 <= tilted * 102, "{form:?} {tilts:?}: {along} {tilted}");
        }
    }
}
