//! Placed twice: every query with masks at every level, and volumes in front of the structures within.

use super::{
    common::{Random, adversarial_mesh, adversarial_ray, plans},
    compare, place,
};
use hitscan::{
    Accelerator, Hit, Instance, Instances, List, Mesh, Primitives, Ray, Scene,
    accel::{Bounded, Structure},
    geometry::Bounding,
};

/// A mask of few bits, so that some meet and some do not.
fn mask(random: &mut Random) -> u32 {
    random.below(8) as u32
}

/// As `place`, with masks at random.
fn masked<'a, A: Accelerator, P: Primitives>(
    random: &mut Random,
    scenes: &'a [Scene<A, P>],
    placed: &'a mut Vec<Instance>,
) -> Instances<'a, A, P> {
    let numbered = place(random, 2, scenes, placed).placed().to_vec();
    *placed = numbered.into_iter().map(|instance| instance.with_mask(mask(random))).collect();
    Instances::new(scenes, placed).unwrap()
}

#[test]
fn masks_and_volumes_at_every_level_change_only_what_they_should() {
    let mut random = Random::new(14);
    let mut memories: [Vec<u32>; 3] = [(); 3].map(|()| vec![0; 1 << 15]);
    let (mut seen, mut hidden) = (0, 0);
    for _ in 0..1500 {
        let random = &mut random;
        let [a, b, c] = memories.each_mut();
        let (vertices, triangles) = adversarial_mesh(random, 2, 12);
        let masks: Vec<u32> = triangles.iter().map(|_| mask(random)).collect();
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap().with_masks(&masks).unwrap();
        let corners = triangles.iter().flatten().map(|&vertex| vertices[vertex as usize]);
        let Some(volume) = random.pick(&Bounding::ALL).around(corners) else { continue };
        let Some(structure) = built(random, &mesh, a) else { continue };
        let scenes = [Scene::new(Bounded::new(volume, structure), mesh).unwrap()];
        let (mut lower, mut upper) = (vec![], vec![]);
        let once = masked(random, &scenes, &mut lower);
        let Some(structure) = built(random, &once, b) else { continue };
        let once_scenes = [Scene::new(structure, once).unwrap()];
        let twice = masked(random, &once_scenes, &mut upper);
        let Some(structure) = built(random, &twice, c) else { continue };
        let scene = Scene::new(structure, twice).unwrap();

        // The same without structures, volumes and masks.
        let bare = Mesh::new(&vertices, &triangles[..]).unwrap();
        let bare_scenes = [Scene::new(List::new(&bare).unwrap(), bare).unwrap()];
        let unmasked = |placed: &[Instance]| placed.iter().map(|it| it.with_mask(u32::MAX)).collect::<Vec<_>>();
        let (lower, upper) = (unmasked(once.placed()), unmasked(twice.placed()));
        let bare_once = Instances::new(&bare_scenes, &lower).unwrap();
        let bare_scenes = [Scene::new(List::new(&bare_once).unwrap(), bare_once).unwrap()];
        let bare_twice = Instances::new(&bare_scenes, &upper).unwrap();
        let list = Scene::new(List::new(&bare_twice).unwrap(), bare_twice).unwrap();
        for _ in 0..20 {
            let ray = adversarial_ray(random, 2, &vertices).seeing(mask(random));
            let all: Vec<Hit> = list.hits(&Ray { mask: u32::MAX, ..ray }).collect();
            let is_seen = |hit: &Hit| {
                let (outer, number) = twice.locate(hit.primitive).unwrap();
                let (inner, triangle) = once.locate(number).unwrap();
                [twice.mask(outer), once.mask(inner), mesh.mask(triangle)].into_iter().all(|mask| mask & ray.mask != 0)
            };
            let expected: Vec<Hit> = all.iter().copied().filter(is_seen).collect();
            seen += expected.len();
            hidden += all.len() - expected.len();
            compare(&scene, &ray, &expected);
        }
    }
    assert!(seen > 3000 && hidden > 3000, "{seen} {hidden}");
}

/// A structure of any kind with any options.
fn built<'m, P: Primitives>(random: &mut Random, primitives: &P, memory: &'m mut [u32]) -> Option<Structure<'m>> {
    let kind = random.below(plans::KINDS);
    plans::build(random, kind, primitives, memory).map(|(_, structure)| structure)
}
