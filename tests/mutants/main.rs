//! Each rule of exactness is needed: broken alone, the tree answers other than the list, and the fuzz sees it.
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;
mod walk;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, boxed, noise};
use hitscan::{
    Arena, KdTree, List, Mesh, Primitives, Ray, Scene, from_fn,
    glam::Vec3,
    kdtree::{Options, Split},
};
use walk::{Mutant, Shape, Walker};

/// Calls `check` with scenes, their trees and rays, until it is satisfied or `rays` were cast; how many were.
fn fuzz(
    rays: usize,
    mut check: impl FnMut(&[Shape], &KdTree, &dyn Fn(&Ray) -> [Option<(u32, u32)>; 2], &Ray) -> bool,
) -> Option<usize> {
    let mut random = Random::new(8);
    let mut memory = vec![0; 1 << 15];
    let mut cast = 0;
    loop {
        let family = random.below(FAMILIES);
        let (mut vertices, triangles) = adversarial_mesh(&mut random, family, 16);
        let boxes: Vec<_> = (0..random.below(2) * random.below(12)).map(|_| boxed(&mut random, family)).collect();
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let first = mesh.len();
        let shapes: Vec<Shape> = (0..first)
            .map(|i| Shape::Triangle(mesh.triangle(i)))
            .chain(boxes.iter().map(|&aabb| Shape::Noise(aabb)))
            .collect();
        let others = from_fn(boxes.len() as u32, |i| boxes[i as usize], |i, ray| Some(noise(i + first, ray)));
        let both = (mesh, others);
        let options = Options {
            split: random.pick(&[Split::Midpoint, Split::Median, Split::Sah]),
            intersection_cost: random.pick(&[1.0, 20.0]),
            clip: !random.one_in(4),
            ..Options::fast()
        };
        let tree = KdTree::build(&both, &mut Arena::new(&mut memory), &options).unwrap();
        let scene = Scene::new(tree, &both).unwrap();
        let list = Scene::new(List::new(&both).unwrap(), &both).unwrap();
        let library = |ray: &Ray| [bits(list.closest_hit(ray)), bits(scene.closest_hit(ray))];
        let corners: Vec<Vec3> =
            vertices.iter().copied().chain(boxes.iter().flat_map(|b| [b.min, b.max, b.center()])).collect();
        for _ in 0..100 {
            let ray = adversarial_ray(&mut random, family, &corners);
            cast += 1;
            if check(&shapes, &tree, &library, &ray) {
                return Some(cast);
            }
            if cast >= rays {
                return None;
            }
        }
        vertices.clear();
    }
}

#[test]
fn the_right_rules_answer_as_the_library() {
    let none = fuzz(200_000, |shapes, tree, library, ray| {
        let walker = || Walker::new(Mutant::Right, shapes, ray);
        let list = bits(walker().and_then(Walker::list));
        let walked = bits(walker().and_then(|walker| walker.tree(tree.as_words())));
        assert_eq!(library(ray), [list, walked], "{ray:?} {shapes:?}");
        false
    });
    assert!(none.is_none());
}

#[test]
fn every_mutant_is_caught() {
    for mutant in [
        Mutant::ContainmentForOverflow,
        Mutant::CutExitsForOverflow,
        Mutant::OverflowReachesBack,
        Mutant::NoWidening,
        Mutant::FactorOnly,
        Mutant::NoTiny,
        Mutant::ThinSlack,
        Mutant::NanSkips,
        Mutant::EnterAtExit,
        Mutant::PruneAtBest,
        Mutant::NoClamp,
        Mutant::RejectAtBest,
    ] {
        let mut only_triangles = None;
        let mut count = 0;
        let caught = fuzz(3_000_000, |shapes, tree, _, ray| {
            let walker = || Walker::new(mutant, shapes, ray);
            let list = bits(walker().and_then(Walker::list));
            let walked = bits(walker().and_then(|walker| walker.tree(tree.as_words())));
            count += 1;
            if list != walked && only_triangles.is_none() && shapes.iter().all(|s| matches!(s, Shape::Triangle(_))) {
                only_triangles = Some(count);
            }
            list != walked
        });
        println!("{mutant:?}: {caught:?} {only_triangles:?}");
    }
}
