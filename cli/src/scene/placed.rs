use std::path::Path;

use hitscan::{
    Accelerator, Hit, Instance, Instances, Mesh, Primitives, Ray, Scene,
    accel::{Bvh, DualSplit, Entries, KdTree, Structure},
    asset::{Asset, AssetError, Kind, Stored},
    geometry::{Aabb, Bundle},
    glam::Vec3,
    primitives::{Mapped, Smooth, Surface, TexCoords},
    render::{Caster, Material, Materials, Textures},
};

use super::{
    Queries, StructureArgs, broken, normals_by_place,
    source::{damaged, pictures},
    subject::{Body, Subject},
};
use crate::{failure::Failure, stage::glazed};

/// Placed scenes, which know their materials.
#[derive(Debug)]
struct World<'a, A, T> {
    scene: Scene<T, Instances<'a, A, Mapped<'a, Smooth<'a>>>>,
    dresses: &'a [Dress<'a>],
}

/// What the triangles of a part look like.
#[derive(Debug)]
struct Dress<'a> {
    materials: Option<Materials<'a>>,
    textures: Option<(Textures<'a>, TexCoords<'a>)>,
}

impl<'a> Dress<'a> {
    fn read(part: &Asset<'a>) -> Result<Self, hitscan::Error> {
        let materials = match part.read() {
            Err(hitscan::Error::Asset(AssetError::Missing { .. })) => None,
            read => Some(read?),
        };
        Ok(Self { materials, textures: pictures(part)? })
    }

    /// The material of a triangle at a place on its surface.
    fn material(&self, triangle: u32, surface: &Surface) -> Material {
        let Some(materials) = self.materials else { return glazed() };
        let material = materials.of(triangle);
        let texture = self.textures.and_then(|(textures, _)| textures.get(materials.number(triangle)?));
        let light = texture.map_or(Vec3::ONE, |texture| texture.color(surface.uv));
        Material { diffuse: material.diffuse * light, ..material }
    }
}

impl<A: Accelerator, T: Accelerator> Caster for World<'_, A, T> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        self.scene.closest_hit(ray)
    }

    fn enter(&self, bundle: &Bundle) -> Entries {
        self.scene.enter(bundle)
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.scene.closest_hit_from(entries, ray)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        self.scene.any_hit(ray)
    }

    fn any_hit_near(&self, ray: &Ray, _depth: u32, last: &mut Option<u32>) -> bool {
        self.scene.any_hit_near(ray, last)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.scene.surface(ray, hit)
    }

    fn material(&self, hit: &Hit, surface: &Surface) -> Option<Material> {
        let instances = self.scene.primitives();
        let (instance, triangle) = instances.locate(hit.primitive)?;
        let scene = instances.placed().get(instance as usize)?.scene();
        Some(self.dresses.get(scene as usize)?.material(triangle, surface))
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }
}

impl<A: Accelerator + Sync, T: Accelerator + Sync> Queries for World<'_, A, T> {
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32) {
        self.scene.count(ray)
    }
}

/// Opens a world, without asking at every step which structure it has where all levels have a usual one.
pub fn with_world<R>(
    path: &Path,
    asset: &Asset<'_>,
    structure: &StructureArgs,
    smooth: bool,
    visit: impl FnOnce(&Subject<'_>) -> Result<R, Failure>,
) -> Result<R, Failure> {
    if structure.structure.is_some() {
        let what = format!("{}: has its structures in it", path.display());
        return Err(Failure::new(what, "give --structure to `hitscan bake`"));
    }
    let parts: Vec<Asset<'_>> = asset.parts().collect::<Result<_, _>>().map_err(|error| damaged(path, error))?;
    let kind = |asset: &Asset<'_>| asset.read::<Structure<'_>>().ok().and_then(|structure| structure.kind());
    let first = parts.first().and_then(kind);
    let common = first.filter(|_| parts.iter().all(|part| kind(part) == first));
    match (common, kind(asset)) {
        (Some(Kind::KdTree), Some(Kind::Bvh)) => opened::<KdTree<'_>, Bvh<'_>, R>(path, asset, &parts, smooth, visit),
        (Some(Kind::Bvh), Some(Kind::Bvh)) => opened::<Bvh<'_>, Bvh<'_>, R>(path, asset, &parts, smooth, visit),
        (Some(Kind::DualSplit), Some(Kind::Bvh)) => {
            opened::<DualSplit<'_>, Bvh<'_>, R>(path, asset, &parts, smooth, visit)
        }
        _ => opened::<Structure<'_>, Structure<'_>, R>(path, asset, &parts, smooth, visit),
    }
}

fn opened<'a, A: Accelerator + Stored<'a> + Sync, T: Accelerator + Stored<'a> + Sync, R>(
    path: &Path,
    asset: &Asset<'a>,
    parts: &[Asset<'a>],
    smooth: bool,
    visit: impl FnOnce(&Subject<'_>) -> Result<R, Failure>,
) -> Result<R, Failure> {
    let begun = std::time::Instant::now();
    let damaged = |error: hitscan::Error| damaged(path, error);
    let meshes: Vec<Mesh<'a>> = parts.iter().map(Asset::read).collect::<Result<_, _>>().map_err(damaged)?;
    let dresses: Vec<Dress<'a>> = parts.iter().map(Dress::read).collect::<Result<_, _>>().map_err(damaged)?;
    let normals: Vec<Vec<Vec3>> =
        meshes.iter().map(|mesh| if smooth { normals_by_place(mesh) } else { Vec::new() }).collect();
    let mut scenes = Vec::new();
    for (((part, mesh), normals), dress) in parts.iter().zip(&meshes).zip(&normals).zip(&dresses) {
        let structure: A = part.read().map_err(damaged)?;
        let coordinates = dress.textures.map_or(TexCoords::new(&[]), |(_, coordinates)| coordinates);
        let triangles = Mapped::new(Smooth::new(*mesh, normals), mesh, coordinates);
        scenes.push(Scene::new(structure, triangles).map_err(broken)?);
    }
    let placed: &[Instance] = asset.read().map_err(damaged)?;
    let instances = Instances::new(&scenes, placed).map_err(broken)?;
    let structure: T = asset.read().map_err(damaged)?;
    let primitives = instances.numbers();
    let scene = Scene::new(structure, instances).map_err(broken)?;
    let world = World { scene, dresses: &dresses };
    let boxes: Vec<Aabb> = scenes.iter().map(Scene::bounds).collect();
    let body = Body::World {
        placed,
        boxes: &boxes,
        own: meshes.iter().map(|mesh| u64::from(mesh.len())).sum(),
        bytes: size_of_val(asset.as_words()),
        seconds: begun.elapsed().as_secs_f64(),
    };
    visit(&Subject { scene: &world, primitives, body })
}
