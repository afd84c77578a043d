//! Trees whose walks have lower stacks: as high as they are deep is enough, and less is refused.

use crate::common::meshes::random;
use crate::common::{Random, adversarial_ray, bits};
use hitscan::{
    Accelerator, Arena, CompactKdTree, DualSplit, Error, Hit, KdTree, LatticeMesh, LatticeScene, List, Mesh,
    Primitives, Ray, Scene,
    accel::{LatticeAccelerator, Malformed, Reason},
    asset::{Asset, Kind},
    bake::{self, Baker},
    dualsplit, kdtree,
};

/// Compares a tree's answers with the list's.
fn compare<A: Accelerator + Copy>(tree: A, mesh: &LatticeMesh) {
    let (scene, list) = (Scene::new(tree, mesh).unwrap(), Scene::new(List::new(mesh).unwrap(), mesh).unwrap());
    same(mesh, |ray| scene.closest_hit(ray), |ray| list.closest_hit(ray));
}

/// The same, and those in whole numbers.
fn compare_both<A: Accelerator + LatticeAccelerator + Copy>(tree: A, mesh: &LatticeMesh) {
    compare(tree, mesh);
    let scene = LatticeScene::new(tree, mesh).unwrap();
    let list = LatticeScene::new(List::new(mesh).unwrap(), mesh).unwrap();
    same(mesh, |ray| scene.closest_hit(ray), |ray| list.closest_hit(ray));
}

/// Whether two scenes answer alike.
fn same(mesh: &LatticeMesh, found: impl Fn(&Ray) -> Option<Hit>, expected: impl Fn(&Ray) -> Option<Hit>) {
    let corners: Vec<_> = mesh.positions().collect();
    let (mut random, mut hits) = (Random::new(9), 0);
    for _ in 0..2_000 {
        let ray = adversarial_ray(&mut random, 2, &corners);
        let expected = expected(&ray);
        assert_eq!(bits(found(&ray)), bits(expected), "{ray:?}");
        hits += u32::from(expected.is_some());
    }
    assert!(hits > 100, "{hits}");
}

/// The error of an asset whose tree is deeper than its reader's stack.
fn too_deep(structure: Kind, word: usize) -> Error {
    Malformed { structure, word, reason: Reason::Depth }.into()
}

macro_rules! heights {
    ($tree:expr, $type:ident, $mesh:expr, $asset:expr, $word:expr, $compare:ident, $($height:literal)*) => {
        let deep = $tree.depth() as usize;
        $(
            match $tree.for_height::<$height>() {
                Some(tree) => {
                    assert!(deep <= $height);
                    if deep == $height {
                        $compare(tree, $mesh);
                    }
                    assert_eq!($asset.read::<$type<'_, $height>>().unwrap().as_words(), $tree.as_words());
                }
                None => {
                    assert!(deep > $height);
                    let error = $asset.read::<$type<'_, $height>>().map(|_| ()).unwrap_err();
                    assert_eq!(error, too_deep(Kind::$type, $word));
                }
            }
        )*
        assert!((6..=24).contains(&deep), "{deep}");
    };
}

#[test]
fn as_high_as_deep_is_enough() {
    let (vertices, triangles) = random(300, 0.3);
    let snapped = bake::lattice(&Mesh::new(&vertices, &triangles[..]).unwrap());
    let mesh = &snapped.mesh(&triangles[..]).unwrap();
    let mut memory = vec![0; 1 << 17];
    let mut arena = Arena::new(&mut memory);
    let tree = DualSplit::build(mesh, &mut arena, &dualsplit::Options::fast()).unwrap();
    let baked = Baker::new().lattice_mesh(mesh).structure(tree).finish();
    let asset = Asset::from_words(&baked).unwrap();
    heights!(tree, DualSplit, mesh, asset, 2, compare_both, 0 1 5 6 7 8 9 10 11 12 13 14 15 16 24);
    let tree = CompactKdTree::build(mesh, &mut arena, &kdtree::Options::balanced()).unwrap();
    let baked = Baker::new().lattice_mesh(mesh).structure(tree).finish();
    let asset = Asset::from_words(&baked).unwrap();
    heights!(tree, CompactKdTree, mesh, asset, 3, compare_both, 0 1 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 24);
    let tree = KdTree::build(mesh, &mut arena, &kdtree::Options::balanced()).unwrap();
    let baked = Baker::new().lattice_mesh(mesh).structure(tree).finish();
    let asset = Asset::from_words(&baked).unwrap();
    heights!(tree, KdTree, mesh, asset, 3, compare, 0 1 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 24);
    assert_eq!(mesh.len(), 300);
}
