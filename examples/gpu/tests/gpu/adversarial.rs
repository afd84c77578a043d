use hitscan::{Ray, glam::Vec3};

use crate::{
    common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, meshes},
    scene::{Form, baker, compare, device, plans},
};

#[test]
fn adversarial_scenes_are_answered_as_by_the_library() {
    let Some(device) = device() else { return };
    let mut random = Random::new(11);
    let (mut scenes, mut rays, mut finished) = (0, 0, 0);
    for round in 0..90 {
        let family = round % FAMILIES;
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 40);
        let form = Form::ALL[round / 3 % 4];
        let Some(baker) = baker(&vertices, &triangles, &plans()[round % 3], form) else { continue };
        let batch: Vec<Ray> = (0..400).map(|_| adversarial_ray(&mut random, family, &vertices)).collect();
        if let Some(tally) = compare(device, &baker.finish(), &batch, None) {
            scenes += 1;
            rays += tally.rays;
            finished += tally.finished;
        }
    }
    assert!(scenes > 40, "{scenes}");
    // Most of these rays are at corners, edges and ties, or invalid.
    println!("{scenes} scenes, {rays} rays, {finished} finished by the library");
    assert!(finished * 100 < rays * 95, "{finished} of {rays}");
}

/// Rays from around a box at points in it.
pub fn rays_at(random: &mut Random, size: f32, count: usize) -> Vec<Ray> {
    let mut point = |size: f32| Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * size));
    (0..count)
        .map(|_| {
            let (origin, target) = (point(size * 3.0), point(size));
            Ray::new(origin, target - origin)
        })
        .collect()
}

#[test]
fn ordinary_rays_are_certain() {
    let Some(device) = device() else { return };
    let mut random = Random::new(5);
    let (vertices, triangles) = meshes::random(3000, 0.1);
    let rays = rays_at(&mut random, 1.0, 4000);
    for plan in plans() {
        for form in Form::ALL {
            let words = baker(&vertices, &triangles, &plan, form).unwrap().finish();
            let tally = compare(device, &words, &rays, None).unwrap();
            let most = if form == Form::OnLattice { 20 } else { 10 };
            assert!(tally.finished * 1000 < tally.rays * most, "{plan:?} {form:?} {tally:?}");
        }
    }
}

#[test]
fn there_are_scenes_without_triangles_and_batches_without_rays() {
    let Some(device) = device() else { return };
    let rays = rays_at(&mut Random::new(1), 1.0, 10);
    for plan in plans() {
        let empty = baker(&[], &[], &plan, Form::Plain).unwrap().finish();
        let tally = compare(device, &empty, &rays, None).unwrap();
        assert_eq!(tally.finished, 0);
        let one = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let words = baker(&one, &[[0, 1, 2]], &plan, Form::Plain).unwrap().finish();
        assert_eq!(compare(device, &words, &[], None).unwrap().rays, 0);
        compare(device, &words, &rays, None).unwrap();
    }
}

#[test]
fn invalid_and_extreme_rays_are_the_librarys() {
    let Some(device) = device() else { return };
    let (vertices, triangles) = meshes::random(300, 0.3);
    let words = baker(&vertices, &triangles, &plans()[0], Form::Plain).unwrap().finish();
    let good = Ray::new(Vec3::new(0.1, 0.2, -3.0), Vec3::new(0.0, 0.01, 1.0));
    let strange = [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, 1.0e-40, -0.0, 1.0e-30, 1.0e20];
    let mut rays = vec![good, good.seeing(0), good.seeing(2), good.starting_at(5.0).up_to(1.0)];
    for x in strange {
        rays.extend([
            Ray { origin: good.origin.with_x(x), ..good },
            Ray { direction: good.direction.with_x(x), ..good },
            Ray { direction: Vec3::splat(x), ..good },
            good.starting_at(x),
            good.up_to(x),
        ]);
    }
    let tally = compare(device, &words, &rays, None).unwrap();
    assert!(tally.finished > 0 && tally.finished < tally.rays);
}
