//! Assets: what is baked is read back, and no bytes make the reader panic or a walk run on.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{
    Random, adversarial_mesh, adversarial_ray, plans, point,
    seal::{checksum, every_byte, place, sealed},
};
use hitscan::{
    Error, Instance, Instances, KdTree, List, Mesh, Ray, Scene,
    accel::{Plan, Reason, Structure},
    asset::{Asset, AssetError, Kind},
    bake::{self, Baker},
    bvh, dualsplit,
    geometry::{Sphere, Transform},
    glam::{Mat3, Vec3},
    kdtree::Options,
    primitives::{Normals, Reordered, Smooth, Spheres},
    query::Progress,
    render::{Material, Materials, Numbers},
};

fn soup(seed: u64, most: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    adversarial_mesh(&mut Random::new(seed), 2, most)
}

fn baked(seed: u64, most: usize, options: &Options) -> Vec<u32> {
    let (vertices, triangles) = soup(seed, most);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let tree = bake::build(&mesh, &Plan::KdTree(*options)).unwrap();
    Baker::new().mesh(&mesh).structure(KdTree::open(&tree).unwrap()).finish()
}

/// Opens everything, and if it opens, walks it: the walk must end within the nodes.
fn exercise(words: &[u32]) -> Result<(), Error> {
    let asset = Asset::from_words(words)?;
    let scene: Scene<KdTree, Mesh> = asset.scene()?;
    let nodes = scene.accelerator().node_count() as u32;
    let mut random = Random::new(9);
    for _ in 0..4 {
        let ray = Ray::new(point(&mut random, 2), point(&mut random, 2));
        assert!(matches!(scene.begin(&ray).advance(nodes), Progress::Done(_)), "the walk visits a node twice");
    }
    Ok(())
}

