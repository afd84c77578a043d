//! Every query of every scene.

use core::hint::black_box;

use hitscan::{
    Accelerator, Arena, Hit, Instance, Instances, LatticeMesh, LatticeScene, List, Mesh, Primitives, Scene, Span,
    accel::{Bounded, Hierarchy, LatticeAccelerator, Structure},
    asset::Asset,
    error::BuildError,
    geometry::{Bundle, LatticePath, Transform},
    primitives::{
        Indices, LatticeTriangles, Mapped, Meshlets, Normals, Order, Proximity, QuadMesh, Quads, Renumbering,
        Reordered, Sides, Smooth, Soup, Spheres, Surface, TexCoords,
    },
    query::{ItemBuffer, Wanted},
    render::{Camera, Tile},
};

use crate::{
    input::{aabb, float, matrix, ray, some, sphere, triangle, vector, word},
    own::{Own, asked},
    plan, render,
};

/// Casts rays at meshes, spheres and both together, with and without a tree.
pub fn all() {
    let corners = || [word() as u16, word() as u16, word() as u16];
    let (mut vertices, mut triangles, mut masks, mut balls) = (None, None, None, None);
    let mesh = Mesh::new(some(vector, &mut vertices), some(corners, &mut triangles));
    let Ok(mesh) = mesh.and_then(|mesh| mesh.with_masks(some(word, &mut masks))) else { return };
    let Ok(spheres) = Spheres::new(some(sphere, &mut balls)) else { return };
    with(&mesh.with_sides(sides()));
    let smooth = Smooth::new(mesh, mesh.vertices());
    if let Ok(list) = List::new(&smooth) {
        cast(Scene::new(list, smooth));
    }
    black_box((smooth.mesh().len(), Normals::packed(vector())));
    let mut words = None;
    let normals = Asset::from_words(some(word, &mut words)).ok().and_then(|asset| asset.read::<Normals<'_>>().ok());
    if let Some(normals) = normals {
        black_box((normals.len(), normals.is_empty(), normals.get(word())));
        let smooth = Smooth::packed(mesh, normals);
        if let Ok(list) = List::new(&smooth) {
            cast(Scene::new(list, smooth));
        }
    }
    let mut places = None;
    let coordinates = black_box(TexCoords::new(some(|| vector().truncate(), &mut places)));
    black_box((coordinates.len(), coordinates.is_empty(), coordinates.get(word())));
    let mapped = Mapped::new(smooth, &mesh, coordinates);
    if let Ok(list) = List::new(&mapped) {
        cast(Scene::new(list, mapped));
    }
    with(&Own);
    lattice(mesh.indices());
    meshlets();
    quads(&mesh);
    soup();
    with(&spheres);
    with(&(mesh, spheres));
    let (mut numbers, mut places) = (None, None);
    let orders = (Order::Wide(some(word, &mut numbers)), Order::Wide(some(word, &mut places)));
    if let Ok(numbers) = Renumbering::new(orders.0, orders.1)
        && let Ok(reordered) = Reordered::new(mesh, numbers)
    {
        with(&reordered);
        black_box(reordered.inner().len());
    }
}

fn meshlets() {
    let (mut first, mut corners) = (None, None);
    let corners = some(|| [word() as u8, word() as u8, word() as u8], &mut corners);
    if let Ok(meshlets) = Meshlets::new(some(word, &mut first), corners) {
        black_box((meshlets.len(), meshlets.is_empty(), meshlets.get(word()), meshlets.first(), meshlets.corners()));
        lattice(meshlets.into());
    }
}

fn quads(mesh: &Mesh<'_>) {
    let (mut first, mut corners) = (None, None);
    let corners = some(|| [word() as u8, word() as u8, word() as u8, word() as u8], &mut corners);
    let Ok(quads) = Meshlets::new(some(word, &mut first), corners) else { return };
    lattice(quads.into());
    if let Ok(pairs) = Mesh::new(mesh.vertices(), quads).and_then(QuadMesh::new) {
        // By the list alone: what structures do with primitives is linked with others.
        asked(&pairs);
        if let Ok(list) = List::new(&pairs) {
            cast(Scene::new(list, &pairs));
            near(Scene::new(list, &pairs));
        }
        black_box((pairs.mesh().quads(), pairs.mesh().len()));
        let hit = || black_box(Hit { t: float(), primitive: word() });
        if let Some(ray) = ray().prepare() {
            black_box(pairs.mesh().intersect_quad(word(), &ray, &Span::new(hit(), hit())));
        }
    }
}

fn soup() {
    let mut triangles = None;
    if let Ok(soup) = Soup::new(some(triangle, &mut triangles)) {
        with(&soup.with_sides(sides()));
        black_box(soup.triangles().len());
    }
}

fn sides() -> Sides {
    if word() == 0 { Sides::Both } else { Sides::Front }
}

fn lattice(indices: Indices<'_>) {
    let mut numbers = None;
    let numbers = some(|| [word() as u16, word() as u16, word() as u16], &mut numbers);
    if let Ok(mesh) = LatticeMesh::new(&aabb(), numbers, indices) {
        let mesh = mesh.with_sides(sides());
        black_box(mesh.sides());
        black_box(mesh.positions().last());
        with(&mesh);
        if let (Ok(pairs), Ok(list)) = (QuadMesh::new(mesh), List::new(&mesh)) {
            black_box(
                Scene::new(list, pairs).map(|scene| (scene.closest_hit(&ray()), scene.hit(&ray(), Wanted::Any))).ok(),
            );
        }
        whole(List::new(&mesh), mesh);
        let mut memory = [0; 1024];
        let mut arena = Arena::new(black_box(memory.as_mut_slice()));
        match Structure::build(&mesh, &mut arena, &plan::any()) {
            Ok(Structure::DualSplit(tree)) => whole(Ok(tree), mesh),
            Ok(Structure::CompactKdTree(tree)) => whole(Ok(tree), mesh),
            _ => {}
        }
    }
}

fn whole<A: LatticeAccelerator>(structure: Result<A, BuildError>, mesh: impl LatticeTriangles) {
    let Ok(structure) = structure else { return };
    let Ok(scene) = LatticeScene::new(structure, mesh) else { return };
    render::pixel(&scene);
    black_box((scene.closest_hit(&ray()), scene.any_hit(&ray()), scene.accelerator().primitives()));
    let camera = Camera::pinhole(vector(), vector(), vector(), float());
    if let Some(pencil) = camera.pencil(&Tile { x: word(), y: word(), width: 8, height: 8 }, word(), word()) {
        let mut items = ItemBuffer::new();
        black_box((scene.closest_hits(&pencil, &mut items), items.get(word(), word())));
    }
    let rays = scene.space().rays(vector(), vector(), vector(), word());
    black_box(rays.size_hint());
    for ray in rays.flatten() {
        black_box((scene.closest_hit_along(&ray), scene.any_hit_along(&ray)));
        black_box((ray.inside(), ray.descending(), ray.entry(word(), word()), ray.exit(word(), word())));
    }
}

fn with<P: Proximity>(primitives: &P) {
    asked(primitives);
    if let Ok(list) = List::new(primitives) {
        cast(Scene::new(list, primitives));
        cast(Scene::new(Bounded::new((sphere(), list.bounds()), list), primitives));
        near(Scene::new(list, primitives));
        if let Ok(scene) = Scene::new(list, primitives) {
            placed(scene);
        }
    }
    let mut memory = [0; 1024];
    let mut arena = Arena::new(black_box(memory.as_mut_slice()));
    if let Ok(structure) = Structure::build(primitives, &mut arena, &plan::any()) {
        cast(Scene::new(structure, primitives));
        near(Scene::new(structure, primitives));
    }
}

fn placed<A: Hierarchy, P: Proximity>(scene: Scene<A, P>) {
    let Ok(transform) = Transform::new(matrix(), vector()) else { return };
    let (scenes, mut places) = ([scene], [Instance::new(word(), transform).with_mask(word())]);
    let Ok(instances) = Instances::place(black_box(&scenes), black_box(&mut places)) else { return };
    black_box(instances.locate(word()));
    let [place] = instances.placed() else { return };
    black_box((place.scene(), place.first(), place.transform().inverse()));
    if let Ok(similar) = instances.similar()
        && let Ok(list) = List::new(&similar)
    {
        cast(Scene::new(list, similar));
        near(Scene::new(list, similar));
    }
}

fn near<A: Hierarchy, P: Proximity, E>(scene: Result<Scene<A, P>, E>) {
    let Ok(scene) = scene else { return };
    black_box(scene.nearest_point(vector(), float()));
    black_box(scene.nearest_point_where(vector(), float(), |number| number != word()));
    black_box(scene.any_overlap(&sphere()));
    scene.overlaps(&sphere()).for_each(|nearest| _ = black_box(nearest));
}

fn cast<A: Accelerator, P: Primitives, E>(scene: Result<Scene<A, P>, E>) {
    let Ok(scene) = scene else { return };
    let keep = |hit: &Hit| hit.primitive != word();
    black_box(scene.closest_hit(&ray()));
    black_box(scene.closest_hit_where(&ray(), keep));
    black_box(scene.any_hit(&ray()));
    black_box(scene.any_hit_where(&ray(), keep));
    let mut last = Some(word());
    black_box((scene.any_hit_near(&ray(), &mut last), last));
    scene.hits(&ray()).for_each(|hit| _ = black_box(hit));
    let mut hits: heapless::Vec<Hit, 4> = heapless::Vec::new();
    scene.nearest_hits(&ray(), &mut hits);
    let mut query = scene.begin(&ray());
    black_box((query.advance(word()), query.advance(word())));
    let hit = black_box(Hit { t: 0.0, primitive: word() });
    black_box((hit.precedes(&hit), scene.accelerator().bounds(), Surface::facing(&ray(), float())));
    if let Some(bundle) = Bundle::around([ray(), ray()]) {
        let entries = scene.enter(&bundle);
        black_box(scene.closest_hit_from(&entries, &ray()));
    }
    let camera = Camera::pinhole(vector(), vector(), vector(), float());
    if let Some(pencil) = camera.pencil(&Tile { x: word(), y: word(), width: 8, height: 8 }, word(), word()) {
        let mut items = ItemBuffer::new();
        items.offer(word(), word(), hit);
        black_box((
            scene.closest_hits(&pencil, &mut items),
            items.get(word(), word()),
            pencil.columns(),
            pencil.rows(),
        ));
    }
    let surface = scene.surface(&ray(), &hit);
    black_box((surface.start_towards(vector()), surface.normal_towards_ray(), scene.bounds(), hits));
}
