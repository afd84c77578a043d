//! Builders, arenas and assets.

use core::hint::black_box;

use hitscan::{
    Accelerator, Arena, CompactKdTree, DualSplit, KdTree, List, Mesh, Primitives,
    accel::{Hierarchy, Inside, Step, Traversal},
    asset::{Asset, Stored},
    dualsplit, from_fn,
    kdtree::{Options, Split},
    primitives::Spheres,
    render::Materials,
};

use crate::input::{aabb, float, ray, some, sphere, vector, word};

/// Builds over every kind of primitives.
pub fn all() {
    let corners = || [word() as u16, word() as u16, word() as u16];
    let wide = || [word(), word(), word()];
    with(&Mesh::new(some(vector, &mut None), some(corners, &mut None)));
    with(&Mesh::new(some(vector, &mut None), some(wide, &mut None)));
    with(&Spheres::new(some(sphere, &mut None)));
    with::<_, ()>(&Ok(from_fn(word(), |_| aabb(), |_, _| Some(float()))));
    assets();
}

fn with<P: Primitives, E>(primitives: &Result<P, E>) {
    let Ok(primitives) = primitives else { return };
    black_box(List::new(primitives).map(|list| list.bounds()).is_ok());
    let mut memory = [0; 1024];
    let mut arena = Arena::new(black_box(memory.as_mut_slice()));
    let options = options();
    black_box(KdTree::words(word() as usize, &options));
    arena.frame(|arena| tree(KdTree::build(primitives, arena, &options)));
    arena.frame(|arena| compact(CompactKdTree::build(primitives, arena, &options)));
    compact(CompactKdTree::build(primitives as &dyn Primitives, &mut arena, &options));
    black_box(CompactKdTree::words(word() as usize, &options));
    tree(KdTree::build(&(primitives, primitives), &mut arena, &options));
    tree(KdTree::build(primitives as &dyn Primitives, &mut arena, &options));
    dual_split(primitives);
    black_box(arena.available());
}

fn dual_split<P: Primitives>(primitives: &P) {
    let mut memory = [0; 1024];
    let mut arena = Arena::new(black_box(memory.as_mut_slice()));
    black_box(DualSplit::words(word() as usize));
    let presets = [dualsplit::Options::small(), dualsplit::Options::balanced(), dualsplit::Options::fast()];
    let preset = presets.get(word() as usize).copied().unwrap_or_default();
    let options = match word() {
        0 => preset,
        _ => dualsplit::Options { leaf_size: word(), intersection_cost: float(), carve_threshold: float() },
    };
    let Ok(tree) = DualSplit::build(primitives, &mut arena, &options) else { return };
    black_box((tree.depth(), tree.is_ordered(), tree.order().last(), tree.ordered_words().last()));
    black_box(tree.ordered(&mut arena).is_ok());
    black_box(DualSplit::open(tree.as_words()).is_ok());
    let mut cell = tree.root();
    while let Some(inside) = cell.map(|cell| tree.open(&cell)) {
        cell = match inside {
            Inside::Cells([left, _]) => left,
            Inside::Leaf(leaf) => {
                black_box(leaf.last());
                None
            }
        };
    }
    let (mut budget, Some(ray)) = (word(), ray().prepare()) else { return };
    let mut walk = tree.traverse(&ray);
    while let Some(leaf) = walk.next_leaf(&ray, float()) {
        black_box(leaf.last());
    }
    black_box(matches!(walk.step(&ray, float(), &mut budget), Step::Done));
}

fn options() -> Options {
    let presets = [Options::small(), Options::balanced(), Options::fast().fit(word() as usize)];
    let preset = presets.get(word() as usize).copied().unwrap_or_default();
    let split = match word() {
        0 => Split::Midpoint,
        1 => Split::Median,
        _ => Split::Sah,
    };
    Options {
        split,
        leaf_size: word(),
        max_depth: black_box(Some(word())),
        intersection_cost: float(),
        byte_cost: float(),
        empty_bonus: float(),
        clip: word() == 0,
        bytes_per_primitive: word(),
        ..preset
    }
}

fn tree<E>(tree: Result<KdTree<'_>, E>) {
    let Ok(tree) = tree else { return };
    black_box((tree.node_count(), tree.reference_count(), tree.depth(), tree.expected_work()));
    black_box(KdTree::open(tree.as_words()).is_ok());
    black_box(ray().prepare().map(|ray| tree.traverse(&ray)));
}

fn compact<E>(tree: Result<CompactKdTree<'_>, E>) {
    let Ok(tree) = tree else { return };
    black_box((tree.node_words(), tree.reference_count(), tree.depth()));
    black_box(CompactKdTree::open(tree.as_words()).is_ok());
    let mut next = tree.root();
    while let Some(cell) = next {
        next = match Hierarchy::open(&tree, &cell) {
            Inside::Cells([left, right]) => black_box(left.or(right)),
            Inside::Leaf(leaf) => {
                leaf.for_each(|primitive| _ = black_box(primitive));
                None
            }
        };
    }
    let Some(ray) = ray().prepare() else { return };
    let (mut walk, mut budget) = (tree.traverse(&ray), word());
    while let Step::Leaf(leaf) = walk.step(&ray, float(), &mut budget) {
        leaf.for_each(|primitive| _ = black_box(primitive));
    }
    while let Some(leaf) = walk.next_leaf(&ray, float()) {
        leaf.for_each(|primitive| _ = black_box(primitive));
    }
}

fn assets() {
    let (mut bytes, mut words) = (None, None);
    let bytes = some(|| word() as u8, &mut bytes);
    let words = some(word, &mut words);
    for asset in [Asset::open(bytes), Asset::from_words(words)].into_iter().flatten() {
        asset.sections().for_each(|section| _ = black_box(section));
        read::<KdTree<'_>>(&asset);
        read::<DualSplit<'_>>(&asset);
        read::<CompactKdTree<'_>>(&asset);
        read::<Mesh<'_>>(&asset);
        read::<Spheres<'_>>(&asset);
        read::<Materials<'_>>(&asset);
        black_box(asset.scene::<KdTree<'_>, Mesh<'_>>().is_ok());
        black_box(asset.scene::<CompactKdTree<'_>, Mesh<'_>>().is_ok());
    }
}

fn read<'a, T: Stored<'a>>(asset: &Asset<'a>) {
    black_box(asset.read::<T>().is_ok());
}
