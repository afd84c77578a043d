//! Builds every structure that fits into the board's memory, word for word the host's, and lets an obstacle move: a
//! hierarchy that is refitted or built anew each frame.

use hitscan::{
    Arena, Bvh, List, Mesh, Primitives, Scene, bvh,
    error::{BuildError, Error},
    glam::Vec3,
};
use semihosting::println;

use crate::{
    Board, Counter,
    baked::{HASHES, MODEL},
    builds::{BUILDS, Build},
    camera, figure,
    hash::Hash,
    stack_of_all,
};

/// Frames of the moving obstacle.
const FRAMES: u32 = 4;

/// Every structure, then the obstacle.
pub fn run(board: &mut Board) -> bool {
    let mesh: Mesh = MODEL.read();
    println!("{} triangles, {} words of memory", mesh.len(), board.memory.len());
    let mut arena = Arena::new(board.memory);
    // What one frame took is free again in the next.
    let mut same = true;
    for build in BUILDS {
        same &= arena.frame(|arena| built(build, &mesh, arena, &board.counter));
    }
    let moved = obstacle(&mesh, board.memory, &board.counter);
    same && moved.unwrap_or_else(|error| {
        println!("{error}");
        false
    })
}

/// Builds one structure; whether its words are the host's, or it does not fit.
fn built(build: &Build, mesh: &Mesh, arena: &mut Arena, counter: &Counter) -> bool {
    let name = build.name;
    let (mut words, mut instructions) = (None, 0);
    let stack = stack_of_all(&mut || {
        instructions = counter.instructions(|| words = Some((build.build)(mesh, arena)));
    });
    match words {
        Some(Ok(words)) => {
            let (length, enough) = (words.len(), (build.words)(mesh.len() as usize));
            println!(
                "{name:16} {length:6} words, {enough:6} always suffice, {instructions:9} instructions, {stack:5} B of stack"
            );
            figure("build", name, instructions);
            figure("build_stack", name, stack as u64);
            HASHES.contains(&(name, Hash::of(words.iter().copied())))
        }
        Some(Err(BuildError::Full(full))) => {
            println!("{name:16} {full}");
            true
        }
        _ => false,
    }
}

/// Turns the mesh a little in every frame, in vertices of its own.
///
/// A refitted hierarchy and one built anew must give the same hits, and now and then a list tells whether they are right.
fn obstacle(mesh: &Mesh, memory: &mut [u32], counter: &Counter) -> Result<bool, Error> {
    let (vertices, memory) = memory.split_at_mut(mesh.vertices().len() * 3);
    let vertices: &mut [Vec3] = bytemuck::cast_slice_mut(vertices);
    vertices.copy_from_slice(mesh.vertices());
    let options = bvh::Options::balanced();
    let length = Bvh::build(mesh, &mut Arena::new(memory), &options)?.as_words().len();
    let (words, rest) = memory.split_at_mut(length);

    let (mut refitting, mut rebuilding, mut same) = (0, 0, true);
    for _ in 0..FRAMES {
        // By 16.26 degrees about y: 24, 7 and 25 make a right angle.
        vertices.iter_mut().for_each(|v| *v = Vec3::new(v.x * 0.96 + v.z * 0.28, v.y, v.z * 0.96 - v.x * 0.28));
        let mesh = Mesh::new(vertices, mesh.indices())?;
        let (mut refitted, mut rebuilt) = (None, None);
        refitting += counter.instructions(|| refitted = Some(Bvh::refit(words, &mesh)));
        let mut arena = Arena::new(rest);
        rebuilding += counter.instructions(|| rebuilt = Some(Bvh::build(&mesh, &mut arena, &options)));
        let (Some(refitted), Some(rebuilt)) = (refitted, rebuilt) else { return Ok(false) };
        let (refitted, rebuilt) = (Scene::new(refitted?, mesh)?, Scene::new(rebuilt?, mesh)?);
        let list = Scene::new(List::new(&mesh)?, mesh)?;
        for (index, ray) in (0..camera::HEIGHT).step_by(4).flat_map(|y| camera::row(y).step_by(8)).enumerate() {
            let hit = refitted.closest_hit(&ray);
            same &= hit == rebuilt.closest_hit(&ray) && (index % 8 != 0 || hit == list.closest_hit(&ray));
        }
    }
    let frames = u64::from(FRAMES);
    println!(
        "obstacle: refitted in {} instructions per frame, built anew in {}",
        refitting / frames,
        rebuilding / frames
    );
    figure("obstacle", "refit", refitting / frames);
    figure("obstacle", "rebuild", rebuilding / frames);
    Ok(same)
}
