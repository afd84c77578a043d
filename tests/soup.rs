//! Triangles that stand where the leaves want them answer with the bits and the numbers of the mesh they came from.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, bits, rays};
use hitscan::{
    Error, Hit, List, Mesh, Primitives, Scene,
    accel::{Plan, Structure},
    asset::Asset,
    bake::{self, Baker},
    bvh, dualsplit,
    glam::Vec3,
    grid, kdtree,
    primitives::{Facet, MeshError, OrderError, Sides, Soup},
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
    let (words, order) = bake::gathered(&open(plan, &words)).unwrap();
    Baker::new().soup(mesh, &order).structure(open(plan, &words)).finish()
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
            assert_eq!(scene.primitives().numbers(), mesh.len());
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

/// Each triangle is somewhere, in a tree as often as its leaves name it, and nothing but the references is gone.
#[test]
fn ordered_structures_hold_no_references() {
    let mut random = Random::new(83);
    let (vertices, triangles) = adversarial_mesh(&mut random, 2, 200);
    let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
    for plan in plans() {
        let words = bake::build(&mesh, &plan).unwrap();
        let (ordered, order) = bake::gathered(&open(&plan, &words)).unwrap();
        assert!(ordered.len() < words.len(), "{plan:?}");
        assert!((0..mesh.len()).all(|number| order.contains(&number)), "{plan:?}");
        assert_eq!(open(&plan, &ordered).as_words(), ordered);
        // What is ordered already stays as it is, over its own places.
        let (again, places) = bake::gathered(&open(&plan, &ordered)).unwrap();
        assert!(again == ordered && places.iter().copied().eq(0..order.len() as u32), "{plan:?}");
        match (open(&plan, &words), open(&plan, &ordered)) {
            (Structure::KdTree(tree), Structure::KdTree(ordered)) => {
                assert!(!tree.is_ordered() && ordered.is_ordered() && order.len() >= tree.reference_count());
            }
            (Structure::Grid(grid), Structure::Grid(ordered)) => {
                assert!(!grid.is_ordered() && ordered.is_ordered() && order.len() == grid.reference_count());
            }
            _ => assert_eq!(order.len() as u32, mesh.len()),
        }
    }
    let list = bake::gathered(&Structure::List(List::new(&mesh).unwrap()));
    assert!(list.is_none());
}

#[test]
fn what_is_no_soup_is_refused() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let facets = [1, 0, 1].map(|number| Facet { corners, number });
    assert!(Soup::new(&facets, &[1, 0]).is_ok() && Soup::new(&facets, &[1, 2]).is_ok());
    assert!(Soup::new(&[], &[]).is_ok_and(|soup| soup.is_empty()));
    let order = |places: &[u32]| match Soup::new(&facets, places) {
        Err(Error::Order(OrderError { place })) => Some(place),
        _ => None,
    };
    // The places of other triangles, of none, of too few and too many.
    assert_eq!(order(&[0, 1]), Some(0));
    assert_eq!(order(&[1, 3]), Some(3));
    assert_eq!(order(&[1]), Some(0));
    assert_eq!(order(&[1, 0, 2]), Some(2));
    let mut bad = facets;
    bad[2].corners[1][2] = f32::NAN;
    let error = Soup::new(&bad, &[1, 0]).unwrap_err();
    assert_eq!(error, Error::Mesh(MeshError::Vertex { triangle: 2, vertex: 1 }));
}

#[test]
fn a_soup_is_hit_from_its_sides() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let facets = [Facet { corners, number: 0 }];
    let soup = Soup::new(&facets, &[0]).unwrap();
    let hits = |soup: Soup<'_>, z: f32| {
        let ray = hitscan::Ray::new(Vec3::new(0.2, 0.2, z), Vec3::Z * -z);
        Scene::new(List::new(&soup).unwrap(), soup).unwrap().closest_hit(&ray)
    };
    let hit = Some(Hit { t: 1.0, primitive: 0 });
    assert_eq!((hits(soup, 1.0), hits(soup, -1.0)), (hit, hit));
    let front = soup.with_sides(Sides::Front);
    assert_eq!((hits(front, 1.0), hits(front, -1.0)), (hit, None));
}
