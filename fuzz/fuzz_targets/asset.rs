//! Any words as an asset with any structure: refused, or walks end.
#![no_main]

use hitscan::{
    Mesh, Ray, Scene,
    accel::{Plan, Structure},
    asset::Asset,
    bake::{self, Baker},
    glam::{Vec2, Vec3},
    primitives::{Mapped, Proximity, QuadMesh, Smooth},
    query::Progress,
    render::{Texels, Texture, Textures},
};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// A small asset with a structure of each kind, for the fuzzer to damage.
static SEEDS: LazyLock<Vec<Vec<u32>>> = LazyLock::new(|| {
    let plans = Plan::all().filter(|plan| plan.kind().is_some());
    plans.flat_map(|plan| [seed(&plan), seed_of_pairs(&plan)]).collect()
});

/// A small asset of triangles in pairs with a structure by this plan.
fn seed_of_pairs(plan: &Plan) -> Vec<u32> {
    let vertices: Vec<Vec3> = (0..10).map(|i| Vec3::new((i % 2) as f32, (i * 3 % 4) as f32, i as f32)).collect();
    let strip: Vec<[u16; 3]> = (0..8).map(|i| [i + i % 2, i + 1 - i % 2, i + 2]).collect();
    let quads = bake::quads(&bake::pairs(&Mesh::new(&vertices, &strip[..]).unwrap()).corners[..]).unwrap();
    let vertices = quads.vertices(&vertices);
    let mesh = Mesh::new(&vertices, quads.indices()).unwrap();
    let words = bake::build(&QuadMesh::new(mesh).unwrap(), plan).unwrap();
    Baker::new().mesh(&mesh).structure(Structure::open(plan.kind().unwrap(), &words).unwrap()).finish()
}

/// A small asset with a structure by this plan, normals and textures.
fn seed(plan: &Plan) -> Vec<u32> {
    let vertices: Vec<Vec3> = (0..24).map(|i| Vec3::new((i * 7 % 5) as f32, (i * 3 % 4) as f32, i as f32)).collect();
    let triangles: Vec<[u16; 3]> = (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let words = bake::build(&mesh, plan).unwrap();
    let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
    let (normals, coordinates) = ([Vec3::Z; 24], [Vec2::ONE; 24]);
    let palette = [0x1234; 16];
    let textures = [
        Texels::Rgb565(&palette),
        Texels::Palette8 { palette: &palette, texels: &[3; 16] },
        Texels::Palette4 { palette: &palette, texels: &[7; 8] },
    ];
    let textures = textures.map(|texels| Texture::new(2, 8, texels).ok());
    let baker = Baker::new().mesh(&mesh).structure(structure);
    baker.normals(&normals).tex_coords(&coordinates).textures(&textures).finish()
}

fn checksum(words: &[u32]) -> u32 {
    let summed = words.iter().enumerate().filter(|(index, _)| *index != 4);
    summed.fold(0x811c_9dc5, |sum: u32, (_, word)| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}

/// Asks a scene whatever can be asked.
fn ask<P: Proximity>(scene: &Scene<Structure<'_>, P>) {
    // Whatever a structure counts, there is no more of it than bits.
    let most = scene.accelerator().as_words().len() as u32 * 32;
    for ray in
        [Ray::new(Vec3::NEG_ONE, Vec3::ONE), Ray::new(Vec3::ONE, Vec3::Z), Ray::new(Vec3::MAX * 1.0e-3, Vec3::NEG_X)]
    {
        assert!(matches!(scene.begin(&ray).advance(most), Progress::Done(_)));
        let _ = scene.hits(&ray).count();
    }
    let _ = scene.nearest_point(Vec3::ONE, f32::MAX);
}

fuzz_target!(|input: (u8, Vec<(u16, u32)>)| {
    let (kind, changes) = input;
    // Changes to a good asset go deeper than random words; the sum is made to fit, or nothing but it would be tested.
    let mut words = SEEDS[usize::from(kind) % SEEDS.len()].clone();
    let mut length = words.len();
    for (place, word) in changes {
        match place {
            u16::MAX => length = (word as usize).min(words.len()),
            place => {
                let index = usize::from(place) % words.len();
                words[index] = word;
            }
        }
    }
    words.truncate(length);
    if length > 4 {
        words[4] = checksum(&words);
    }
    let Ok(asset) = Asset::from_words(&words) else { return };
    let textures: Result<Textures, _> = asset.read();
    for texture in (0..4).filter_map(|material| textures.as_ref().ok()?.get(material)) {
        assert!([0.3, 7.0, f32::NAN].into_iter().all(|u| texture.color(Vec2::new(u, -1.0e-9)).is_finite()));
    }
    if let Ok(scene) = asset.scene::<Structure, Mapped<Smooth>>() {
        let ray = Ray::new(Vec3::NEG_ONE, Vec3::ONE);
        let _ = scene.closest_hit(&ray).map(|hit| scene.surface(&ray, &hit));
    }
    let _ = asset.scene::<Structure, QuadMesh<Mesh>>().map(|scene| ask(&scene));
    let _ = asset.scene::<Structure, Mesh>().map(|scene| ask(&scene));
});
