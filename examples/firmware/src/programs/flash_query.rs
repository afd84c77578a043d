//! Casts the camera's rays at an asset that stays in flash: a picture, and the host's answer to the last bit.

use core::hint::black_box;

use hitscan::{Hit, Primitives, Ray, glam::Vec3};
use semihosting::println;

use crate::{Answer, Board, baked::KNOT, camera, figure};

/// From near to far.
const SHADES: &[u8] = b"@%#*+=-:.";

/// A character for the depth of a hit.
fn shade(hit: Option<Hit>) -> u8 {
    let Some(hit) = hit else { return b' ' };
    let index = (hit.t - 2.2) * 4.0;
    SHADES[(index as usize).min(SHADES.len() - 1)]
}

/// Closest and any hits. No memory is taken but the stack.
pub fn run(board: &mut Board) -> bool {
    let baked = black_box(&KNOT);
    let scene = baked.scene();
    let mut answer = Answer::NONE;
    let (mut closest, mut any, mut shadows) = (0, 0, 0);
    for y in 0..camera::HEIGHT {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); camera::WIDTH as usize];
        rays.iter_mut().zip(camera::row(y)).for_each(|(place, ray)| *place = ray);
        let mut line = [b' '; camera::WIDTH as usize];
        for (place, ray) in line.iter_mut().zip(&rays) {
            let (mut hit, mut shadow) = (None, false);
            closest += board.counter.instructions(|| hit = scene.closest_hit(ray));
            any += board.counter.instructions(|| shadow = scene.any_hit(ray));
            answer.add(hit);
            shadows += u32::from(shadow);
            *place = shade(hit);
        }
        // Characters are about twice as high as wide.
        if y % 2 == 0 {
            println!("{}", str::from_utf8(&line).unwrap_or_default().trim_end());
        }
    }
    println!("{} triangles and their tree in {} bytes of flash, 0 of RAM", scene.primitives().len(), baked.bytes.len());
    println!("here:  {answer}");
    println!("there: {}", baked.answer);
    let rays = u64::from(answer.rays);
    figure("flash_query", "closest", closest / rays);
    figure("flash_query", "any", any / rays);
    answer == baked.answer && shadows == answer.hits
}
