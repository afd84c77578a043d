//! The functions that C calls.

#![allow(unsafe_code, reason = "their names are exported; what is unsafe is in `raw`")]

use core::{
    ffi::{c_char, c_void},
    mem::MaybeUninit,
};

use engine::{Arena as Memory, asset::Asset, query::Wanted};

use crate::{
    plan::chosen,
    raw::{In, Out, Scene},
    scene::{View, ask},
    status::Status,
    triangles::Triangles,
    types::{Arena, Box, Hit, Mesh, Nearest, Ray, Surface, Vec3},
};

/// What a function came to, with `?` inside.
fn status(work: impl FnOnce() -> Result<Status, Status>) -> Status {
    work().unwrap_or_else(|status| status)
}

/// Writes what was found to where C wants it.
fn found<T>(what: Option<impl Into<T>>, place: &mut MaybeUninit<T>) -> Status {
    match what {
        Some(what) => {
            place.write(what.into());
            Status::Hit
        }
        None => Status::Miss,
    }
}

/// What a status says, in English; never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_status_text(status: i32) -> *const c_char {
    Status::text(status).as_ptr()
}

/// The ray from a point along a direction, for t from 0 to infinity, seeing everything.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_ray_new(origin: Vec3, direction: Vec3) -> Ray {
    engine::Ray::new(origin.into(), direction.into()).into()
}

/// The segment from a (t = 0) to b (t = 1), seeing everything.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_ray_between(a: Vec3, b: Vec3) -> Ray {
    engine::Ray::between(a.into(), b.into()).into()
}

/// Opens the scene in an asset, made by `hitscan bake`, where it lies.
///
/// The asset begins at a multiple of 4 bytes. It is checked in full, once, in time proportional to its size; after that no
/// query can fail, whatever its bytes. After an error the scene is closed.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_open(scene: Out<Scene>, asset: In<c_void>, bytes: usize) -> Status {
    status(|| {
        let scene = scene.place()?.write(Scene::CLOSED);
        if !bytes.is_multiple_of(4) {
            return Err(Status::Length);
        }
        let asset = Asset::from_words(asset.cast().array(bytes / 4)?)?;
        *scene = Scene::open(View::stored(&asset)?);
        Ok(Status::Ok)
    })
}

/// Builds a structure over a mesh, into the front of the arena, which then holds what is left.
///
/// After an error the scene is closed, and the arena holds what it held. HITSCAN_FULL never comes if it has as many
/// words as hitscan_build_words says; mostly far fewer do.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_build(
    scene: Out<Scene>,
    arena: Out<Arena>,
    mesh: In<Mesh>,
    structure: u32,
    preset: u32,
) -> Status {
    status(|| {
        let scene = scene.place()?.write(Scene::CLOSED);
        let (arena, mesh) = (arena.get()?, mesh.get()?.open()?);
        let mut memory = Memory::new(arena.words.array(arena.count)?);
        *scene = Scene::open(View::build(Triangles::Plain(mesh), &mut memory, &chosen(structure, preset)?)?);
        arena.advance(memory.available());
        Ok(Status::Ok)
    })
}

/// How many words of arena always suffice to build a structure over so many triangles; 0 if there is no such structure.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_build_words(structure: u32, preset: u32, triangles: usize) -> usize {
    chosen(structure, preset).map_or(0, |plan| plan.words(triangles))
}

/// Looks for the first triangle that hitscan_build would refuse, and writes its number.
///
/// HITSCAN_OK if there is none; then nothing is written.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_mesh_check(mesh: In<Mesh>, triangle: Out<u32>) -> Status {
    status(|| {
        let place = triangle.place()?;
        mesh.get()?.check().map_err(|(status, triangle)| {
            place.write(triangle);
            status
        })?;
        Ok(Status::Ok)
    })
}

/// The box around all triangles of a scene.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_bounds(scene: In<Scene>, bounds: Out<Box>) -> Status {
    status(|| {
        let place = bounds.place()?;
        place.write(ask!(scene.get()?.view()?, scene => scene.bounds()).into());
        Ok(Status::Ok)
    })
}

/// The first hit of a ray: HITSCAN_HIT, or HITSCAN_MISS and nothing is written.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_closest_hit(scene: In<Scene>, ray: In<Ray>, hit: Out<Hit>) -> Status {
    status(|| {
        let (scene, ray, place) = (scene.get()?.view()?, ray.get()?.into(), hit.place()?);
        Ok(found(ask!(scene, scene => scene.hit(&ray, Wanted::Closest)), place))
    })
}

/// Whether a ray hits anything, HITSCAN_HIT or HITSCAN_MISS: for shadows, cheaper than the closest hit.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_any_hit(scene: In<Scene>, ray: In<Ray>) -> Status {
    status(|| {
        let (scene, ray) = (scene.get()?.view()?, ray.get()?.into());
        Ok(if ask!(scene, scene => scene.hit(&ray, Wanted::Any)).is_some() { Status::Hit } else { Status::Miss })
    })
}

/// The first hits of a ray in order, at most capacity of them, and how many were written.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_all_hits(
    scene: In<Scene>,
    ray: In<Ray>,
    hits: Out<Hit>,
    capacity: usize,
    count: Out<usize>,
) -> Status {
    status(|| {
        let (scene, ray) = (scene.get()?.view()?, ray.get()?.into());
        let (places, count) = (hits.places(capacity)?, count.place()?.write(0));
        ask!(scene, scene => {
            // The places first: when there are no more, no further hit is looked for.
            for (place, hit) in places.iter_mut().zip(scene.hits(&ray)) {
                place.write(hit.into());
                *count += 1;
            }
        });
        Ok(if *count > 0 { Status::Hit } else { Status::Miss })
    })
}

/// The surface at a hit of this ray.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_surface_at(scene: In<Scene>, ray: In<Ray>, hit: In<Hit>, surface: Out<Surface>) -> Status {
    status(|| {
        let (scene, ray, hit) = (scene.get()?.view()?, ray.get()?.into(), (*hit.get()?).into());
        let place = surface.place()?;
        place.write(Surface::new(&ask!(scene, scene => scene.surface(&ray, &hit)), &ray));
        Ok(Status::Ok)
    })
}

/// The point of all triangles nearest to a point, at most so far away: HITSCAN_HIT or HITSCAN_MISS.
///
/// It is measured in double precision, and takes some 2 kB of stack.
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_nearest_point(
    scene: In<Scene>,
    point: Vec3,
    max_distance: f32,
    nearest: Out<Nearest>,
) -> Status {
    status(|| {
        let (scene, place) = (scene.get()?.view()?, nearest.place()?);
        Ok(found(ask!(scene, scene => scene.nearest_point(point.into(), max_distance)), place))
    })
}

/// Panics, to see that this is noticed.
#[cfg(feature = "panic")]
#[unsafe(no_mangle)]
pub extern "C" fn hitscan_panic(index: usize) -> u32 {
    [0, 1][index]
}
