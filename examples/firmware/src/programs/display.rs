//! Draws a scene from flash on displays of 16 bits and of 1 bit a pixel, 8 rows at a time, without a framebuffer.
//!
//! The displays are files of the host: `display.ppm` and `display.pbm`.

use core::{ffi::CStr, fmt::Write as _};

use embedded_graphics::{pixelcolor::Rgb888, prelude::*};
use semihosting::{
    fs::File,
    io::{self, Write as _},
    println,
};

use crate::{
    Board,
    baked::{BINARY_PICTURE, COLOR_PICTURE, KNOT},
    figure,
    hash::Hash,
    picture,
};

/// Bytes of the longest row.
const ROW: usize = 3 * picture::COLOR.width as usize;

/// A portable pixmap or bitmap with this head.
fn file(path: &CStr, magic: &str, size: Size, most: &str) -> io::Result<File> {
    let mut head = heapless::String::<32>::new();
    // It has room for all that is written.
    let _ = write!(head, "{magic}\n{} {}\n{most}", size.width, size.height);
    let mut file = File::create(path)?;
    file.write_all(head.as_bytes())?;
    Ok(file)
}

/// Both pictures; the host has drawn the same.
pub fn run(board: &mut Board) -> bool {
    let scene = KNOT.scene();
    let (mut color, mut binary) = (Hash::NONE, Hash::NONE);
    let mut show = || -> io::Result<()> {
        let mut ppm = file(c"display.ppm", "P6", picture::COLOR, "255\n")?;
        let mut drawn = Ok(());
        let instructions = board.counter.instructions(|| {
            drawn = picture::color(&scene, |strip| {
                strip.chunks_exact(picture::COLOR.width as usize).try_for_each(|row| {
                    let mut bytes = [0; ROW];
                    for (bytes, &pixel) in bytes.chunks_exact_mut(3).zip(row) {
                        let rgb = Rgb888::from(pixel);
                        bytes.copy_from_slice(&[rgb.r(), rgb.g(), rgb.b()]);
                        color.add(pixel.into_storage().into());
                    }
                    ppm.write_all(&bytes)
                })
            });
        });
        figure("display", "pixel", instructions / u64::from(picture::COLOR.width * picture::COLOR.height));
        let mut pbm = file(c"display.pbm", "P4", picture::BINARY, "")?;
        drawn.and(picture::binary(&scene, |strip| {
            strip.chunks_exact(8).try_for_each(|eight| {
                // Black is 1.
                let byte = eight.iter().fold(0, |byte, pixel| byte << 1 | u8::from(pixel.is_off()));
                binary.add(byte.into());
                pbm.write_all(&[byte])
            })
        }))
    };
    let shown = show().inspect_err(|error| println!("{error}")).is_ok();
    println!("colour {:08x}, black and white {:08x}", color.0, binary.0);
    shown && color == COLOR_PICTURE && binary == BINARY_PICTURE
}
