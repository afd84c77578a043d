//! The whole way of a ray in a size that an interpreter can go: for undefined behaviour, not for answers.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray};
use hitscan::{
    Arena, KdTree, List, Mesh, Scene,
    asset::Asset,
    bake::Baker,
    kdtree::{Options, Split},
};

#[test]
fn built_baked_opened_and_walked() {
    let mut random = Random::new(4);
    let mut memory = [0; 2500];
    for split in [Split::Midpoint, Split::Median, Split::Sah] {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 8);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let mut arena = Arena::new(&mut memory);
        let options = Options { split, ..Options::fast() };
        let first = KdTree::build(&mesh, &mut arena, &options).unwrap();
        let second = KdTree::build(&mesh, &mut arena, &options).unwrap();
        assert_eq!(first.as_words(), second.as_words());
        let words = Baker::new().mesh(&mesh).structure(first).finish();
        if cfg!(target_endian = "big") {
            assert!(Asset::from_words(&words).is_err());
            continue;
        }
        let scene: Scene<KdTree, Mesh> = Asset::from_words(&words).unwrap().scene().unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
        for _ in 0..6 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            assert_eq!(scene.closest_hit(&ray), list.closest_hit(&ray));
            assert!(scene.hits(&ray).eq(list.hits(&ray)));
        }
    }
}