#[test]
fn what_is_baked_is_read_back() {
    let (vertices, triangles) = soup(3, 60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let spheres = [Sphere::new(Vec3::ONE, 2.0), Sphere::new(Vec3::ZERO, 0.5)];
    let both = (mesh, Spheres::new(&spheres).unwrap());
    let words = bake::build(&both, &Plan::KdTree(Options::balanced())).unwrap();
    let tree = KdTree::open(&words).unwrap();
    let palette = [Material::matte(Vec3::X), Material::default()];
    let numbers: Vec<u8> = (0..tree_len(&both)).map(|i| (i % 2) as u8).collect();
    let baker = Baker::new().mesh(&mesh).spheres(&spheres).structure(tree);
    let asset_words = baker.materials(&palette, Numbers::Narrow(&numbers)).finish();

    let bytes: &[u8] = bytemuck::cast_slice(&asset_words);
    let asset = Asset::open(bytes).unwrap();
    let kinds: Vec<Kind> = asset.sections().map(|section| section.kind).collect();
    let expected =
        [Kind::Vertices, Kind::NarrowIndices, Kind::Spheres, Kind::KdTree, Kind::Materials, Kind::MaterialNumbers];
    assert_eq!(kinds, expected);
    let scene: Scene<KdTree, (Mesh, Spheres)> = asset.scene().unwrap();
    let original = Scene::new(tree, &both).unwrap();
    let mut random = Random::new(5);
    for _ in 0..20_000 {
        let ray = adversarial_ray(&mut random, 2, &vertices);
        assert_eq!(scene.closest_hit(&ray), original.closest_hit(&ray));
    }
    let materials: Materials = asset.read().unwrap();
    assert_eq!(materials.of(0), palette[0]);
    assert_eq!(materials.of(1), palette[1]);
}

#[test]
fn normals_are_baked_and_shade() {
    let vertices: Vec<Vec3> = (0..169).map(|i| Vec3::new((i % 13) as f32, (i / 13) as f32, 0.0)).collect();
    let corner = |i: u16| i / 12 * 13 + i % 12;
    let triangles: Vec<[u16; 3]> = (0..144).map(|i| [corner(i), corner(i) + 1, corner(i) + 13]).collect();
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let normals: Vec<Vec3> = vertices.iter().map(|at| (Vec3::Z * 20.0 + *at).normalize()).collect();
    let baked = Baker::new().mesh(&mesh).normals(&normals).finish();
    let flat = Baker::new().mesh(&mesh).finish();
    let bytes = (baked.len() - flat.len()) * 4;
    assert!(bytes <= vertices.len() * 2 + 4 + 16 + 16 + 8, "{bytes} for {} vertices", vertices.len());

    let asset = Asset::from_words(&baked).unwrap();
    let scene: Scene<List, Smooth> = Scene::new(List::new(&mesh).unwrap(), asset.read().unwrap()).unwrap();
    let original = Scene::new(List::new(&mesh).unwrap(), Smooth::new(mesh, &normals)).unwrap();
    let (mut random, mut blended) = (Random::new(8), 0);
    for _ in 0..2_000 {
        let inside = Vec3::new(random.unit() * 0.5, random.unit() * 0.5, 3.0);
        let ray = Ray::new(random.pick(&vertices) + inside, Vec3::NEG_Z);
        let hit = scene.closest_hit(&ray);
        assert_eq!(hit, original.closest_hit(&ray));
        let Some(hit) = hit else { continue };
        let (packed, plain) = (scene.surface(&ray, &hit), original.surface(&ray, &hit));
        assert!(packed.shading_normal.dot(plain.shading_normal) > 0.9998, "{packed:?} {plain:?}");
        blended += u32::from(packed.shading_normal != packed.geometric_normal);
    }
    assert!(blended > 500, "{blended}");
    let stored: Normals = asset.read().unwrap();
    assert!(stored.len() == 169 && !stored.is_empty());
    assert!(Asset::from_words(&Baker::new().normals(&[]).finish()).unwrap().read::<Normals>().unwrap().is_empty());
    assert!(Asset::from_words(&flat).unwrap().read::<Smooth>().is_err());

    // Counts that are not those of the words.
    let section = asset.sections().find(|section| section.kind == Kind::Normals).unwrap();
    let start = baked.windows(section.words.len()).position(|words| words == section.words).unwrap();
    for count in [0, section.words[0] - 2, section.words[0] + 3, u32::MAX] {
        let mut words = baked.clone();
        words[start] = count;
        let words = sealed(words);
        let error = Asset::from_words(&words).unwrap().read::<Smooth>().unwrap_err();
        assert!(matches!(error, Error::Asset(AssetError::Shape { kind: Kind::Normals, .. })), "{count}: {error}");
    }
}

fn tree_len(primitives: &impl hitscan::Primitives) -> u32 {
    primitives.len()
}

#[test]
fn baking_gives_the_same_bytes_everywhere() {
    // Coordinates that every target computes alike.
    let height = |x: usize, z: usize| ((x * 7 + z * 5) % 11) as f32 / 8.0;
    let vertices: Vec<Vec3> =
        (0..169).map(|i| Vec3::new((i % 13) as f32, height(i % 13, i / 13), (i / 13) as f32)).collect();
    let corner = |i: u16| i / 12 * 13 + i % 12;
    let triangles: Vec<[u16; 3]> = (0..144)
        .flat_map(|i| [[corner(i), corner(i) + 1, corner(i) + 13], [corner(i) + 1, corner(i) + 14, corner(i) + 13]])
        .collect();
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let sums: Vec<u32> = plans::presets()
        .iter()
        .map(|(_, plan)| {
            let words = bake::build(&mesh, plan).unwrap();
            checksum(&Baker::new().mesh(&mesh).structure(opened(plan, &words)).finish())
        })
        .collect();
    assert_eq!(sums, SUMS);
}

/// Of the presets; they change when a format or a preset does.
const SUMS: [u32; 23] = [
    804_788_947,
    569_402_995,
    1_530_657_290,
    1_321_072_616,
    2_641_797_280,
    1_240_573_915,
    4_217_982_332,
    1_838_739_061,
    1_838_739_061,
    717_152_610,
    435_669_169,
    3_717_236_517,
    3_930_788_390,
    3_930_788_390,
    4_237_771_640,
    4_112_365_742,
    1_940_061_394,
    1_969_505_282,
    2_536_439_377,
    3_054_402_739,
    3_518_396_112,
    3_518_396_112,
    780_055_146,
];

fn opened<'a>(plan: &Plan, words: &'a [u32]) -> Structure<'a> {
    Structure::open(plan.kind().unwrap(), words).unwrap()
}

