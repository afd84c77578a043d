//! Rays that leave a surface do not meet it again, however large or small its coordinates are.
#![allow(missing_docs)]

mod common;

use common::{Random, closed::Closed, rays, seed};
use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};

fn direction(random: &mut Random) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| random.unit() * 2.0 - 1.0))
}

/// Casts rays at a mesh and from where they meet it; how many went on from there.
fn leave(random: &mut Random) -> usize {
    let scale = 10.0_f64.powi(random.below(17) as i32 - 8);
    // Near the origin, or some widths away from it.
    let place = if random.one_in(2) { Vec3::ZERO } else { direction(random) * (scale * 20.0) as f32 };
    let closed = Closed::new(random, scale, place);
    let mesh = Mesh::new(&closed.vertices, &closed.triangles[..]).unwrap();
    let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let mut left = 0;
    for _ in 0..20 {
        let target = random.below(closed.triangles.len());
        let [a, b, c] = closed.corners(target);
        let (x, y) = (random.unit(), random.unit());
        let aim = a + (b - a) * x + (c - a) * y * (1.0 - x);
        let origin = closed.middle + direction(random) * random.pick(&[0.1, 3.0, 100.0]) * scale as f32;
        let ray = Ray::new(origin, aim - origin);
        let Some(hit) = scene.closest_hit(&ray) else { continue };
        let surface = scene.surface(&ray, &hit);
        let normal = surface.normal_towards_ray();
        let mirrored = ray.direction - normal * (2.0 * ray.direction.dot(normal));
        // Bounced, mirrored, through it, and towards a lamp.
        for away in [normal + direction(random) * 0.9, mirrored, ray.direction, direction(random)] {
            let next = Ray::new(surface.start_towards(away), away);
            if next.prepare().is_none() {
                continue;
            }
            let again = scene.closest_hit_where(&next, |next| next.primitive == hit.primitive);
            assert_eq!(again, None, "{ray:?} {hit:?} {surface:?} {next:?} {:?}", mesh.triangle(hit.primitive));
            left += 1;
        }
    }
    left
}

#[test]
fn no_surface_is_met_again() {
    let mut random = Random::new(33 + 100 * seed());
    let wanted = rays(100_000);
    let mut left = 0;
    while left < wanted {
        left += leave(&mut random);
    }
}
