//! Triangles with corners of their own answer with the bits of the mesh they came from.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, rays, seal::sealed};
use hitscan::{
    Hit, List, Mesh, Scene,
    accel::{Plan, Structure},
    asset::{Asset, AssetError, Kind},
    bake::{self, Baker},
    bvh, dualsplit,
    glam::Vec3,
    grid, kdtree,
    primitives::{MeshError, Sides, Soup},
    query::Progress,
};

fn plans() -> [Plan; 6] {
    [
        Plan::KdTree(kdtree::Options::fast()),
        Plan::KdTree(kdtree::Options { leaf_size: 3, ..kdtree::Options::small() }),
        Plan::Grid(grid::Options::fast()),
        Plan::Grid(grid::Options::balanced()),
        Plan::Bvh(bvh::Options::balanced()),
        Plan::DualSplit(dualsplit::Options::balanced()),
    ]
}

fn open<'a>(plan: &Plan, words: &'a [u32]) -> Structure<'a> {
    Structure::open(plan.kind().unwrap(), words).unwrap()
}

/// An asset of the soup of a mesh with its structure.
fn baked(mesh: &Mesh<'_>, plan: &Plan) -> Vec<u32> {
    let words = bake::build(mesh, plan).unwrap();
    Baker::new().soup(mesh).structure(open(plan, &words)).finish()
}

#[test]
fn a_soup_answers_as_its_mesh() {
    let mut random = Random::new(81);
    let cast = rays(60_000) / 500;
    for round in 0..cast.div_ceil(plans().len()) {
        let family = round % FAMILIES;
        let triangles = if round % 7 == 0 { random.below(3) } else { 5 + random.below(60) };
        let (vertices, triangles) = adversarial_mesh(&mut random, family, triangles);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
        for plan in plans() {
            let asset = baked(&mesh, &plan);
            let scene: Scene<Structure, Soup> = Asset::from_words(&asset).unwrap().scene().unwrap();
            for _ in 0..500 {
                let ray = adversarial_ray(&mut random, family, &vertices);
                let hit = list.closest_hit(&ray);
                assert_eq!(bits(scene.closest_hit(&ray)), bits(hit), "{plan:?} {ray:?} {vertices:?} {triangles:?}");
                assert_eq!(scene.any_hit(&ray), hit.is_some());
                assert!(scene.hits(&ray).eq(list.hits(&ray)), "{plan:?} {ray:?} {vertices:?} {triangles:?}");
                let mut query = scene.begin(&ray);
                let paused = loop {
                    if let Progress::Done(hit) = query.advance(1) {
                        break hit;
                    }
                };
                assert_eq!(bits(paused), bits(hit));
                if let Some(hit) = hit {
                    assert_eq!(scene.surface(&ray, &hit), list.surface(&ray, &hit));
                }
            }
        }
    }
}

#[test]
fn the_nearest_triangle_is_that_of_the_mesh() {
    let mut random = Random::new(82);
    let (vertices, triangles) = adversarial_mesh(&mut random, 2, 60);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    let list = Scene::new(List::new(&mesh).unwrap(), mesh).unwrap();
    for plan in plans() {
        let asset = baked(&mesh, &plan);
        let scene: Scene<Structure, Soup> = Asset::from_words(&asset).unwrap().scene().unwrap();
        for _ in 0..300 {
            let point = Vec3::from_array([0; 3].map(|_| random.unit() * 4.0 - 2.0));
            assert_eq!(scene.nearest_point(point, 9.0), list.nearest_point(point, 9.0));
        }
    }
}

#[test]
fn what_is_no_soup_is_refused() {
    let mut triangles = [[Vec3::ZERO, Vec3::X, Vec3::Y]; 3];
    assert!(Soup::new(&triangles).is_ok() && Soup::new(&[]).is_ok());
    triangles[2][1].z = f32::NAN;
    assert_eq!(Soup::new(&triangles).unwrap_err(), MeshError::Vertex { triangle: 2, vertex: 1 });
}

/// An asset may hold any words of the right number, but none of the version that had a number beside each triangle.
#[test]
fn other_words_are_no_soup() {
    let soup = Soup::new(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]).unwrap();
    let mut words = Baker::new().soup(&soup).finish();
    assert_eq!(Asset::from_words(&words).unwrap().read::<Soup>().unwrap().triangles(), soup.triangles());
    let entry = words.iter().position(|&word| word == u32::from_le_bytes(*b"soup")).unwrap();
    let read = |words: &[u32]| Asset::from_words(&sealed(words.to_vec()))?.read::<Soup>().map(|_| ());
    let mut short = words.clone();
    short.pop();
    (short[3], short[entry + 3]) = (short.len() as u32, 8);
    assert_eq!(read(&short), Err(AssetError::Shape { kind: Kind::Soup, words: 8 }.into()));
    words[entry + 1] = 1;
    let old = AssetError::Version { kind: Some(Kind::Soup), found: 1, supported: 2 };
    assert_eq!(read(&words), Err(old.into()));
}

#[test]
fn a_soup_is_hit_from_its_sides() {
    let triangles = [[Vec3::ZERO, Vec3::X, Vec3::Y]];
    let soup = Soup::new(&triangles).unwrap();
    let hits = |soup: Soup<'_>, z: f32| {
        let ray = hitscan::Ray::new(Vec3::new(0.2, 0.2, z), Vec3::Z * -z);
        Scene::new(List::new(&soup).unwrap(), soup).unwrap().closest_hit(&ray)
    };
    let hit = Some(Hit { t: 1.0, primitive: 0 });
    assert_eq!((hits(soup, 1.0), hits(soup, -1.0)), (hit, hit));
    let front = soup.with_sides(Sides::Front);
    assert_eq!((hits(front, 1.0), hits(front, -1.0)), (hit, None));
}
