use hitscan::Error;

use crate::{engines::Preset, procedural};

/// Sizes of the terrain, each twice the one before.
const SIZES: [usize; 5] = [62_500, 125_000, 250_000, 500_000, 1_000_000];

/// Prints the build time of each size and its ratio to that of half the size.
pub fn run(preset: Preset) -> Result<(), Error> {
    println!("terrain, hitscan kD-tree {}\n", preset.name());
    println!("| triangles | build, ms | µs/tri | doubling |\n| ---: | ---: | ---: | ---: |");
    let mut before = None;
    for size in SIZES {
        let mesh = procedural::terrain(size);
        let seconds = preset.build_time(&mesh.view()?)?.as_secs_f64();
        let ratio = before.replace(seconds).map_or_else(String::new, |before| format!("{:.2}", seconds / before));
        println!("| {size} | {:.0} | {:.2} | {ratio} |", seconds * 1.0e3, seconds * 1.0e6 / size as f64);
    }
    Ok(())
}
