//! Assets of every kind of section and every structure, damaged with the sum computed anew: refused, or harmless.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{Random, adversarial_mesh, adversarial_ray, plans, seal::seal};
use hitscan::{
    Instance, Instances, LatticeMesh, List, Mesh, Primitives, Ray, Scene,
    accel::{Plan, Structure},
    asset::{Asset, AssetError, Stored},
    bake::{self, Baker},
    bvh,
    geometry::{Sphere, Transform},
    glam::Vec3,
    grid, kdtree,
    primitives::{Renumbering, Reordered, Soup, Spheres},
    query::Progress,
    render::{Material, Materials, Numbers},
};

fn structure<'a>(plan: &Plan, words: &'a [u32]) -> Structure<'a> {
    Structure::open(plan.kind().unwrap(), words).unwrap()
}

/// Casts rays at what opened; no structure has more nodes than bits.
fn walk<'a, P: Primitives + Stored<'a>>(asset: &Asset<'a>, rays: &[Ray]) {
    let Ok(scene) = asset.scene::<Structure, P>() else { return };
    let most = scene.accelerator().as_words().len() as u32 * 32;
    for ray in rays {
        assert!(matches!(scene.begin(ray).advance(most), Progress::Done(_)), "a walk runs on");
        if let Some(hit) = scene.closest_hit(ray) {
            let _ = scene.surface(ray, &hit);
        }
    }
}

/// Reads everything that an asset may hold, whether it does or not.
fn read(words: &[u32], rays: &[Ray]) -> Result<(), AssetError> {
    let asset = Asset::from_words(words)?;
    walk::<Mesh>(&asset, rays);
    walk::<LatticeMesh>(&asset, rays);
    walk::<Spheres>(&asset, rays);
    walk::<(Mesh, Spheres)>(&asset, rays);
    walk::<Reordered<Mesh>>(&asset, rays);
    walk::<Soup>(&asset, rays);
    let _ = asset.read::<Renumbering>();
    if let Ok(materials) = asset.read::<Materials>() {
        (0..99).for_each(|primitive| _ = materials.of(primitive));
    }
    let parts: Vec<_> = asset.parts().filter_map(|part| part.ok()?.scene::<Structure, Mesh>().ok()).collect();
    if let Ok(placed) = asset.read::<&[Instance]>()
        && let Ok(instances) = Instances::new(&parts, placed)
        && let Ok(list) = List::new(&instances)
    {
        let scene = Scene::new(list, instances).unwrap();
        rays.iter().for_each(|ray| _ = scene.closest_hit(ray));
    }
    Ok(())
}

/// Assets with each structure, and some that hold everything else.
fn assets() -> Vec<Vec<u32>> {
    let (vertices, triangles) = adversarial_mesh(&mut Random::new(71), 2, 9);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let spheres = [Sphere::new(Vec3::ONE, 2.0), Sphere::new(Vec3::ZERO, 0.5)];
    let palette = [Material::matte(Vec3::X), Material::default()];
    let mut assets: Vec<Vec<u32>> = plans::presets()
        .iter()
        .map(|(_, plan)| {
            let words = bake::build(&mesh, plan).unwrap();
            Baker::new().mesh(&mesh).structure(structure(plan, &words)).finish()
        })
        .collect();

    let plan = Plan::Bvh(bvh::Options::balanced());
    let words = bake::build(&mesh, &plan).unwrap();
    let (words, order) = bake::ordered(&structure(&plan, &words)).unwrap();
    let corners = bake::reorder(&mesh, &order);
    let reordered = Mesh::new(&vertices, &corners[..]).unwrap();
    assets.push(Baker::new().mesh(&reordered).structure(structure(&plan, &words)).numbers(&order).finish());

    for plan in [Plan::KdTree(kdtree::Options::fast()), Plan::Grid(grid::Options::fast())] {
        let words = bake::build(&mesh, &plan).unwrap();
        assets.push(Baker::new().soup(&mesh).structure(structure(&plan, &words)).finish());
    }

    let meshlets = bake::meshlets(&mesh);
    let moved = meshlets.vertices(&vertices);
    let packed = Mesh::new(&moved, meshlets.indices()).unwrap();
    let words = bake::build(&packed, &plan).unwrap();
    assets.push(Baker::new().mesh(&packed).structure(structure(&plan, &words)).finish());

    let both = (mesh, Spheres::new(&spheres).unwrap());
    let words = bake::build(&both, &plan).unwrap();
    let numbers: Vec<u8> = (0..both.len()).map(|i| (i % 2) as u8).collect();
    let baker = Baker::new().mesh(&mesh).spheres(&spheres).structure(structure(&plan, &words));
    assets.push(baker.materials(&palette, Numbers::Narrow(&numbers)).finish());

    let words = bake::build(&mesh, &plan).unwrap();
    let scenes = [Scene::new(structure(&plan, &words), mesh).unwrap()];
    let mut placed = [Instance::new(0, Transform::IDENTITY); 2];
    let instances = Instances::place(&scenes, &mut placed).unwrap();
    let top = bake::build(&instances, &plan).unwrap();
    let part = Baker::new().mesh(&mesh).structure(*scenes[0].accelerator());
    assets.push(Baker::new().part(part).instances(instances.placed()).structure(structure(&plan, &top)).finish());
    assets
}

#[test]
fn damage_is_refused_or_harmless() {
    let mut random = Random::new(72);
    let (corners, _) = adversarial_mesh(&mut random, 2, 9);
    let rays: Vec<Ray> = (0..3).map(|_| adversarial_ray(&mut random, 2, &corners)).collect();
    let (mut tried, mut opened) = (0, 0);
    for asset in assets() {
        assert_eq!(read(&asset, &rays), Ok(()));
        let mut damage = |change: &dyn Fn(&mut Vec<u32>)| {
            let mut words = asset.clone();
            change(&mut words);
            seal(&mut words);
            tried += 1;
            opened += usize::from(read(&words, &rays).is_ok());
        };
        for place in 0..asset.len() {
            for bit in 0..32 {
                damage(&|words| words[place] ^= 1 << bit);
            }
            for word in [0, 1, u32::MAX, 0x7fff_ffff, 0x8000_0000, f32::NAN.to_bits(), asset.len() as u32] {
                damage(&|words| words[place] = word);
            }
            damage(&|words| words[place] = words[place].wrapping_add(1));
            damage(&|words| words[place] = words[place].wrapping_sub(1));
            damage(&|words| words.swap(place, (place + 1) % asset.len()));
            damage(&|words| words[place] = words[place].swap_bytes());
            damage(&|words| words.truncate(place));
            damage(&|words| words.insert(place, 0));
            // Shorter or longer, and saying so.
            damage(&|words| {
                words.truncate(place);
                words.get_mut(3).into_iter().for_each(|length| *length = place as u32);
            });
        }
    }
    println!("{opened} of {tried} open");
    assert!(tried > 50_000 && opened * 5 > tried && opened < tried, "{opened} of {tried}");
}
