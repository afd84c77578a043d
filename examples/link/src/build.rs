//! Builders, arenas and assets.

use core::hint::black_box;

use hitscan::{
    Accelerator, Arena, Bvh, DualSplit, Instance, LatticeMesh, List, Mesh, Primitives, Traversal,
    accel::{Counted, Hierarchy, Inside, Mailbox, Structure},
    asset::{Asset, Stored},
    from_fn,
    geometry::Bundle,
    primitives::{Mapped, Renumbering, Smooth, Soup, Spheres},
    render::Materials,
    render::Textures,
};

use crate::{
    input::{aabb, float, ray, some, sphere, triangle, vector, word},
    plan,
};

/// Builds over every kind of primitives.
pub fn all() {
    let corners = || [word() as u16, word() as u16, word() as u16];
    let wide = || [word(), word(), word()];
    with(&Mesh::new(some(vector, &mut None), some(corners, &mut None)));
    with(&Mesh::new(some(vector, &mut None), some(wide, &mut None)));
    with(&Soup::new(some(triangle, &mut None)));
    with(&Spheres::new(some(sphere, &mut None)));
    with::<_, ()>(&Ok(from_fn(word(), |_| aabb(), |_, _| Some(float()))));
    assets();
}

fn with<P: Primitives, E>(primitives: &Result<P, E>) {
    let Ok(primitives) = primitives else { return };
    black_box(List::new(primitives).map(|list| list.bounds()).is_ok());
    let mut memory = [0; 1024];
    let mut arena = Arena::new(black_box(memory.as_mut_slice()));
    let plan = plan::any();
    black_box((plan.words(word() as usize), plan.kind()));
    arena.frame(|arena| any(Structure::build(primitives, arena, &plan)));
    any(Structure::build(&(primitives, primitives), &mut arena, &plan));
    #[cfg(feature = "objects")]
    let primitives = primitives as &dyn Primitives;
    if let Ok(structure) = Structure::build(primitives, &mut arena, &plan) {
        one(&structure, &mut arena);
    }
    black_box(arena.available());
    black_box(Bvh::refit(black_box(&mut [0; 64]), primitives).is_ok());
}

/// What every structure can.
fn any<E>(structure: Result<Structure<'_>, E>) {
    let Ok(structure) = structure else { return };
    black_box(structure.kind().map(|kind| Structure::open(kind, structure.as_words()).is_ok()));
    walk(&structure);
    walk(&Mailbox(structure));
    let nodes = core::cell::Cell::new(0);
    walk(&Counted::new(structure, &nodes));
    let mut cell = structure.root();
    while let Some(inside) = cell.map(|cell| Hierarchy::open(&structure, &cell)) {
        cell = match inside {
            Inside::Cells([first, second]) => black_box(first.or(second)),
            Inside::Leaf(leaf) => {
                black_box(leaf.last());
                None
            }
        };
    }
}

fn walk<A: Accelerator>(structure: &A) {
    let Some(ray) = ray().prepare() else { return };
    let (mut walk, mut budget) = (structure.traverse(&ray), word());
    while let Some(leaf) = walk.next_leaf(&ray, float()) {
        black_box(leaf.last());
    }
    structure.visit(&ray, float(), |leaf| black_box(leaf.last()).map(|_| float()));
    if let Some(bundle) = Bundle::around([*ray.ray(), *ray.ray()]) {
        black_box(structure.sweep(&bundle, |leaf| black_box(leaf.count() as f32)));
        let entries = structure.enter(&bundle);
        for entry in entries.iter() {
            black_box(structure.traverse_from(entry, &ray).next_leaf(&ray, float()).is_some());
        }
        black_box((entries.is_empty(), entries.is_everything()));
    }
    black_box(matches!(walk.step(&ray, float(), &mut budget), hitscan::accel::Step::Done));
}

/// What only some can.
fn one(structure: &Structure<'_>, arena: &mut Arena<'_>) {
    match structure {
        Structure::Grid(grid) => {
            black_box((grid.resolution(), grid.reference_count()));
        }
        Structure::Octree(tree) => {
            black_box((tree.node_count(), tree.reference_count(), tree.depth(), tree.expected_work()));
        }
        Structure::KdTree(tree) => {
            black_box((tree.node_count(), tree.reference_count(), tree.depth(), tree.expected_work()));
            black_box(tree.for_height::<20>().is_some());
        }
        Structure::CompactKdTree(tree) => {
            black_box((tree.node_words(), tree.reference_count(), tree.depth(), tree.for_height::<20>().is_some()));
        }
        Structure::Bvh(bvh) => {
            black_box((bvh.pair_count(), bvh.depth(), bvh.expected_work(), bvh.is_ordered()));
            black_box((bvh.order().last(), bvh.ordered().as_words().len()));
        }
        Structure::DualSplit(tree) => {
            black_box((tree.depth(), tree.is_ordered(), tree.order().last(), tree.ordered_words().last()));
            black_box((tree.ordered(arena).is_ok(), tree.for_height::<20>().is_some()));
        }
        _ => {}
    }
}

fn assets() {
    let (mut bytes, mut words) = (None, None);
    let bytes = some(|| word() as u8, &mut bytes);
    let words = some(word, &mut words);
    for asset in [Asset::open(bytes), Asset::from_words(words)].into_iter().flatten() {
        asset.sections().for_each(|section| _ = black_box(section));
        asset.parts().for_each(|part| _ = black_box(part));
        read::<Structure<'_>>(&asset);
        read::<Mesh<'_>>(&asset);
        read::<LatticeMesh<'_>>(&asset);
        read::<Soup<'_>>(&asset);
        read::<Spheres<'_>>(&asset);
        read::<Mapped<'_, Smooth<'_>>>(&asset);
        read::<Textures<'_>>(&asset);
        read::<Materials<'_>>(&asset);
        read::<Renumbering<'_>>(&asset);
        read::<&[Instance]>(&asset);
        black_box(asset.scene::<Structure<'_>, Mesh<'_>>().is_ok());
        black_box(asset.lattice_scene::<DualSplit<'_, 16>, LatticeMesh<'_>>().is_ok());
    }
}

fn read<'a, T: Stored<'a>>(asset: &Asset<'a>) {
    black_box(asset.read::<T>().is_ok());
}
