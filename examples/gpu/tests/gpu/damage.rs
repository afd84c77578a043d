use hitscan::{
    Mesh,
    accel::{Plan, Structure},
    asset::Asset,
    bake::{self, Baker},
    glam::Vec3,
    grid, octree,
};
use hitscan_gpu::{Layout, Parts, Unfit, World};

use crate::{
    common::meshes,
    scene::{Form, baker, plans},
};

/// A sum over all words but the fifth, as an asset has it.
fn checksum(words: &[u32]) -> u32 {
    let summed = words.iter().enumerate().filter(|(index, _)| *index != 4);
    summed.fold(0x811c_9dc5, |sum, (_, word)| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}

/// Whether the library refuses an asset before anything is uploaded.
fn is_refused(words: &[u32]) -> bool {
    let Ok(asset) = Asset::from_words(words) else { return true };
    let Ok(parts) = Parts::read(&asset) else { return true };
    World::read(&asset, &parts).is_err()
}

#[test]
fn damaged_assets_are_refused_before_they_are_uploaded() {
    let (vertices, triangles) = meshes::random(50, 0.3);
    for plan in plans() {
        let words = baker(&vertices, &triangles, &plan, Form::Plain).unwrap().finish();
        assert!(!is_refused(&words));
        for end in 0..words.len() {
            assert!(is_refused(&words[..end]));
        }
        let mut mended = 0;
        for index in 0..words.len() {
            let mut damaged = words.clone();
            damaged[index] ^= 1 << (index % 32);
            assert!(is_refused(&damaged), "{index}");
            // With the right checksum, links and numbers that lead outside are still found.
            damaged[index] = u32::MAX;
            damaged[4] = checksum(&damaged);
            mended += usize::from(is_refused(&damaged));
        }
        assert!(mended * 10 > words.len(), "{mended} of {}", words.len());
    }
}

#[test]
fn what_shaders_do_not_know_is_refused() {
    let (vertices, triangles) = meshes::random(50, 0.3);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for plan in [Plan::Grid(grid::Options::default()), Plan::Octree(octree::Options::default())] {
        let words = bake::build(&mesh, &plan).unwrap();
        let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
        let words = Baker::new().mesh(&mesh).structure(structure).finish();
        let asset = Asset::from_words(&words).unwrap();
        assert_eq!(Layout::of(&asset).unwrap_err(), Unfit::Structure);
    }
    let quads = bake::quads(&bake::pairs(&mesh).corners[..]).unwrap();
    let moved = quads.vertices(&vertices);
    let pairs = Mesh::new(&moved, quads.indices()).unwrap();
    let words = bake::build(&pairs, &plans()[0]).unwrap();
    let structure = Structure::open(plans()[0].kind().unwrap(), &words).unwrap();
    let words = Baker::new().mesh(&pairs).structure(structure).finish();
    let asset = Asset::from_words(&words).unwrap();
    assert_eq!(Layout::of(&asset).unwrap_err(), Unfit::Pairs);
    assert!(World::read(&asset, &Parts::read(&asset).unwrap()).unwrap_err().to_string().contains("without --quads"));
    let far = [Vec3::ZERO, Vec3::X * 3.0e10, Vec3::Y];
    let words = baker(&far, &[[0, 1, 2]], &plans()[0], Form::Plain).unwrap().finish();
    let refused = Layout::of(&Asset::from_words(&words).unwrap()).unwrap_err();
    assert_eq!(refused, Unfit::Range { coordinate: 3.0e10 });
}
