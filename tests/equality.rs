//! Every structure returns bit for bit what the list returns.
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray};
use hitscan::{
    Arena, KdTree, List, Mesh, Scene,
    kdtree::{Options, Split},
};

fn rays() -> usize {
    std::env::var("HITSCAN_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}

fn options(random: &mut Random) -> Options {
    let preset = random.pick(&[Options::small(), Options::balanced(), Options::fast()]);
    Options {
        split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah, Split::Sah]),
        leaf_size: random.pick(&[1, 1, 2, 4]),
        max_depth: random.pick(&[None, None, Some(3), Some(40)]),
        intersection_cost: random.pick(&[preset.intersection_cost, 2.0, 20.0]),
        clip: !random.one_in(4),
        max_bytes: random.pick(&[None, None, Some(300)]),
        ..preset
    }
}

#[test]
fn kd_trees_answer_as_the_list() {
    let mut random = Random::new(1);
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut hits, mut nodes, mut scenes) = (0, 0, 0, 0);
    while cast < rays() {
        let family = random.below(FAMILIES);
        let (vertices, triangles) = adversarial_mesh(&mut random, family, 48);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let options = options(&mut random);
        let tree = match KdTree::build(&mesh, &mut Arena::new(&mut memory), &options) {
            Ok(tree) => tree,
            Err(error) => panic!("{error}: {options:?}"),
        };
        scenes += 1;
        nodes += tree.node_count();
        let tree = Scene::new(KdTree::open(tree.as_words()).unwrap(), &mesh).unwrap();
        for _ in 0..240 {
            let ray = adversarial_ray(&mut random, family, &vertices);
            let expected = list.closest_hit(&ray);
            let got = tree.closest_hit(&ray);
            cast += 1;
            hits += usize::from(expected.is_some());
            assert_eq!(
                got.map(|hit| (hit.t.to_bits(), hit.primitive)),
                expected.map(|hit| (hit.t.to_bits(), hit.primitive)),
                "{ray:?} {options:?} {vertices:?}"
            );
            assert_eq!(tree.any_hit(&ray), expected.is_some(), "{ray:?} {options:?} {vertices:?}");
        }
    }
    assert!(hits * 4 > cast, "{hits} of {cast}");
    // Single leaves would be equal, too.
    assert!(scenes >= cast / 240 && nodes > scenes * 10, "{nodes} nodes in {scenes} scenes");
}
