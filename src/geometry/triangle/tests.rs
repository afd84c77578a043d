//! The tiers against each other: whatever a fast one answers, the exact one must answer too.

use super::*;
use crate::{
    geometry::Ray,
    testing::{Random, cases},
};

/// The exact answer alone.
fn exactly(triangle: &Triangle, ray: &PreparedRay) -> Option<Crossing> {
    let Triangle { a, b, c } = *triangle;
    let sign = agreement([exact::edge(ray, b, c), exact::edge(ray, c, a), exact::edge(ray, a, b)])?;
    let t = exact::parameter(triangle, ray);
    t.is_finite().then_some(Crossing { t, front: sign == Sign::Negative })
}

/// Coordinates from families that share edges, cancel, underflow or overflow.
fn coordinate(random: &mut Random, family: u32) -> f32 {
    match family {
        0 => random.below(5) as f32 - 2.0,
        1 => random.unit() * 2.0 - 1.0,
        2 => [0.0, -0.0, 1.0, -1.0, 1.0e-40, 0.5, f32::MIN_POSITIVE][random.below(7) as usize],
        3 => 4096.0 + random.below(9) as f32 / 2048.0,
        4 => (random.below(9) as f32 - 4.0) * 1.0e-20,
        5 => (random.below(3) as f32 - 1.0) * 3.0e15 + random.unit(),
        // Where cubes of lengths leave the range of f32, and lengths are multiplied first.
        7 => (random.unit() * 2.0 - 1.0) * 1.0e-14,
        8 => (random.unit() * 2.0 - 1.0) * 1.0e-18,
        9 => (random.unit() * 2.0 - 1.0) * 1.0e17,
        10 => (random.unit() * 2.0 - 1.0) * 1.0e6,
        _ => (random.below(7) as f32 - 3.0) / 3.0,
    }
}

#[test]
fn every_tier_answers_as_the_exact_one() {
    let mut random = Random::new(7);
    let (mut hits, mut slow) = (0, 0);
    for _ in 0..cases(100_000) {
        let family = random.below(11);
        let mut point = || {
            let [x, y, z] = [0; 3].map(|_| coordinate(&mut random, family));
            Vec3::new(x, y, z)
        };
        let (a, b, c, origin, target) = (point(), point(), point(), point(), point());
        let triangle = Triangle::new(a, b, c);
        let aim = [a, (a + b) * 0.5, (a + b + c) / 3.0, target][random.below(4) as usize];
        let Some(ray) = Ray::new(origin, aim - origin).starting_at(f32::MIN).prepare() else { continue };
        let exact = exactly(&triangle, &ray);
        hits += u32::from(exact.is_some());
        for tier in [shortcut::test, double::test] {
            assert_eq!(tier(&triangle, &ray, None), exact, "{triangle:?} {ray:?}");
            if let Some(crossing) = exact {
                assert_eq!(tier(&triangle, &ray, Some(crossing.front)), exact, "{triangle:?} {ray:?}");
            }
        }
        let got = triangle.intersect(&ray, f32::MIN, f32::MAX);
        assert_eq!(got.is_some(), exact.is_some(), "{triangle:?} {ray:?}");
        if let (Some(got), Some(exact)) = (got, exact) {
            assert_eq!(got.front, exact.front, "{triangle:?} {ray:?}");
            assert!((got.t - exact.t).abs() <= exact.t.abs() / 131_072.0, "{got:?} {exact:?}");
            slow += u32::from(got.t == exact.t);
        }
    }
    assert!(hits > cases(10_000) && slow > cases(1_000), "{hits} {slow}");
}

#[test]
fn front_is_where_the_corners_turn_left() {
    let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    for (z, d) in [(1.0, -2.0), (-1.0, 2.0_f32)] {
        for aim in [Vec3::new(0.25, 0.25, 0.0), Vec3::ZERO, Vec3::new(0.5, 0.0, 0.0)] {
            let ray = Ray::new(aim + Vec3::Z * z, Vec3::Z * d).prepare().unwrap();
            assert_eq!(triangle.intersect(&ray, 0.0, 9.0), Some(Crossing { t: 0.5, front: z > 0.0 }));
        }
    }
}

#[test]
fn rays_in_the_plane_and_triangles_without_area_miss() {
    let flat = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    let line = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::X * 2.0);
    let along = Ray::new(Vec3::new(-1.0, 0.25, 0.0), Vec3::X).prepare().unwrap();
    let across = Ray::new(Vec3::new(0.5, 0.0, 1.0), Vec3::NEG_Z).prepare().unwrap();
    assert_eq!(flat.intersect(&along, 0.0, 9.0), None);
    assert_eq!(line.intersect(&across, 0.0, 9.0), None);
}
