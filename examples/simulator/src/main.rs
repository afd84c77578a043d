//! One scene on four displays, as `FOLDER/NAME.png`; fails if one does not show what it always showed.
//!
//! `cargo run --release [FOLDER]`

mod handheld;
mod model;

use std::{env, error::Error, fs, path::Path, process::ExitCode};

use embedded_graphics::{
    pixelcolor::{BinaryColor, Gray2, Rgb565, Rgb888, WebColors as _},
    prelude::*,
};
use embedded_graphics_simulator::{OutputSettingsBuilder, SimulatorDisplay};
use handheld::show;
use hitscan::render::{Channels, Diffusion, Ordered};

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let folder = env::args().nth(1).unwrap_or_else(|| ".".into());
    fs::create_dir_all(&folder)?;
    let folder = Path::new(&folder);
    let mut errors = [0; 296];
    let shown = model::with(|picture| {
        let color = show(&picture(240, 240), Ordered, "RGB565", [Rgb565::CSS_ORANGE, Rgb565::BLACK])?;
        let grey = show(&picture(160, 144), Diffusion::new(&mut errors), "4 greys", [Gray2::WHITE, Gray2::BLACK])?;
        let binary = [BinaryColor::On, BinaryColor::Off];
        let oled = show(&picture(128, 64), Ordered, "ordered", binary)?;
        let paper = show(&picture(296, 128), Diffusion::new(&mut errors), "error diffusion", binary)?;
        Ok([
            save(folder, "color", &color, 1, 0x5b1f_3b86)?,
            save(folder, "grey", &grey, 2, 0x8a6d_bb81)?,
            save(folder, "oled", &oled, 2, 0x0274_07fc)?,
            save(folder, "paper", &paper, 1, 0xadc0_a400)?,
        ])
    })?;
    Ok(if shown.contains(&false) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Saves what a display shows, each pixel `scale` wide; whether it has this hash.
fn save<C>(
    folder: &Path,
    name: &str,
    display: &SimulatorDisplay<C>,
    scale: u32,
    expected: u32,
) -> Result<bool, Box<dyn Error>>
where
    C: Channels + PixelColor + Into<Rgb888>,
{
    // FNV-1a.
    let bytes = display.bounding_box().points().flat_map(|point| display.get_pixel(point).into().to_be_bytes());
    let hash = bytes.fold(0x811c_9dc5_u32, |sum, byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    let path = folder.join(name).with_extension("png");
    let settings = OutputSettingsBuilder::new().scale(scale).build();
    display.to_rgb_output_image(&settings).save_png(&path)?;
    let Size { width, height } = display.size();
    println!("{}: {width} x {height}, hash {hash:#010x}", path.display());
    if hash != expected {
        eprintln!("{name} was {expected:#010x}");
    }
    Ok(hash == expected)
}
