//! The whole way of a ray in a size that an interpreter can go: for undefined behaviour, not for answers.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, plans};
use hitscan::{
    Arena, List, Mesh, Scene,
    accel::{Mailbox, Structure},
    asset::Asset,
    bake::Baker,
};

#[test]
fn built_baked_opened_and_walked() {
    let mut random = Random::new(4);
    let mut memory = [0; 6000];
    for kind in 0..plans::KINDS {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 8);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let plan = plans::random(&mut random, kind);
        let mut arena = Arena::new(&mut memory);
        let first = Structure::build(&mesh, &mut arena, &plan).unwrap();
        let second = Structure::build(&mesh, &mut arena, &plan).unwrap();
        assert_eq!(first.as_words(), second.as_words());
        let words = Baker::new().mesh(&mesh).structure(first).finish();
        if cfg!(target_endian = "big") {
            assert!(Asset::from_words(&words).is_err());
            continue;
        }
        let scene: Scene<Structure, Mesh> = Asset::from_words(&words).unwrap().scene().unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
        let mailbox = Scene::new(Mailbox(*scene.accelerator()), mesh).unwrap();
        for _ in 0..4 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            assert_eq!(mailbox.closest_hit(&ray), list.closest_hit(&ray));
            assert!(scene.hits(&ray).eq(list.hits(&ray)));
            assert_eq!(scene.nearest_point(ray.origin, 9.0), list.nearest_point(ray.origin, 9.0));
        }
    }
}
