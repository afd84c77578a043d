//! Every structure returns bit for bit what the list returns.
#![allow(missing_docs)]

mod common;

use common::{
    FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed,
    memo::Memo,
    meshes::{self, Triangles},
    noise, plans, rays, seed,
};
use hitscan::{
    Arena, List, Mesh, Scene,
    accel::{Mailbox, Structure},
    from_fn,
    geometry::Aabb,
    glam::Vec3,
};

/// Rays are counted once for each structure that answers: each asks it for the closest hit, again with a mailbox, and for any.
#[test]
fn every_structure_answers_as_the_list() {
    let mut random = Random::new(1 + 100 * seed());
    let mut memory = vec![vec![0; 1 << 16]; plans::KINDS];
    let (mut cast, mut asked, mut hits, mut words, mut structures) = (0, 0, 0, 0, 0);
    while asked < rays(6_000_000) {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        // What a triangle said to a ray is remembered, in most scenes.
        let memo = Memo::new(Mesh::new(&vertices, &triangles[..]).unwrap(), !random.one_in(16));
        // Some scenes hold shapes that may not be clipped.
        let number = random.pick(&[0, 0, 12]);
        let boxes: Vec<Aabb> = (0..number).map(|_| boxed(&mut random, family)).collect();
        let both = (&memo, from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i, ray))));
        let corners: Vec<Vec3> =
            boxes.iter().flat_map(|b| [b.min, b.max, b.center()]).chain(vertices.iter().copied()).collect();
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let built: Vec<_> = (0..plans::KINDS)
            .zip(&mut memory)
            .filter_map(|(kind, memory)| plans::build(&mut random, kind, &both, memory))
            .collect();
        let opened = built.iter().map(|(plan, built)| {
            let opened = Structure::open(built.kind().unwrap(), built.as_words()).unwrap();
            (plan, Scene::new(opened, &both).unwrap(), Scene::new(Mailbox(opened), &both).unwrap())
        });
        let scenes: Vec<_> = opened.collect();
        structures += built.len();
        words += built.iter().map(|(_, built)| built.as_words().len()).sum::<usize>();
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &corners);
            memo.forget();
            let expected = list.closest_hit(&ray);
            cast += 1;
            asked += scenes.len();
            hits += usize::from(expected.is_some());
            for (plan, scene, mailbox) in &scenes {
                assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{ray:?} {plan:?} {vertices:?} {boxes:?}");
                assert_eq!(bits(mailbox.closest_hit(&ray)), bits(expected), "{ray:?} {plan:?} {vertices:?} {boxes:?}");
                assert_eq!(scene.any_hit(&ray), expected.is_some(), "{ray:?} {plan:?} {vertices:?} {boxes:?}");
            }
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(asked > cast * 5 && words > structures * 40, "{asked} of {cast}, {words} words in {structures} structures");
    println!("{cast} rays, {asked} answers by structures, {structures} of them");
}

/// Casts rays at a large mesh under every preset; only some of them at the list, too, which takes its time. Rays are counted
/// once for each preset.
fn compare_large(name: &str, (vertices, triangles): &Triangles, answers: usize) {
    let mesh = Mesh::new(vertices, &triangles[..]).unwrap();
    let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    let presets = plans::presets();
    let mut memories: Vec<Vec<u32>> = presets.iter().map(|(_, plan)| vec![0; plan.words(triangles.len())]).collect();
    let scenes: Vec<_> = presets
        .iter()
        .zip(&mut memories)
        .map(|((_, plan), memory)| Structure::build(&mesh, &mut Arena::new(memory), plan).unwrap())
        .map(|structure| Scene::new(structure, &mesh).unwrap())
        .collect();
    let mut random = Random::new(vertices.len() as u64 + 1000 * seed());
    let mut hits = 0;
    let rays = answers / presets.len();
    for cast in 0..rays {
        let ray = adversarial_ray(&mut random, 2, vertices);
        let expected = if cast % 200 == 0 { list.closest_hit(&ray) } else { scenes[0].closest_hit(&ray) };
        hits += usize::from(expected.is_some());
        for (scene, (preset, _)) in scenes.iter().zip(&presets) {
            assert_eq!(bits(scene.closest_hit(&ray)), bits(expected), "{name} {preset} {ray:?}");
        }
    }
    assert!(hits * 4 > rays, "{name}: {hits} of {rays}");
}

#[test]
fn every_preset_answers_as_the_list_over_large_scenes() {
    let large = [
        ("sheet", meshes::sheet(60)),
        ("random", meshes::random(6000, 0.2)),
        ("fan", meshes::fan(500)),
        ("hair", meshes::hair(500)),
        ("identical", meshes::identical(500)),
        ("shrinking", meshes::shrinking(1000)),
    ];
    let each = rays(280_000) / large.len();
    large.iter().for_each(|(name, triangles)| compare_large(name, triangles, each));
}
