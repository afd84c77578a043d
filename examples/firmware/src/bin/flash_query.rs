//! Casts the camera's rays at an asset that stays in flash: a picture, and the host's answer to the last bit.

#![no_std]
#![no_main]

use firmware::{Answer, baked, camera, entry, finish};
use hitscan::{Hit, Primitives};
use semihosting::println;

/// From near to far.
const SHADES: &[u8] = b"@%#*+=-:.";

/// A character for the depth of a hit.
fn shade(hit: Option<Hit>) -> u8 {
    let Some(hit) = hit else { return b' ' };
    let index = (hit.t - 2.2) * 4.0;
    SHADES[(index as usize).min(SHADES.len() - 1)]
}

#[entry]
fn main() -> ! {
    let baked = &baked::KNOT;
    let scene = baked.scene();
    let mut answer = Answer::NONE;
    for y in 0..camera::HEIGHT {
        let mut line = [b' '; camera::WIDTH as usize];
        for (place, ray) in line.iter_mut().zip(camera::row(y)) {
            let hit = scene.closest_hit(&ray);
            answer.add(hit);
            *place = shade(hit);
        }
        // Characters are about twice as high as wide.
        if y % 2 == 0 {
            println!("{}", str::from_utf8(&line).unwrap_or_default().trim_end());
        }
    }
    println!("{} triangles and their tree in {} bytes of flash", scene.primitives().len(), baked.bytes.len());
    println!("here:  {answer}");
    println!("there: {}", baked.answer);
    finish(answer == baked.answer)
}