#[test]
fn every_structure_is_read_back() {
    let (vertices, triangles) = soup(4, 60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for (name, plan) in plans::presets() {
        let words = bake::build(&mesh, &plan).unwrap();
        let structure = opened(&plan, &words);
        let asset_words = Baker::new().mesh(&mesh).structure(structure).finish();
        let asset = Asset::from_words(&asset_words).unwrap();
        let scene = asset.scene::<Structure, Mesh>().unwrap();
        let original = Scene::new(structure, &mesh).unwrap();
        let mut random = Random::new(5);
        for _ in 0..300 {
            let ray = adversarial_ray(&mut random, 2, &vertices);
            assert_eq!(scene.closest_hit(&ray), original.closest_hit(&ray), "{name}");
        }
        assert!(Structure::open(Kind::Vertices, &words).is_err());
    }
}

#[test]
fn reordered_triangles_keep_their_numbers_if_they_are_stored() {
    let (vertices, triangles) = soup(6, 60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let original = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
    for plan in [Plan::Bvh(bvh::Options::balanced()), Plan::DualSplit(dualsplit::Options::balanced())] {
        let words = bake::build(&mesh, &plan).unwrap();
        let (words, order) = bake::ordered(&opened(&plan, &words)).unwrap();
        let corners = bake::reorder(&mesh, &order);
        let reordered = Mesh::new(&vertices, &corners[..]).unwrap();
        let baker = Baker::new().mesh(&reordered).structure(opened(&plan, &words));
        let asset_words = baker.numbers(&order).finish();
        let asset = Asset::from_words(&asset_words).unwrap();
        let (plain, numbered) =
            (asset.scene::<Structure, Mesh>().unwrap(), asset.scene::<Structure, Reordered<Mesh>>().unwrap());
        let list = Scene::new(List::new(&reordered).unwrap(), &reordered).unwrap();
        let mut random = Random::new(5);
        for _ in 0..3000 {
            let ray = adversarial_ray(&mut random, 2, &vertices);
            assert_eq!(plain.closest_hit(&ray), list.closest_hit(&ray));
            let hit = numbered.closest_hit(&ray);
            assert_eq!(hit, original.closest_hit(&ray));
            assert!(numbered.hits(&ray).eq(original.hits(&ray)));
            if let Some(hit) = hit {
                assert_eq!(numbered.surface(&ray, &hit), original.surface(&ray, &hit));
            }
        }
        // What is not a permutation is refused.
        let first = place(&asset_words, asset.section(Kind::Numbers).unwrap()) + 1;
        let mut damaged = asset_words.clone();
        damaged[first] ^= 1;
        let damaged = sealed(damaged);
        let refused = Asset::from_words(&damaged).unwrap().scene::<Structure, Reordered<Mesh>>();
        assert!(matches!(refused, Err(Error::Order(_))));
    }
}

#[test]
fn placed_scenes_are_read_back() {
    let (vertices, triangles) = soup(7, 30);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let plan = Plan::KdTree(Options::balanced());
    let words = bake::build(&mesh, &plan).unwrap();
    let scenes = [Scene::new(KdTree::open(&words).unwrap(), mesh).unwrap()];
    let at = |i: i32| Transform::new(Mat3::from_rotation_y(i as f32), Vec3::splat(i as f32)).unwrap();
    let mut placed: Vec<Instance> = (0..5).map(|i| Instance::new(0, at(i))).collect();
    let instances = Instances::place(&scenes, &mut placed).unwrap();
    let top = bake::build(&instances, &plan).unwrap();
    let part = Baker::new().mesh(&mesh).structure(*scenes[0].accelerator());
    let baker = Baker::new().part(part).instances(instances.placed()).structure(KdTree::open(&top).unwrap());
    let asset_words = baker.finish();

    let asset = Asset::from_words(&asset_words).unwrap();
    let parts: Vec<_> = asset.parts().map(|part| part.unwrap().scene::<KdTree, Mesh>().unwrap()).collect();
    let read = Instances::new(&parts, asset.read::<&[Instance]>().unwrap()).unwrap();
    let scene = Scene::new(asset.read::<KdTree>().unwrap(), read).unwrap();
    let original = Scene::new(List::new(&instances).unwrap(), instances).unwrap();
    let mut random = Random::new(5);
    let mut hits = 0;
    for _ in 0..3000 {
        let ray = adversarial_ray(&mut random, 2, &vertices);
        hits += usize::from(scene.closest_hit(&ray).is_some());
        assert_eq!(scene.closest_hit(&ray), original.closest_hit(&ray));
    }
    assert!(hits > 1000, "{hits}");
    // Numbers that belong to other scenes.
    assert!(Instances::new(&parts[..0], asset.read::<&[Instance]>().unwrap()).is_err());
}

#[test]
fn every_truncation_and_every_extension_is_refused() {
    let words = baked(1, 12, &Options::fast());
    let bytes: Vec<u8> = bytemuck::cast_slice(&words).to_vec();
    for length in 0..bytes.len() {
        // Aligned as the whole is.
        let mut memory = vec![0_u32; length.div_ceil(4)];
        let copy: &mut [u8] = bytemuck::cast_slice_mut(&mut memory);
        copy[..length].copy_from_slice(&bytes[..length]);
        assert!(Asset::open(&copy[..length]).is_err(), "{length}");
        if length % 4 == 0 && length >= 24 {
            // Even if the length and the sum were made to fit.
            let mut words = memory.clone();
            words[3] = words.len() as u32;
            assert!(exercise(&sealed(words)).is_err(), "{length}");
        }
    }
    let mut longer = words.clone();
    longer.push(0);
    assert!(Asset::from_words(&longer).is_err());
    longer[3] += 1;
    assert_eq!(exercise(&sealed(longer)), Err(AssetError::Table { entry: 3 }.into()));
    assert_eq!(exercise(&words), Ok(()));
}

#[test]
fn every_byte_set_to_every_value_is_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for seed in 0..6 {
        let words = baked(seed, 6, &Options { leaf_size: 1 + seed as u32 % 3, ..Options::fast() });
        for damaged in every_byte(&words) {
            if damaged == words {
                continue;
            }
            assert!(Asset::from_words(&damaged).is_err(), "the checksum sees a change of one word");
            match exercise(&sealed(damaged)) {
                Ok(()) => harmless += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 10_000 && harmless > 10_000, "{refused} {harmless}");
}

#[test]
fn structured_lies_are_refused() {
    let words = baked(2, 40, &Options::fast());
    let asset = Asset::from_words(&words).unwrap();
    let tree_words = asset.section(Kind::KdTree).unwrap().to_vec();
    let tree = KdTree::open(&tree_words).unwrap();
    let reason = |change: &dyn Fn(&mut Vec<u32>)| {
        let mut words = tree_words.clone();
        change(&mut words);
        KdTree::open(&words).map(|_| ()).map_err(|error| error.reason)
    };
    assert!(tree.node_count() > 8 && tree.depth() > 2);
    // Word 10 is the root's plane, word 11 its axis and right child.
    let right = tree_words[11] >> 4;
    let link = |number: u32| (tree_words[11] & 15) | (number << 4);
    assert_eq!(reason(&|_| {}), Ok(()));
    for number in [0, 1, right - 1, right + 1, tree.node_count() as u32, (1 << 28) - 1] {
        assert!(reason(&|words| words[11] = link(number)).is_err(), "a right child at {number}");
    }
    for plane in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(reason(&|words| words[10] = plane.to_bits()), Err(Reason::Plane));
    }
    assert_eq!(reason(&|words| words[3] = tree.depth() - 1), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[3] = 33), Err(Reason::Depth));
    assert_eq!(reason(&|words| words[4] = f32::NAN.to_bits()), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words.swap(4, 7)), Err(Reason::Bounds));
    assert_eq!(reason(&|words| words[0] += 1), Err(Reason::Length));
    assert_eq!(reason(&|words| words[1] += 2), Err(Reason::Length));
    assert_eq!(reason(&|words| words[2] = 1), Err(Reason::Primitive));
    assert_eq!(reason(&|words| words.push(0)), Err(Reason::Length));

    let with = |index: usize, word: u32| {
        let mut words = words.clone();
        words[index] = word;
        Asset::from_words(&sealed(words)).map(|_| ())
    };
    assert!(matches!(with(0, 0), Err(AssetError::Magic { found: 0 })));
    assert!(matches!(with(0, words[0].swap_bytes()), Err(AssetError::ByteOrder)));
    assert!(matches!(with(1, 0x0403_0201), Err(AssetError::ByteOrder)));
    assert!(matches!(with(2, 2), Err(AssetError::Version { kind: None, found: 2, .. })));
    assert!(matches!(with(7, 9), Err(AssetError::Version { kind: Some(Kind::Vertices), found: 9, .. })));
    assert!(matches!(with(5, u32::MAX), Err(AssetError::Table { .. })));
    assert!(matches!(with(8, words[8] + 4), Err(AssetError::Table { entry: 0 })));
    assert!(matches!(with(9, u32::MAX), Err(AssetError::Table { entry: 0 })));
    assert!(matches!(asset.section(Kind::Spheres), Err(AssetError::Missing { kind: Kind::Spheres })));
    assert!(matches!(Structure::open(Kind::Spheres, &[]), Err(Error::Asset(AssetError::NoStructure))));
    let bare = Baker::new().finish();
    let read = Asset::from_words(&bare).unwrap().read::<Structure<'_>>();
    assert!(matches!(read, Err(Error::Asset(AssetError::NoStructure))));
}

/// What was expected is what the header says, or a header.
#[test]
fn cut_bytes_are_missed_and_spare_ones_noticed() {
    let words = baked(1, 4, &Options::small());
    let mut memory = vec![0_u32; words.len() + 1];
    memory[..words.len()].copy_from_slice(&words);
    let (bytes, whole): (&[u8], usize) = (bytemuck::cast_slice(&memory), words.len() * 4);
    for found in 0..whole + 4 {
        let expected = if found < 24 { 24 } else { whole };
        let opened = Asset::open(&bytes[..found]).map(|_| ());
        assert_eq!(opened, if found == whole { Ok(()) } else { Err(AssetError::Length { expected, found }) });
    }
}

#[test]
fn bytes_at_odd_addresses_are_refused() {
    let words = baked(1, 4, &Options::small());
    let mut memory = vec![0_u32; words.len() + 1];
    let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut memory);
    for offset in 0..4 {
        let length = words.len() * 4;
        bytes[offset..offset + length].copy_from_slice(bytemuck::cast_slice(&words));
        let opened = Asset::open(&bytes[offset..offset + length]).map(|_| ());
        assert_eq!(opened, if offset == 0 { Ok(()) } else { Err(AssetError::Misaligned) });
    }
}
