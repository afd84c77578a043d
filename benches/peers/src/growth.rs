use hitscan::Error;

use crate::{
    engines::{Kd, Preset},
    procedural,
};

/// Sizes of the terrain, each twice the one before.
const SIZES: [usize; 5] = [62_500, 125_000, 250_000, 500_000, 1_000_000];

/// Prints the build time of each size and its ratio to that of half the size.
pub fn run(preset: Preset) -> Result<(), Error> {
    println!("terrain, hitscan {}", preset.name());
    println!("{:>9} {:>9} {:>7} {:>8}", "triangles", "build ms", "µs/tri", "doubling");
    let mut before = None;
    for size in SIZES {
        let mesh = procedural::terrain(size);
        let view = mesh.view()?;
        let mut memory = vec![0; preset.words(&view)];
        let (_, build) = Kd::build(preset, &view, &mut memory)?;
        let seconds = build.as_secs_f64();
        let ratio = before.replace(seconds).map_or_else(String::new, |before| format!("{:.2}", seconds / before));
        println!("{size:9} {:9.0} {:7.2} {ratio:>8}", seconds * 1.0e3, seconds * 1.0e6 / size as f64);
    }
    Ok(())
}
